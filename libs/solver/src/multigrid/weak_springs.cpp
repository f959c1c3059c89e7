// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "weak_springs.hpp"

#include <Eigen/Cholesky>
#include <algorithm>

#include "holdfast/base/algebra.hpp"

namespace holdfast::solver {
namespace {

using base::at;

/// Chosen on random growth and on slender plates. From 0.0078 on a long bridge is cut lengthwise.
constexpr double kWeakShare = 0.007;

bool is_positive_definite(const Mat& matrix) {
  const Eigen::Map<const Eigen::Matrix<double, 6, 6>> view(matrix.values.data());
  return view.llt().info() == Eigen::Success;
}

/// One node of each pattern.
std::vector<std::size_t> examples(const SpringGraph& graph) {
  std::vector<bool> is_met(graph.springs.size());
  std::vector<std::size_t> nodes;
  for (std::size_t node = 0; node < graph.own_count(); ++node) {
    const std::size_t pattern = graph.pattern[node];
    if (graph.start[node + 1] > graph.start[node] && !is_met[pattern]) {
      is_met[pattern] = true;
      nodes.push_back(node);
    }
  }
  return nodes;
}

/// Whether each spring of the level is weak at its own node.
std::vector<std::uint8_t> weak_at_node(const SpringGraph& graph, host::Team& team) {
  std::vector<std::uint8_t> is_weak(graph.springs.size());
  const std::vector<std::size_t> nodes = examples(graph);
  team.share(0, nodes.size(), [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) {
      const std::size_t first = graph.pattern[nodes[k]];
      const std::size_t last = first + at(graph.start[nodes[k] + 1] - graph.start[nodes[k]]);
      Mat sum{};
      for (std::size_t i = first; i < last; ++i) {
        base::add_to(sum, graph.springs[i].stiffness());
      }
      const Mat share = scaled(sum, -kWeakShare);
      for (std::size_t i = first; i < last; ++i) {
        Mat rest = graph.springs[i].stiffness();
        base::add_to(rest, share);
        is_weak[i] = is_positive_definite(rest) ? 0 : 1;
      }
    }
  });
  return is_weak;
}

/// The edge from `q` to `p`.
std::size_t edge_back(const SpringGraph& graph, std::size_t p, std::size_t q) {
  std::size_t edge = at(graph.start[q]);
  while (at(graph.other[edge]) != p) {
    ++edge;
  }
  return edge;
}

}  // namespace

std::vector<std::uint8_t> weak_springs(const SpringGraph& graph, host::Team& team) {
  if (graph.shift == 0) {
    return {};
  }
  const std::vector<std::uint8_t> is_weak = weak_at_node(graph, team);
  if (std::ranges::find(is_weak, 1) == is_weak.end()) {
    return {};
  }
  const auto spring = [&](std::size_t node, std::size_t edge) {
    return graph.pattern[node] + edge - at(graph.start[node]);
  };
  std::vector<std::uint8_t> edges(graph.other.size());
  for (std::size_t p = 0; p < graph.own_count(); ++p) {
    for (std::size_t e = at(graph.start[p]); e < at(graph.start[p + 1]); ++e) {
      if (graph.is_copy(graph.other[e])) {
        continue;
      }
      const std::size_t q = at(graph.other[e]);
      edges[e] = is_weak[spring(p, e)] == 1 && is_weak[spring(q, edge_back(graph, p, q))] == 1;
    }
  }
  return edges;
}

}  // namespace holdfast::solver
