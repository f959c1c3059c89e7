// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>

#include "situation.hpp"

/// Decides whether a robot keeps standing where it is, by the rigid body and by the model (Secs.
/// III-B, III-C). Where a robot is a part, the answers are those of the whole.
namespace holdfast::verdict {

/// The rigid body with supports anywhere; on a flat floor, where `body` knows it all, in closed
/// form.
limit::RigidStability rigid_stability(const Situation& here, const RigidBody& body,
                                      bool has_figures);

/// Decides by Sec. III-C: stable if a facet presses all over, or three pressing corners are not on
/// one line.
ModelStability model_stability(const Situation& here, const solver::Equilibrium& equilibrium);

/// Whether the states of all facets, in their order, hold a robot that nothing else holds: the
/// same.
bool do_states_hold(const Situation& here, std::span<const mechanics::ContactState> contact);

/// The place to which bending takes the centre of mass of a robot that the support polygon holds;
/// none for any other.
std::optional<Lean> find_lean(const model::Robot& robot, const Assessment& assessment);

/// Finds that place by other displacements than the equilibrium's.
std::optional<Lean> find_lean(const model::Robot& robot, const Assessment& assessment,
                              const std::vector<base::Vec6<double>>& displacement);

/// The facet whose sideways force exceeds its friction most, as a share of what it presses with
/// times the coefficient; none if none does by more than its forces may be off.
std::optional<Slip> find_slip(const model::Robot& robot, const solver::Equilibrium& equilibrium);

}  // namespace holdfast::verdict
