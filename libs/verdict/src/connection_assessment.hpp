// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>

#include "situation.hpp"

/// Assesses the connections in an equilibrium (Sec. III-D).
namespace holdfast::verdict {

/// The error of load ratios by rounding alone, as a share of the largest or of 1.
inline constexpr double kRounding = 1e-12;

/// The error of multigrid's load ratios, as a share of the largest or of 1: what it promises at
/// this tolerance, or what very soft beams take of it.
double multigrid_error(const model::Robot& robot, const solver::EquilibriumOptions& options);

/// The error that weak springs beside the unilateral contact may have made in load ratios, besides
/// what the second answer shows, where the solver could not take them back: a share of the
/// contact's stiffness. Where that answer is for ambiguous feet, or its error is not known, the
/// error that the energy between the solutions with and without could make. `scale` is the largest
/// load ratio, or 1.
double weak_spring_error(const model::Robot& robot, const solver::Equilibrium& equilibrium,
                         double scale);

/// Fills in what all connections of an assessment whose equilibrium is settled say together: their
/// largest load ratio, its range and what breaks. Returns what lies between the largest load ratios
/// of the equilibrium's two answers. Multigrid's second one, unless feet are ambiguous, is given
/// back: it is for the range alone.
LoadRange assess_loads(const Situation& here, const solver::EquilibriumOptions& options,
                       Assessment& assessment);

/// Fills in the results of all connections, unless they are there, and sorts those that break; to
/// be called after assess_loads().
void assess_connections(const model::Robot& robot, int thread_count, Assessment& assessment);

/// Says which gaps, in mm by connection, are too wide; none if none is.
std::optional<OpenGaps> find_open_gaps(const model::Robot& robot, std::span<const double> gap_mm);

/// Finds the gaps in an equilibrium, and which are too wide; none if no connection has a limit.
std::optional<OpenGaps> find_open_gaps(const model::Robot& robot,
                                       const solver::Equilibrium& equilibrium);

}  // namespace holdfast::verdict
