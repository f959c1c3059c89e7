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

/// K12 by direction and length: [direction * (kBeamLengthMax + 1) + length].
std::vector<BeamRow<double>> beam_rows(const ReducedNetwork& network,
                                       const model::Material& material);

/// The beams of a network that has none but short ones.
Stencil make_stencil(const ReducedNetwork& network, const model::Material& material);

std::vector<BeamRow<float>> single(const std::vector<BeamRow<double>>& rows);

/// K_pq for every edge; if asked for in double precision as well, of a level on which no two
/// different ones are equal in single precision.
void fill_blocks(const SpringGraph& graph, Blocks& blocks,
                 std::vector<Block<double>>* wide = nullptr);

}  // namespace holdfast::solver
