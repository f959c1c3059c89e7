// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "holdfast/large/follow.hpp"
#include "holdfast/verdict/assessment.hpp"

/// Judges a robot by its equilibrium in the deformed shape (docs/second_order.md).
namespace holdfast::verdict {

/// An event at which a factor this close to 1 is neither before nor behind the loads as they are.
inline constexpr double kFactorTie = 1e-4;

/// The assessment of a robot in its deformed shape, and the path that it rests on.
struct Deformed {
  /// Verdict, reasons, connections and displacements of the deformed robot under its loads, or
  /// where these are not reached the last stable equilibrium before. weight_factor is the factor of
  /// the next event beyond the loads as they are; none if none comes up to options.factor_max. That
  /// of the linear assessment where that knows that the robot topples: then nothing is followed.
  Assessment assessment;
  std::optional<large::Path> path = {};  ///< None if nothing was followed.
};

/// Follows the equilibria of a robot from no loads on, and gives the verdict that the first event
/// up to lambda = 1 asks for; `linear` is what assess() says of it.
Deformed assess_deformed(const model::Robot& robot, Assessment linear,
                         const large::Options& options = {});

/// What one equilibrium on a path says, for pictures: connections, displacements, and whether it is
/// stable and anything breaks there. Whether it is reached it does not know.
Assessment assess_state(const model::Robot& robot, const large::State& state, bool is_stable,
                        bool is_bonded);

}  // namespace holdfast::verdict
