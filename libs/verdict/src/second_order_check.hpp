// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "situation.hpp"

/// Decides whether linear theory suffices for a robot.
namespace holdfast::verdict {

/// Does the second-order check of an assessment whose equilibrium is settled and whose loads are
/// known, of a whole robot. `solver` has found the equilibrium, of which facets that do not stick
/// are sought once more by the exact law, with weak springs of `gamma`, where that is cheap.
SecondOrder check_second_order(const Situation& here, solver::EquilibriumSolver& solver,
                               double gamma, const solver::EquilibriumOptions& options,
                               const Assessment& assessment);

/// What is done of the second-order check where this is asked for. Beside multigrid it costs as
/// much as the equilibrium: kCheck becomes kBesideFactors unless somebody states the elastic
/// modulus or the robot is about as slender as those that buckle. Of robots in parts nothing is
/// done.
solver::SecondOrderWish second_order_wish(const model::Robot& robot, solver::SecondOrderWish asked);

/// The warning where linear theory is not trusted, but the verdict stands; none if it is.
std::optional<Reason> second_order_warning(const Assessment& assessment);

}  // namespace holdfast::verdict
