// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "holdfast/solver/block_pattern.hpp"

#include <Eigen/OrderingMethods>
#include <Eigen/SparseCore>
#include <algorithm>

#include "holdfast/base/algebra.hpp"

namespace holdfast::solver {
namespace {

/// Approximate minimum degree on the graph of nodes. Returns node -> place.
std::vector<std::int32_t> elimination_order(std::size_t node_count, std::span<const Edge> edges) {
  const auto n = static_cast<Eigen::Index>(node_count);
  std::vector<Eigen::Triplet<double, int>> entries;
  entries.reserve(2 * edges.size() + node_count);
  for (const Edge& edge : edges) {
    entries.emplace_back(edge.a, edge.b, 1.0);
    entries.emplace_back(edge.b, edge.a, 1.0);
  }
  for (int i = 0; i < static_cast<int>(node_count); ++i) {
    entries.emplace_back(i, i, 1.0);
  }
  Eigen::SparseMatrix<double, Eigen::ColMajor, int> pattern(n, n);
  pattern.setFromTriplets(entries.begin(), entries.end());
  Eigen::PermutationMatrix<Eigen::Dynamic, Eigen::Dynamic, int> order;
  Eigen::AMDOrdering<int> amd;
  amd(pattern, order);
  std::vector<std::int32_t> place(node_count);
  for (std::size_t i = 0; i < node_count; ++i) {
    place[static_cast<std::size_t>(order.indices()[static_cast<Eigen::Index>(i)])] =
        static_cast<std::int32_t>(i);
  }
  return place;
}

}  // namespace

// The rows of a column of L: those of A, and those of its children in the elimination tree.
std::optional<BlockPattern> block_pattern(std::size_t node_count, std::span<const Edge> edges,
                                          std::size_t block_count_max) {
  if (edges.size() > block_count_max) {
    return std::nullopt;  // Before anything fills in.
  }
  BlockPattern pattern;
  pattern.position = elimination_order(node_count, edges);
  std::vector<std::vector<std::int32_t>> below(node_count);
  for (const Edge& edge : edges) {
    const auto [low, high] =
        std::minmax(pattern.position[base::at(edge.a)], pattern.position[base::at(edge.b)]);
    below[base::at(low)].push_back(high);
  }
  pattern.parent.assign(node_count, -1);
  pattern.column_start.assign(node_count + 1, 0);
  for (std::size_t k = 0; k < node_count; ++k) {
    std::vector<std::int32_t>& rows = below[k];
    std::ranges::sort(rows);
    rows.erase(std::unique(rows.begin(), rows.end()), rows.end());
    pattern.column_start[k + 1] = pattern.column_start[k] + rows.size();
    if (pattern.column_start[k + 1] > block_count_max) {
      return std::nullopt;
    }
    pattern.rows.insert(pattern.rows.end(), rows.begin(), rows.end());
    if (!rows.empty()) {
      pattern.parent[k] = rows.front();
      std::vector<std::int32_t>& up = below[base::at(rows.front())];
      up.insert(up.end(), rows.begin() + 1, rows.end());
    }
    rows = {};
  }
  return pattern;
}

}  // namespace holdfast::solver
