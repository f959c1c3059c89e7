// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "holdfast/solver/block_lu.hpp"

#include <algorithm>
#include <atomic>
#include <map>
#include <optional>
#include <utility>

#include "factorization/block_kernels.hpp"
#include "factorization/column_pipeline.hpp"
#include "factorization/factor_kernels.hpp"
#include "holdfast/base/check.hpp"
#include "holdfast/host/team.hpp"
#include "holdfast/solver/block_pattern.hpp"

namespace holdfast::solver {
BlockLu::BlockLu(std::size_t node_count, std::span<const Edge> edges, std::size_t block_count_max,
                 Symmetry symmetry)
    : edges_(edges.begin(), edges.end()), symmetry_(symmetry) {
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
  is_positive_.resize(n);
  lower_.resize(rows_.size());
  upper_.resize(symmetry_ == Symmetry::kNone ? rows_.size() : 0);
  edge_lower_.resize(edges_.size());
  is_stale_.assign(n, true);
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

void BlockLu::set_symmetry(Symmetry symmetry) {
  if (symmetry == symmetry_) {
    return;
  }
  HOLDFAST_CHECK(symmetry != Symmetry::kPositive && symmetry_ != Symmetry::kPositive);
  symmetry_ = symmetry;
  allocate();
  if (symmetry == Symmetry::kSymmetric) {
    is_stale_.assign(is_stale_.size(), true);
  } else {
    make_upper();
  }
}

/// Makes L of L D, and U not yet divided by D, which is (L D)'.
void BlockLu::make_upper() {
  upper_.resize(rows_.size());
  for (std::size_t k = 0; k < position_.size(); ++k) {
    if (is_stale_[k]) {
      continue;
    }
    const std::size_t end = column_start_[k + 1];
    for (std::size_t slot = column_start_[k]; slot < end; ++slot) {
      upper_[slot] = transpose(lower_[slot]);
    }
    base::Mat6<double>* const lower = lower_.data();
    factor_kernels().multiply_each(lower + column_start_[k], lower + end, inverse_[k]);
  }
}

bool BlockLu::is_positive_definite() const {
  HOLDFAST_CHECK(symmetry_ == Symmetry::kSymmetric && !is_singular_);
  return std::ranges::all_of(is_positive_,
                             [](std::uint8_t is_positive) { return is_positive != 0; });
}

std::size_t BlockLu::factor_product_count() const {
  std::size_t count = 0;
  for (std::size_t k = 0; k < position_.size(); ++k) {
    const std::size_t rows = column_start_[k + 1] - column_start_[k];
    count += rows * (rows + 1) / 2;
  }
  return symmetry_ == Symmetry::kNone ? 2 * count : count;
}

bool BlockLu::factor(int thread_count) {
  std::vector<std::size_t> columns;
  for (std::size_t k = 0; k < position_.size(); ++k) {
    if (is_stale_[k]) {
      columns.push_back(k);
      if (parent_[k] >= 0) {
        is_stale_[static_cast<std::size_t>(parent_[k])] = true;
      }
    }
  }
  const bool is_whole = columns.size() == position_.size();
  ColumnPipeline pipeline(columns.size(), factor_product_count(), is_whole ? thread_count : 1);
  // Where columns are shared all of them are made: the turn is the column.
  const auto wait_for = [&](std::int32_t column) { return pipeline.wait_for(base::at(column)); };
  std::atomic<std::size_t> made_count{0};
  is_singular_ = !pipeline.run<Scratch>([&](std::size_t turn, Scratch& scratch) {
    made_count.fetch_add(1, std::memory_order_relaxed);
    return make_column(columns[turn], scratch, wait_for);
  });
  made_column_count_ += made_count.load();
  if (!is_singular_) {
    is_stale_.assign(is_stale_.size(), false);
  }
  return !is_singular_;
}

/// Column k of L and row k of U: A minus what the columns to the left contribute. Where A is
/// symmetric, U is D L'. Returns false if the pivot is singular.
template <class WaitFor>
bool BlockLu::make_column(std::size_t k, Scratch& scratch, const WaitFor& wait_for) {
  scratch.slot_of_row.resize(position_.size());
  const std::size_t begin = column_start_[k];
  const std::size_t end = column_start_[k + 1];
  base::Mat6<double>* const lower = lower_.data();
  base::Mat6<double>* const upper = symmetry_ == Symmetry::kNone ? upper_.data() : nullptr;
  for (std::size_t slot = begin; slot < end; ++slot) {
    lower[slot] = {};
    scratch.slot_of_row[static_cast<std::size_t>(rows_[slot])] = slot;
  }
  for (std::size_t slot = begin; upper != nullptr && slot < end; ++slot) {
    upper[slot] = {};
  }
  for (const std::size_t edge : column_edges_[k]) {
    lower[edge_slot_[edge]] = edge_lower_[edge];
    if (upper != nullptr) {
      upper[edge_slot_[edge]] = transpose(edge_lower_[edge]);
    }
  }
  base::Mat6<double> pivot = diagonal_[k];
  const bool is_made = symmetry_ == Symmetry::kNone
                           ? subtract_left(k, pivot, wait_for, scratch)
                           : subtract_left_symmetric(k, pivot, wait_for, scratch);
  if (!is_made) {
    return false;
  }
  if (symmetry_ == Symmetry::kPositive) {
    inverse_[k] = inverse_root(pivot, diagonal_[k]);
    factor_kernels().multiply_each(lower + begin, lower + end, transpose(inverse_[k]));
    return true;
  }
  if (symmetry_ == Symmetry::kSymmetric) {
    // Not of the inverse, whose small numbers are rounding where a block's scales are far apart.
    is_positive_[k] = solver::is_positive_definite(pivot) ? 1 : 0;
  }
  if (!invert(pivot, inverse_[k])) {
    return false;
  }
  if (upper != nullptr) {
    factor_kernels().multiply_each(lower + begin, lower + end, inverse_[k]);
  }
  return true;
}

/// Returns false if a column to the left is not made.
template <class WaitFor>
bool BlockLu::subtract_left(std::size_t k, base::Mat6<double>& pivot, const WaitFor& wait_for,
                            const Scratch& scratch) {
  const FactorKernels& kernels = factor_kernels();
  base::Mat6<double>* const lower = lower_.data();
  base::Mat6<double>* const upper = upper_.data();
  for (std::size_t entry = row_start_[k]; entry < row_start_[k + 1]; ++entry) {
    const auto [left, slot_k] = row_entries_[entry];
    if (!wait_for(left)) {
      return false;
    }
    kernels.subtract_product(pivot, lower[slot_k], upper[slot_k]);
    kernels.update_column({.rows = rows_.data(),
                           .slot_of_row = scratch.slot_of_row.data(),
                           .lower = lower,
                           .upper = upper,
                           .source = slot_k,
                           .first = slot_k + 1,
                           .last = column_start_[base::at(left) + 1]});
  }
  return true;
}

/// Does what subtract_left() does where A is symmetric. A column's parent has all its rows below,
/// so if it has as many from row k on, they are the same ones: such columns go together.
template <class WaitFor>
bool BlockLu::subtract_left_symmetric(std::size_t k, base::Mat6<double>& pivot,
                                      const WaitFor& wait_for, const Scratch& scratch) {
  const auto rows_from = [&](const Entry& entry) {
    return column_start_[base::at(entry.column) + 1] - entry.slot;
  };
  const bool has_roots = symmetry_ == Symmetry::kPositive;
  SymmetricUpdate::Source sources[SymmetricUpdate::kSourceMax];
  for (std::size_t entry = row_start_[k]; entry < row_start_[k + 1];) {
    const std::size_t row_count = rows_from(row_entries_[entry]);
    std::size_t count = 0;
    do {
      const auto [left, slot_k] = row_entries_[entry++];
      if (!wait_for(left)) {
        return false;
      }
      sources[count++] = {.column = base::at(left), .slot = slot_k};
    } while (count < SymmetricUpdate::kSourceMax && entry < row_start_[k + 1] &&
             parent_[sources[count - 1].column] == row_entries_[entry].column &&
             rows_from(row_entries_[entry]) == row_count);
    factor_kernels().update_symmetric({.rows = rows_.data(),
                                       .slot_of_row = scratch.slot_of_row.data(),
                                       .lower = lower_.data(),
                                       .pivot = &pivot,
                                       .inverse = has_roots ? nullptr : inverse_.data(),
                                       .sources = sources,
                                       .source_count = count,
                                       .row_count = row_count});
  }
  return true;
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

FactorView BlockLu::view() const {
  return {.place_count = position_.size(),
          .column_start = column_start_.data(),
          .rows = rows_.data(),
          .lower = lower_.data(),
          .upper = symmetry_ == Symmetry::kNone ? upper_.data() : nullptr,
          .inverse = inverse_.data(),
          .has_roots = symmetry_ == Symmetry::kPositive};
}

/// Forward and backward substitution for `count` right-hand sides, by place, then by side.
void BlockLu::substitute(std::span<base::Vec6<double>> y, std::size_t count) const {
  factor_kernels().substitute(view(), y.data(), count);
}

void BlockLu::solve_lanes(std::span<LaneBlock> y) const {
  HOLDFAST_CHECK(y.size() == position_.size() && symmetry_ == Symmetry::kSymmetric &&
                 !is_singular_);
  factor_kernels().solve_lanes(view(), y.data());
}

}  // namespace holdfast::solver
