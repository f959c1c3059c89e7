// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "groups/leaves.hpp"

namespace holdfast::agent {
namespace {

Leaves trees_of(const Planned& planned, bool has_host) {
  Leaves leaves;
  PlannedSet placed;
  const auto place = [&](int node, int parent, base::Direction to_parent) {
    const auto i = static_cast<std::size_t>(leaves.count++);
    leaves.node[i] = node;
    leaves.parent[i] = parent;
    leaves.to_parent[i] = to_parent;
    placed.add(planned.hosted(node - 1));
  };
  for (int i = 0; i < planned.hosted_count() && has_host; ++i) {
    for (const base::Direction to_host : planned.own_touching(planned.hosted(i))) {
      place(1 + i, 0, to_host);
    }
  }
  for (int next = 0; next < planned.hosted_count(); ++next) {
    for (int i = 0; i < planned.hosted_count() && next == leaves.count; ++i) {
      if (!placed.has(planned.hosted(i))) {
        place(1 + i, 0, base::Direction::kPlusX);
      }
    }
    const int at = leaves.node[static_cast<std::size_t>(next)];
    for (const base::Direction direction : planned.directions()) {
      const int other = planned.neighbour_of(planned.hosted(at - 1), direction);
      const int node = other < 0 ? -1 : planned.node_of(other);
      if (node > 0 && !placed.has(other)) {
        place(node, at, base::opposite(direction));
      }
    }
  }
  return leaves;
}

}  // namespace

Leaves leaves_of(const Planned& planned) { return trees_of(planned, true); }

Leaves group_trees(const Planned& planned) { return trees_of(planned, false); }

int leaf_connections(const Planned& planned) {
  int ends = 0;
  for (int i = 0; i < planned.hosted_count(); ++i) {
    const int k = planned.hosted(i);
    ends += planned.own_face(k).is_empty() ? 0 : 2;
    for (const base::Direction direction : planned.directions()) {
      ends += planned.neighbour_of(k, direction) >= 0 ? 1 : 0;
    }
  }
  return ends / 2;
}

}  // namespace holdfast::agent
