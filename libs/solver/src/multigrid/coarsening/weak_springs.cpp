// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "multigrid/coarsening/weak_springs.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <array>

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

/// 1 for every edge whose spring is weak at its own node, and at the other where that is no copy.
std::vector<std::uint8_t> weak_here(const SpringGraph& graph,
                                    const std::vector<std::uint8_t>& is_weak) {
  const auto is_weak_at = [&](std::size_t node, std::size_t edge) {
    return is_weak[graph.pattern[node] + edge - at(graph.start[node])] == 1;
  };
  std::vector<std::uint8_t> edges(graph.other.size());
  for (std::size_t p = 0; p < graph.own_count(); ++p) {
    for (std::size_t e = at(graph.start[p]); e < at(graph.start[p + 1]); ++e) {
      const std::size_t q = at(graph.other[e]);
      edges[e] = is_weak_at(p, e) &&
                         (graph.is_copy(graph.other[e]) || is_weak_at(q, edge_back(graph, p, q)))
                     ? 1
                     : 0;
    }
  }
  return edges;
}

/// A node's neighbours at other ranks by springs that are weak at the node. Clusters hardly have
/// more than there is room for; the springs to the rest do not count as weak, at either end.
class WeakPartners {
 public:
  void add(const host::Original& partner) {
    if (count_ < kMax) {
      partners_[count_++] = partner;
    }
  }

  bool has(const host::Original& partner) const {
    const auto end = partners_.begin() + static_cast<std::ptrdiff_t>(count_);
    return std::find(partners_.begin(), end, partner) != end;
  }

 private:
  static constexpr std::size_t kMax = 8;
  std::array<host::Original, kMax> partners_{};
  std::size_t count_ = 0;
};

/// Leaves weak, of the springs between ranks, those that both ends' ranks find weak.
void agree_across_ranks(const SpringGraph& graph, host::Halo& copies,
                        std::vector<std::uint8_t>& edges) {
  std::vector<host::Original> original(graph.order.size());
  for (const host::Copy& copy : graph.copies) {
    original[at(copy.place)] = copy.original;
  }
  const auto for_weak_across = [&](const auto& f) {
    for (std::size_t p = 0; p < graph.own_count(); ++p) {
      for (std::size_t e = at(graph.start[p]); e < at(graph.start[p + 1]); ++e) {
        if (edges[e] == 1 && graph.is_copy(graph.other[e])) {
          f(p, e, at(graph.other[e]));
        }
      }
    }
  };
  std::vector<WeakPartners> partners(graph.order.size());
  for_weak_across([&](std::size_t p, std::size_t, std::size_t q) { partners[p].add(original[q]); });
  copies.update(partners.data(), sizeof(WeakPartners));
  for_weak_across([&](std::size_t p, std::size_t e, std::size_t q) {
    const host::Original here = {.rank = graph.ranks.get().rank(),
                                 .index = static_cast<std::int32_t>(p)};
    edges[e] = partners[p].has(original[q]) && partners[q].has(here) ? 1 : 0;
  });
}

}  // namespace

std::vector<std::uint8_t> weak_springs(const SpringGraph& graph, host::Team& team,
                                       host::Halo& copies) {
  if (graph.shift == 0) {
    return {};
  }
  const std::vector<std::uint8_t> is_weak = weak_at_node(graph, team);
  const bool is_any_weak = std::ranges::find(is_weak, 1) != is_weak.end();
  if (!host::any(graph.ranks, is_any_weak)) {
    return {};
  }
  std::vector<std::uint8_t> edges = weak_here(graph, is_weak);
  if (graph.is_part()) {
    agree_across_ranks(graph, copies, edges);
  }
  return edges;
}

}  // namespace holdfast::solver
