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

/// A spring as its node sees it.
struct Spring {
  std::uint8_t direction = 0;  ///< In which its partner lies.
  double length = 0;           ///< mm
  Point middle = {};           ///< From the node.
  Point partner = {};          ///< From the node.
  Mat stiffness = {};          ///< At the node.
};

/// A spring to something that does not move: the ground, a fixed module.
struct Anchor {
  std::int32_t node = 0;
  std::uint8_t direction = 0;
  double length = 0;  ///< mm
  double reach = 0;   ///< From the ground to the cluster's centre, mm.
  Point middle = {};
  Mat stiffness = {};  ///< At the node.
};

/// A level in double precision, as the next one is made from it. Nodes whose springs are equal
/// share them: springs[pattern[node] + i] leads to other[start[node] + i].
struct Stage {
  std::vector<std::int32_t> order;  ///< Nodes along the Morton curve.
  std::vector<std::uint64_t> key;   ///< Node -> Morton key of its cell
  std::vector<Point> place;         ///< mm
  std::vector<std::int32_t> start;
  std::vector<std::int32_t> other;
  std::vector<std::uint32_t> pattern;
  std::vector<Spring> springs;
  std::vector<Anchor> anchors;  ///< Ascending by node.
};

/// Fills what leads from `level` to the next one. Returns false if larger cells do not make fewer
/// nodes.
bool coarsen(const Stage& fine, Level& level, Team& team, Stage& coarse,
             std::vector<std::size_t>& colour_start);

}  // namespace holdfast::solver
