// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <new>

#include "bits.hpp"
#include "equilibrium.hpp"
#include "holdfast/agent/agent.hpp"

/// Elimination over the tree as messages; branch.hpp has the algebra.
///
///   kMass      with the reports: cuts that are open, so that each module knows its loops
///   kFactor    with the reports: columns of condensed stiffness, then condensed loads
///   kTreeStep  with the order: displacements and forces in cuts; with the reports: loads
///
/// Planned modules emulated here are leaves of the tree: they hang on this module or on each other.
///
/// All is done in pieces, none longer than 5 ms on a Cortex-M0; each makes the factor of 1 + S F
/// that it needs. Between the residuals of one step and the displacements of the next, Node::shared
/// has the condensed load of a planned module, then its shift.
namespace holdfast::agent {

namespace branches {

/// Columns of S'; those of B', C' and P' follow.
inline constexpr int kStiffnessColumns = 6;

/// Pieces in which a leaf's columns go to its parent.
inline constexpr int kLeafPieces = kStiffnessColumns / Branch::kBatch;

/// The planned modules of one host as a tree, parents before children.
struct Leaves {
  int count = 0;
  std::array<int, kPlannedMax> node{};    ///< Index into nodes_.
  std::array<int, kPlannedMax> parent{};  ///< The same; 0 is the host.
  std::array<base::Direction, kPlannedMax> to_parent{};
};

inline Leaves leaves_of(const Planned& planned) {
  Leaves leaves;
  std::uint8_t placed = 0;
  const auto place = [&](int node, int parent, base::Direction to_parent) {
    const auto i = static_cast<std::size_t>(leaves.count++);
    leaves.node[i] = node;
    leaves.parent[i] = parent;
    leaves.to_parent[i] = to_parent;
    placed = static_cast<std::uint8_t>(placed | bit(planned.hosted(node - 1)));
  };
  for (int i = 0; i < planned.hosted_count(); ++i) {
    const int face = planned.own_face(planned.hosted(i));
    if (face >= 0) {
      place(1 + i, 0, base::opposite(static_cast<base::Direction>(face)));
    }
  }
  for (int next = 0; next < leaves.count; ++next) {
    const int at = leaves.node[static_cast<std::size_t>(next)];
    for (const base::Direction direction : base::kDirections) {
      const int other = planned.neighbour_of(planned.hosted(at - 1), direction);
      const int node = other < 0 ? -1 : planned.node_of(other);
      if (node > 0 && (placed & bit(other)) == 0) {
        place(node, at, base::opposite(direction));
      }
    }
  }
  return leaves;
}

/// Connections between the planned modules of one host, and with it.
inline int leaf_connections(const Planned& planned) {
  int ends = 0;
  for (int i = 0; i < planned.hosted_count(); ++i) {
    const int k = planned.hosted(i);
    ends += planned.own_face(k) >= 0 ? 2 : 0;
    for (const base::Direction direction : base::kDirections) {
      ends += planned.neighbour_of(k, direction) >= 0 ? 1 : 0;
    }
  }
  return ends / 2;
}

}  // namespace branches

}  // namespace holdfast::agent
