// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0

// Cut vertices of random graphs are those without which a walk does not reach all others.

#include "cut_vertices.hpp"

#include <gtest/gtest.h>

#include "holdfast/base/rng.hpp"

namespace holdfast::plan {
namespace {

constexpr std::int32_t kCount = 12;

/// graph[a][b] is b, or -1 if a and b are not joined.
using Graph = std::vector<std::vector<std::int32_t>>;

Graph random_graph(std::uint64_t seed) {
  base::Rng rng(seed);
  Graph graph(kCount, std::vector<std::int32_t>(kCount, -1));
  for (std::uint64_t edge = 8 + rng.below(14); edge > 0; --edge) {
    const auto a = static_cast<std::int32_t>(rng.below(kCount));
    const auto b = static_cast<std::int32_t>(rng.below(kCount));
    if (a != b) {
      graph[base::at(a)][base::at(b)] = b;
      graph[base::at(b)][base::at(a)] = a;
    }
  }
  return graph;
}

std::vector<std::int32_t> reached_from(const Graph& graph, std::int32_t first,
                                       std::int32_t without) {
  std::vector<std::int32_t> reached = {first};
  for (std::size_t i = 0; i < reached.size(); ++i) {
    for (const std::int32_t other : graph[base::at(reached[i])]) {
      if (other >= 0 && other != without && std::ranges::find(reached, other) == reached.end()) {
        reached.push_back(other);
      }
    }
  }
  return reached;
}

TEST(CutVertices, are_those_without_which_others_cannot_be_reached) {
  int cut_count = 0;
  for (std::uint64_t seed = 0; seed < 500; ++seed) {
    const Graph graph = random_graph(seed);
    const std::vector<bool> is_cut = cut_vertices(
        kCount, 0, kCount,
        [&](std::int32_t node, std::size_t place) { return graph[base::at(node)][place]; });
    const std::vector<std::int32_t> all = reached_from(graph, 0, -1);
    for (std::int32_t node = 0; node < kCount; ++node) {
      const bool is_there = std::ranges::find(all, node) != all.end();
      const auto other = std::ranges::find_if(all, [&](std::int32_t each) { return each != node; });
      const bool expected = is_there && other != all.end() &&
                            reached_from(graph, *other, node).size() + 1 < all.size();
      EXPECT_EQ(is_cut[base::at(node)], expected) << seed << " " << node;
      cut_count += expected ? 1 : 0;
    }
  }
  EXPECT_GT(cut_count, 500);
}

}  // namespace
}  // namespace holdfast::plan
