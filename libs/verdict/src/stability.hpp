// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "holdfast/verdict/assessment.hpp"

/// Does a robot keep standing where it is? By the rigid body, and by the model (Secs. III-B,
/// III-C). Where a robot is a part, the answers are those of the whole.
namespace holdfast::verdict {

/// What decides: nothing needs to, the support polygon, or the rigid body's contact forces.
StabilityRule stability_rule(const model::Robot& robot, const model::RobotPart* part);

/// The rigid body with supports anywhere; on a flat floor, where `body` knows it all, in closed
/// form.
limit::RigidStability rigid_stability(const model::Robot& robot, StabilityRule rule,
                                      const RigidBody& body, const model::RobotPart* part);

/// Sec. III-C: stable if a facet presses all over, or three corners that press are not on one line.
ModelStability model_stability(const model::Robot& robot, const solver::Equilibrium& equilibrium,
                               const model::RobotPart* part);

/// The facet whose sideways force exceeds its friction most, as a share of what it presses with
/// times the coefficient; none if none does.
struct Slip {
  std::size_t module = 0;  ///< Index, at `rank`.
  int rank = 0;
  double friction = 0;  ///< The coefficient.
  double ratio = 0;     ///< |ft| / |fn|.
};

std::optional<Slip> find_slip(const model::Robot& robot, const solver::Equilibrium& equilibrium,
                              const model::RobotPart* part);

}  // namespace holdfast::verdict
