// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "holdfast/solver/block_lu.hpp"

#include <algorithm>
#include <optional>
#include <utility>

#include "block_kernels.hpp"
#include "holdfast/base/check.hpp"
#include "holdfast/solver/block_pattern.hpp"
#include "lane_substitution.hpp"

namespace holdfast::solver {
BlockLu::BlockLu(std::size_t node_count, std::span<const Edge> edges, std::size_t block_count_max)
    : edges_(edges.begin(), edges.end()) {
  std::optional<BlockPattern> pattern = block_pattern(node_count, edges, block_count_max);
  is_too_large_ = !pattern;
  if (is_too_large_) {
    return;
  }
  position_ = std::move(pattern->position);
  parent_ = std::move(pattern->parent);
  column_start_ = std::move(pattern->column_start);
  rows_ = std::move(pattern->rows);
  column_edges_.resize(node_count);
  for (std::size_t e = 0; e < edges_.size(); ++e) {
    edges_[e] = {position_[base::at(edges_[e].a)], position_[base::at(edges_[e].b)]};
    column_edges_[base::at(std::min(edges_[e].a, edges_[e].b))].push_back(e);
  }
  make_row_lists();
}

void BlockLu::make_row_lists() {
  const std::size_t n = position_.size();
  row_start_.assign(n + 1, 0);
  for (const std::int32_t row : rows_) {
    ++row_start_[static_cast<std::size_t>(row) + 1];
  }
  for (std::size_t k = 0; k < n; ++k) {
    row_start_[k + 1] += row_start_[k];
  }
  row_entries_.resize(rows_.size());
  std::vector<std::size_t> next(row_start_.begin(), row_start_.end() - 1);
  for (std::size_t k = 0; k < n; ++k) {
    for (std::size_t slot = column_start_[k]; slot < column_start_[k + 1]; ++slot) {
      row_entries_[next[static_cast<std::size_t>(rows_[slot])]++] = {static_cast<std::int32_t>(k),
                                                                     slot};
    }
  }
}

void BlockLu::allocate() {
  if (inverse_.size() == position_.size()) {
    return;
  }
  const std::size_t n = position_.size();
  diagonal_.resize(n);
  inverse_.resize(n);
  lower_.resize(rows_.size());
  upper_.resize(rows_.size());
  edge_lower_.resize(edges_.size());
  is_stale_.assign(n, true);
  slot_of_row_.resize(n);
  edge_slot_.resize(edges_.size());
  for (std::size_t e = 0; e < edges_.size(); ++e) {
    const auto [low, high] = std::minmax(edges_[e].a, edges_[e].b);
    edge_slot_[e] = find_slot(low, high);
  }
}

std::size_t BlockLu::find_slot(std::int32_t column, std::int32_t row) const {
  const auto k = static_cast<std::size_t>(column);
  const auto first = rows_.begin() + static_cast<std::ptrdiff_t>(column_start_[k]);
  const auto last = rows_.begin() + static_cast<std::ptrdiff_t>(column_start_[k + 1]);
  const auto found = std::lower_bound(first, last, row);
  HOLDFAST_ASSERT(found != last && *found == row);
  return static_cast<std::size_t>(found - rows_.begin());
}

void BlockLu::set_edge(std::size_t edge, const base::Mat6<double>& ab) {
  allocate();
  const auto [a, b] = edges_[edge];
  edge_lower_[edge] = a > b ? ab : transpose(ab);
  is_stale_[static_cast<std::size_t>(std::min(a, b))] = true;
}

void BlockLu::set_diagonal(std::size_t node, const base::Mat6<double>& block) {
  allocate();
  const auto place = static_cast<std::size_t>(position_[node]);
  diagonal_[place] = block;
  is_stale_[place] = true;
}

bool BlockLu::factor() {
  is_singular_ = false;
  for (std::size_t k = 0; k < position_.size() && !is_singular_; ++k) {
    if (is_stale_[k]) {
      make_column(k);
      ++made_column_count_;
      if (parent_[k] >= 0) {
        is_stale_[static_cast<std::size_t>(parent_[k])] = true;
      }
    }
  }
  if (!is_singular_) {
    is_stale_.assign(is_stale_.size(), false);
  }
  return !is_singular_;
}

/// Column k of L and row k of U: A minus what the columns to the left contribute.
void BlockLu::make_column(std::size_t k) {
  const std::size_t begin = column_start_[k];
  const std::size_t end = column_start_[k + 1];
  for (std::size_t slot = begin; slot < end; ++slot) {
    lower_[slot] = {};
    upper_[slot] = {};
    slot_of_row_[static_cast<std::size_t>(rows_[slot])] = slot;
  }
  for (const std::size_t edge : column_edges_[k]) {
    lower_[edge_slot_[edge]] = edge_lower_[edge];
    upper_[edge_slot_[edge]] = transpose(edge_lower_[edge]);
  }
  base::Mat6<double> pivot = diagonal_[k];
  for (std::size_t entry = row_start_[k]; entry < row_start_[k + 1]; ++entry) {
    const auto [left, slot_k] = row_entries_[entry];
    const base::Mat6<double>& l_kj = lower_[slot_k];
    const base::Mat6<double>& u_jk = upper_[slot_k];
    subtract_product(pivot, l_kj, u_jk);
    const std::size_t left_end = column_start_[static_cast<std::size_t>(left) + 1];
    for (std::size_t slot = slot_k + 1; slot < left_end; ++slot) {
      const std::size_t target = slot_of_row_[static_cast<std::size_t>(rows_[slot])];
      subtract_product(lower_[target], lower_[slot], u_jk);
      subtract_product(upper_[target], l_kj, upper_[slot]);
    }
  }
  if (!invert(pivot, inverse_[k])) {
    is_singular_ = true;
    return;
  }
  for (std::size_t slot = begin; slot < end; ++slot) {
    lower_[slot] = product(lower_[slot], inverse_[k]);
  }
}

void BlockLu::solve(std::span<base::Vec6<double>> x) const {
  HOLDFAST_CHECK(x.size() == position_.size() && !is_singular_);
  std::vector<base::Vec6<double>> y(x.size());
  for (std::size_t node = 0; node < x.size(); ++node) {
    y[static_cast<std::size_t>(position_[node])] = x[node];
  }
  substitute(y, 1);
  for (std::size_t node = 0; node < x.size(); ++node) {
    x[node] = y[static_cast<std::size_t>(position_[node])];
  }
}

void BlockLu::solve_each(std::span<std::vector<base::Vec6<double>>> columns) const {
  HOLDFAST_CHECK(!is_singular_);
  const std::size_t count = columns.size();
  std::vector<base::Vec6<double>> y(count * position_.size());
  for (std::size_t c = 0; c < count; ++c) {
    HOLDFAST_CHECK(columns[c].size() == position_.size());
    for (std::size_t node = 0; node < position_.size(); ++node) {
      y[count * static_cast<std::size_t>(position_[node]) + c] = columns[c][node];
    }
  }
  substitute(y, count);
  for (std::size_t c = 0; c < count; ++c) {
    for (std::size_t node = 0; node < position_.size(); ++node) {
      columns[c][node] = y[count * static_cast<std::size_t>(position_[node]) + c];
    }
  }
}

/// Forward and backward substitution for `count` right-hand sides, by place, then by side.
void BlockLu::substitute(std::span<base::Vec6<double>> y, std::size_t count) const {
  const std::size_t n = position_.size();
  for (std::size_t k = 0; k < n; ++k) {
    for (std::size_t slot = column_start_[k]; slot < column_start_[k + 1]; ++slot) {
      const std::size_t row = count * static_cast<std::size_t>(rows_[slot]);
      for (std::size_t c = 0; c < count; ++c) {
        subtract_product(y[row + c], lower_[slot], y[count * k + c]);
      }
    }
  }
  for (std::size_t k = n; k-- > 0;) {
    for (std::size_t slot = column_start_[k]; slot < column_start_[k + 1]; ++slot) {
      const std::size_t row = count * static_cast<std::size_t>(rows_[slot]);
      for (std::size_t c = 0; c < count; ++c) {
        subtract_product(y[count * k + c], upper_[slot], y[row + c]);
      }
    }
    for (std::size_t c = 0; c < count; ++c) {
      y[count * k + c] = multiply(inverse_[k], y[count * k + c]);
    }
  }
}

void BlockLu::solve_lanes(std::span<LaneBlock> y) const {
  HOLDFAST_CHECK(y.size() == position_.size() && !is_singular_);
  lane_substitution()({.place_count = position_.size(),
                       .column_start = column_start_.data(),
                       .rows = rows_.data(),
                       .lower = lower_.data(),
                       .upper = upper_.data(),
                       .inverse = inverse_.data()},
                      y.data());
}

void BlockLu::forward(std::size_t node, std::vector<std::int32_t>& places,
                      std::vector<base::Mat6<double>>& blocks) const {
  places.clear();
  for (std::int32_t k = position_[node]; k >= 0; k = parent_[static_cast<std::size_t>(k)]) {
    places.push_back(k);
  }
  blocks.assign(places.size(), {});
  for (int i = 0; i < 6; ++i) {
    blocks.front().at(i, i) = 1;
  }
  for (std::size_t i = 0; i < places.size(); ++i) {
    const auto k = static_cast<std::size_t>(places[i]);
    std::size_t target = i;  // Rows of a column ascend on the same way up.
    for (std::size_t slot = column_start_[k]; slot < column_start_[k + 1]; ++slot) {
      while (places[target] != rows_[slot]) {
        ++target;
      }
      subtract_product(blocks[target], lower_[slot], blocks[i]);
    }
  }
}

base::Mat6<double> BlockLu::symmetric_product(std::span<const std::int32_t> places_a,
                                              std::span<const base::Mat6<double>> a,
                                              std::span<const std::int32_t> places_b,
                                              std::span<const base::Mat6<double>> b) const {
  // Two ways up the tree have their ends in common, and nothing else.
  base::Mat6<double> sum;
  std::size_t i = places_a.size();
  std::size_t j = places_b.size();
  while (i > 0 && j > 0 && places_a[i - 1] == places_b[j - 1]) {
    --i;
    --j;
    const auto k = static_cast<std::size_t>(places_a[i]);
    base::add_to(sum, product(transpose(a[i]), product(inverse_[k], b[j])));
  }
  return sum;
}

}  // namespace holdfast::solver
