// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

/// The blocks that the factors of a sparse symmetric pattern of blocks have, before any number is
/// known.
namespace holdfast::solver {

/// One pair of coupled nodes, each pair once, never a node with itself.
struct Edge {
  std::int32_t a = 0;
  std::int32_t b = 0;
};

/// The factor L of a matrix whose nodes are eliminated in approximate-minimum-degree order
/// [Amestoy 1996]. All but `position` counts nodes by their places in that order.
struct BlockPattern {
  std::vector<std::int32_t> position;     ///< node -> place in the elimination order
  std::vector<std::int32_t> parent;       ///< elimination tree; -1 for a root
  std::vector<std::size_t> column_start;  ///< into rows, one more than there are places
  std::vector<std::int32_t> rows;         ///< rows below the diagonal, ascending in each column
};

/// The pattern of L; none once it would need more than `block_count_max` blocks below the diagonal.
std::optional<BlockPattern> block_pattern(std::size_t node_count, std::span<const Edge> edges,
                                          std::size_t block_count_max);

}  // namespace holdfast::solver
