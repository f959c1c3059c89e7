// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "weak_springs.hpp"

#include <Eigen/Cholesky>
#include <algorithm>

namespace holdfast::solver {
namespace {

/// Chosen on random growth and on slender plates. From 0.0078 on a long bridge is cut lengthwise.
constexpr double kWeakShare = 0.007;

std::size_t at(std::int32_t index) { return static_cast<std::size_t>(index); }

bool is_positive_definite(const Mat& matrix) {
  const Eigen::Map<const Eigen::Matrix<double, 6, 6>> view(matrix.values.data());
  return view.llt().info() == Eigen::Success;
}

/// One node of each pattern.
std::vector<std::size_t> examples(const Stage& stage) {
  std::vector<bool> is_met(stage.springs.size());
  std::vector<std::size_t> nodes;
  for (std::size_t node = 0; node < stage.order.size(); ++node) {
    const std::size_t pattern = stage.pattern[node];
    if (stage.start[node + 1] > stage.start[node] && !is_met[pattern]) {
      is_met[pattern] = true;
      nodes.push_back(node);
    }
  }
  return nodes;
}

/// By spring of the level: whether it is weak at its own node.
std::vector<std::uint8_t> weak_at_node(const Stage& stage, Team& team) {
  std::vector<std::uint8_t> is_weak(stage.springs.size());
  const std::vector<std::size_t> nodes = examples(stage);
  team.share(0, nodes.size(), [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) {
      const std::size_t first = stage.pattern[nodes[k]];
      const std::size_t last = first + at(stage.start[nodes[k] + 1] - stage.start[nodes[k]]);
      Mat sum{};
      for (std::size_t i = first; i < last; ++i) {
        base::add_to(sum, stage.springs[i].stiffness);
      }
      const Mat share = scaled(sum, -kWeakShare);
      for (std::size_t i = first; i < last; ++i) {
        Mat rest = stage.springs[i].stiffness;
        base::add_to(rest, share);
        is_weak[i] = is_positive_definite(rest) ? 0 : 1;
      }
    }
  });
  return is_weak;
}

/// The edge from `q` to `p`.
std::size_t edge_back(const Stage& stage, std::size_t p, std::size_t q) {
  std::size_t edge = at(stage.start[q]);
  while (at(stage.other[edge]) != p) {
    ++edge;
  }
  return edge;
}

}  // namespace

std::vector<std::uint8_t> weak_springs(const Stage& stage, Team& team) {
  if (stage.shift == 0) {
    return {};
  }
  const std::vector<std::uint8_t> is_weak = weak_at_node(stage, team);
  if (std::ranges::find(is_weak, 1) == is_weak.end()) {
    return {};
  }
  const auto spring = [&](std::size_t node, std::size_t edge) {
    return stage.pattern[node] + edge - at(stage.start[node]);
  };
  std::vector<std::uint8_t> edges(stage.other.size());
  for (std::size_t p = 0; p < stage.order.size(); ++p) {
    for (std::size_t e = at(stage.start[p]); e < at(stage.start[p + 1]); ++e) {
      const std::size_t q = at(stage.other[e]);
      edges[e] = is_weak[spring(p, e)] == 1 && is_weak[spring(q, edge_back(stage, p, q))] == 1;
    }
  }
  return edges;
}

}  // namespace holdfast::solver
