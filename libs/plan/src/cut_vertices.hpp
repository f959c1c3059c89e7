// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "holdfast/base/algebra.hpp"

namespace holdfast::plan {

/// The cut vertices, by node: those without which the component of `root` falls apart, by
/// depth-first search without recursion [Tarjan 1972]. `neighbour(node, i)` is what is beside a
/// node in the i-th of `degree` places, negative if nothing is.
template <class Neighbour>
std::vector<bool> cut_vertices(std::size_t count, std::int32_t root, std::size_t degree,
                               const Neighbour& neighbour) {
  struct Visit {
    std::int32_t node = 0;
    std::int32_t parent = -1;
    std::size_t next = 0;
  };

  std::vector<bool> is_cut(count);
  std::vector<std::int32_t> order(count, -1);
  std::vector<std::int32_t> low(count);
  std::vector<Visit> stack;
  std::int32_t visited_count = 0;
  int root_child_count = 0;
  const auto enter = [&](std::int32_t node, std::int32_t parent) {
    order[base::at(node)] = low[base::at(node)] = visited_count++;
    stack.push_back({.node = node, .parent = parent});
  };
  enter(root, -1);
  while (!stack.empty()) {
    Visit& top = stack.back();
    if (top.next < degree) {
      const std::int32_t other = neighbour(top.node, top.next++);
      if (other < 0 || other == top.parent) {
        continue;
      }
      if (order[base::at(other)] >= 0) {
        std::int32_t& low_here = low[base::at(top.node)];
        low_here = std::min(low_here, order[base::at(other)]);
        continue;
      }
      root_child_count += top.node == root ? 1 : 0;
      enter(other, top.node);
      continue;
    }
    const Visit done = top;
    stack.pop_back();
    if (done.parent >= 0) {
      std::int32_t& low_parent = low[base::at(done.parent)];
      low_parent = std::min(low_parent, low[base::at(done.node)]);
      if (done.parent != root && low[base::at(done.node)] >= order[base::at(done.parent)]) {
        is_cut[base::at(done.parent)] = true;
      }
    }
  }
  is_cut[base::at(root)] = root_child_count > 1;
  return is_cut;
}

}  // namespace holdfast::plan
