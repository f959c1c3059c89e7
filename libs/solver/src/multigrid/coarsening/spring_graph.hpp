// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <vector>

#include "holdfast/host/ranks.hpp"
#include "multigrid/coarsening/springs.hpp"

namespace holdfast::solver {

/// The cells that a node takes up, from the first to the last.
struct CellBox {
  std::array<std::int32_t, 3> low;
  std::array<std::int32_t, 3> high;
};

/// A level as the next one is made from it: nodes and the springs between them, in double
/// precision, without what holds them (ground_springs.hpp). Nodes whose springs are equal share
/// them: springs[pattern[node] + i] leads to other[start[node] + i].
///
/// Of a part of a robot the nodes are this rank's own, and after them the copies of other ranks'
/// that springs lead to. What springs copies have is not known here.
struct SpringGraph {
  std::vector<std::int32_t> order;  ///< Nodes along the Morton curve; copies after them.
  std::vector<host::Copy> copies;
  std::reference_wrapper<host::Ranks> ranks = host::single_rank();  ///< Who has the other parts.
  std::vector<std::uint64_t> key;  ///< Node -> Morton key of its cell
  std::vector<Point> place;        ///< mm
  std::vector<CellBox> box;        ///< Only in double precision.
  std::vector<bool> is_alone;      ///< Nodes that join no cluster; empty if there are none.
  std::vector<std::int32_t> start;
  std::vector<std::int32_t> other;
  std::vector<std::uint32_t> pattern;
  std::vector<PackedSpring> springs;
  unsigned shift = 0;          ///< Cells are 2^(shift/3) modules wide.
  bool is_along_axes = false;  ///< All springs are, however coarse the level.

  /// Whether other ranks may have parts.
  bool is_part() const { return ranks.get().is_shared(); }

  /// Nodes that are no copies.
  std::size_t own_count() const { return order.size() - copies.size(); }

  bool is_copy(std::int32_t node) const { return static_cast<std::size_t>(node) >= own_count(); }
};

}  // namespace holdfast::solver
