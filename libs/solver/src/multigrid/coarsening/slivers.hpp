// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "multigrid/coarsening/spring_graph.hpp"

/// A beam four modules thick whose place does not suit the cells is cut along its length into two
/// slivers. Their level is no chain but a ladder, which bends by stretching its rails, and rigid
/// clusters of rails know nothing of that: iterations multiply with every such level.
namespace holdfast::solver {

/// Unites pairs of clusters that a border of cells has cut although both fit into one: each with
/// the neighbour it is tied to most strongly. Renumbers `cluster` (node -> cluster) without gaps,
/// fills `box` (cluster -> cells), and returns how many clusters there are now. Cells are
/// 2^(shift/3) modules wide.
std::size_t unite_slivers(const SpringGraph& fine, unsigned shift,
                          std::vector<std::int32_t>& cluster, std::size_t count,
                          std::vector<CellBox>& box);

}  // namespace holdfast::solver
