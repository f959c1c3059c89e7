// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include "holdfast/host/team.hpp"
#include "multigrid/coarsening/level.hpp"
#include "multigrid/coarsening/spring_graph.hpp"

/// Coarsening from one level to the next by aggregation: nodes close together become one.
namespace holdfast::solver {

using host::Team;

/// Fills what leads from `level` to the next one. Returns false if larger cells do not make fewer
/// nodes; else takes places and keys of `fine` away.
template <class Real>
bool coarsen(SpringGraph& fine, Level<Real>& level, Team& team, SpringGraph& coarse,
             std::vector<std::size_t>& colour_start);

}  // namespace holdfast::solver
