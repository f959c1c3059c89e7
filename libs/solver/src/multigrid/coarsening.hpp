// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "holdfast/host/team.hpp"
#include "level.hpp"
#include "network.hpp"
#include "springs.hpp"

/// From one level to the next coarser one.
namespace holdfast::solver {

using host::Team;

/// The cells that a node takes up, from the first to the last.
struct Box {
  std::array<std::int32_t, 3> low;
  std::array<std::int32_t, 3> high;
};

/// A level in double precision, as the next one is made from it, without what holds it
/// (anchors.hpp). Nodes whose springs are equal share them: springs[pattern[node] + i] leads to
/// other[start[node] + i].
struct Stage {
  std::vector<std::int32_t> order;  ///< Nodes along the Morton curve.
  std::vector<std::uint64_t> key;   ///< Node -> Morton key of its cell
  std::vector<Point> place;         ///< mm
  std::vector<Box> box;             ///< Only in double precision.
  std::vector<bool> is_alone;       ///< Nodes that join no cluster; empty if there are none.
  std::vector<std::int32_t> start;
  std::vector<std::int32_t> other;
  std::vector<std::uint32_t> pattern;
  std::vector<Spring> springs;
  unsigned shift = 0;  ///< Cells are 2^(shift/3) modules wide.
};

/// Fills what leads from `level` to the next one. Returns false if larger cells do not make fewer
/// nodes.
template <class Real>
bool coarsen(const Stage& fine, Level<Real>& level, Team& team, Stage& coarse,
             std::vector<std::size_t>& colour_start);

}  // namespace holdfast::solver
