// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "holdfast/verdict/assessment.hpp"

/// What an equilibrium says of the connections (Sec. III-D).
namespace holdfast::verdict {

/// How many times the usual tolerance of multigrid the options have.
double tolerance_share(const solver::EquilibriumOptions& options);

/// Fills in all connections of an assessment whose equilibrium is settled, their largest load ratio
/// and what breaks.
void assess_connections(const model::Robot& robot, const solver::EquilibriumOptions& options,
                        Assessment& assessment);

/// The gaps that are too wide; none if no connection has a limit, or none is exceeded.
std::optional<OpenGaps> find_open_gaps(const model::Robot& robot,
                                       const solver::Equilibrium& equilibrium, host::Ranks* ranks);

}  // namespace holdfast::verdict
