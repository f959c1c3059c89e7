// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "holdfast/model/material.hpp"
#include "multigrid/coarsening/level.hpp"
#include "multigrid/coarsening/reduced_network.hpp"
#include "multigrid/coarsening/spring_graph.hpp"

/// The blocks of K that sweeps read, in single precision whatever the levels are.
namespace holdfast::solver {

/// The beams of a network along the axes, or of any that has none but short ones; `has_springs`:
/// as springs, too. Keeps pointers to the network's vectors.
Stencil make_stencil(const ReducedNetwork& network, const model::Material& material,
                     bool has_springs);

/// K_pq for every edge; if asked for in double precision as well, of a level on which no two
/// different ones are equal in single precision.
void fill_blocks(const SpringGraph& graph, Blocks& blocks,
                 std::vector<Block<double>>* wide = nullptr);

}  // namespace holdfast::solver
