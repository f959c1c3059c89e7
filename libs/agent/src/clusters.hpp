// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <new>

#include "bits.hpp"
#include "branches.hpp"
#include "equilibrium.hpp"
#include "holdfast/agent/agent.hpp"
#include "methods.hpp"

/// Rigid clusters as messages, for long thick robots; cluster.hpp has the algebra.
///
/// kClusters, which begins the equilibrium, finds them. A module joins the cluster of the first of
/// its neighbours nearer to the root whose top is near enough to it in each direction;
/// that neighbour is its parent. If there is none, it is the top of a new cluster and its first
/// neighbour nearer to the root the parent. So clusters are subtrees, and as boxes begin where
/// the robot enters them, no lattice of cells has to suit the robot. It takes one exchange, of
/// what everybody has chosen: a module chooses when the vectors of its nearer neighbours are
/// here, and sends its own. Then all beams are known for what they are: within a cluster, of the
/// link to the parent's cluster, or stray, between clusters that are not parent and child. Stray
/// beams are added to the link, as if the parent's cluster were behind them. Where there are many
/// the root, to which their number is reported, leaves the clusters alone.
///
/// A kStep kWithClusters has two polynomials S of small degree and between them the clusters' exact
/// solve C, so that M^-1 is symmetric:
///   z := S r,  z := z + C (r - K z),  z := z + S (r - K z)
/// The loads of C go up the clusters' tree behind the report, with the condensed stiffness, which
/// may have changed; the displacements come down before the next order.
namespace holdfast::agent {

namespace clusters {

/// Largest distance from a cluster's top in each direction: clusters are 8 long, but for that of
/// the root. 6 are better for frames 4 modules thick, but plates 8 wide fall apart; and so they do
/// if only the root's cluster is smaller.
inline constexpr int kClusterReach = 7;

/// In the label of a load: it comes from within a cluster that stands still.
inline constexpr std::uint8_t kHeld = 1;

/// What a module shares of its choice: the cells of its top and of its parent's cluster's top, from
/// the root's cell, in the first number also the face of the parent.
struct Choice {
  base::Cell top;
  base::Cell parent_top;
  int parent_face = kNoFace;

  static constexpr int kNoFace = 7;
};

// A cell is at most twice kCoordinateMax from the root, and all numbers have to be whole ones of
// binary32.
static_assert(8 * 2 * base::kCoordinateMax + Choice::kNoFace < (1 << 24));
static_assert(Choice::kNoFace < 8 && base::kDirectionCount <= Choice::kNoFace);

inline base::Vec6<double> encoded(const Choice& choice) {
  return {static_cast<double>(8 * choice.top.x + choice.parent_face),
          static_cast<double>(choice.top.y),
          static_cast<double>(choice.top.z),
          static_cast<double>(choice.parent_top.x),
          static_cast<double>(choice.parent_top.y),
          static_cast<double>(choice.parent_top.z)};
}

/// Numbers that no choice has are 0: what a vector says is nowhere checked.
inline Choice decoded(const base::Vec6<float>& vector) {
  constexpr float kMost = 16 * base::kCoordinateMax + 8;
  const auto number = [&](std::size_t i) {
    const bool is_good = vector[i] >= -kMost && vector[i] <= kMost;
    return is_good ? static_cast<std::int32_t>(vector[i]) : std::int32_t{0};
  };
  const std::int32_t first = number(0);
  return {.top = {first >> 3, number(1), number(2)},
          .parent_top = {number(3), number(4), number(5)},
          .parent_face = static_cast<int>(first & 7)};
}

/// May the module at `cell` join the cluster with this top?
inline bool may_join(const base::Cell& cell, const base::Cell& top) {
  const auto is_within = [](std::int32_t d) { return -kClusterReach <= d && d <= kClusterReach; };
  return is_within(cell.x - top.x) && is_within(cell.y - top.y) && is_within(cell.z - top.z);
}

}  // namespace clusters

}  // namespace holdfast::agent
