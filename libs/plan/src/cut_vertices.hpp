// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "holdfast/base/algebra.hpp"

namespace holdfast::plan {

/// A depth-first search of the component of a root, without recursion [Tarjan 1972].
struct DepthFirstTree {
  std::vector<std::int32_t> sequence = {};  ///< Nodes in the order of their visit.
  std::vector<std::int32_t> order = {};     ///< By node: its place in that, or -1.
  std::vector<std::int32_t> parent = {};    ///< By node, -1 for the root.
  /// The first visited, by node, of what edges outside the tree reach from the nodes below it.
  std::vector<std::int32_t> low = {};

  /// Whether the nodes below `child` and itself come loose if its parent is lost.
  bool hangs_on_parent(std::int32_t child) const {
    const std::int32_t above = parent[base::at(child)];
    return low[base::at(child)] >= order[base::at(above)];
  }

  /// Whether they do if the edge to its parent is lost.
  bool hangs_on_edge(std::int32_t child) const {
    return low[base::at(child)] > order[base::at(parent[base::at(child)])];
  }
};

/// `neighbour(node, i)` is what is beside a node in the i-th of `degree` places, negative if
/// nothing is.
template <class Neighbour>
DepthFirstTree depth_first_tree(std::size_t count, std::int32_t root, std::size_t degree,
                                const Neighbour& neighbour) {
  DepthFirstTree tree;
  tree.order.assign(count, -1);
  tree.parent.assign(count, -1);
  tree.low.resize(count);
  std::vector<std::size_t> next(count);
  const auto enter = [&](std::int32_t node, std::int32_t parent) {
    tree.parent[base::at(node)] = parent;
    tree.order[base::at(node)] = tree.low[base::at(node)] =
        static_cast<std::int32_t>(tree.sequence.size());
    tree.sequence.push_back(node);
  };
  enter(root, -1);
  for (std::int32_t node = root; node >= 0;) {
    const std::int32_t parent = tree.parent[base::at(node)];
    if (next[base::at(node)] == degree) {
      if (parent >= 0) {
        tree.low[base::at(parent)] = std::min(tree.low[base::at(parent)], tree.low[base::at(node)]);
      }
      node = parent;
      continue;
    }
    const std::int32_t other = neighbour(node, next[base::at(node)]++);
    if (other < 0 || other == parent) {
      continue;
    }
    if (tree.order[base::at(other)] >= 0) {
      tree.low[base::at(node)] = std::min(tree.low[base::at(node)], tree.order[base::at(other)]);
    } else {
      enter(other, node);
      node = other;
    }
  }
  return tree;
}

/// The cut vertices, by node: those without which the component of `root` falls apart;
/// `neighbour` as of depth_first_tree().
template <class Neighbour>
std::vector<bool> cut_vertices(std::size_t count, std::int32_t root, std::size_t degree,
                               const Neighbour& neighbour) {
  const DepthFirstTree tree = depth_first_tree(count, root, degree, neighbour);
  std::vector<bool> is_cut(count);
  int root_child_count = 0;
  for (const std::int32_t node : tree.sequence) {
    const std::int32_t parent = tree.parent[base::at(node)];
    if (parent == root) {
      ++root_child_count;
    } else if (parent >= 0 && tree.hangs_on_parent(node)) {
      is_cut[base::at(parent)] = true;
    }
  }
  is_cut[base::at(root)] = root_child_count > 1;
  return is_cut;
}

}  // namespace holdfast::plan
