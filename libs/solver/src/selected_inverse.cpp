// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <iterator>
#include <utility>

#include "block_kernels.hpp"
#include "column_pipeline.hpp"
#include "factor_kernels.hpp"
#include "holdfast/base/check.hpp"
#include "holdfast/solver/block_lu.hpp"

namespace holdfast::solver {
namespace {

/// What a thread needs to make columns.
struct Scratch {
  std::vector<base::Mat6<double>> blocks;
};

}  // namespace

SelectedInverse BlockLu::selected_inverse(std::span<const std::size_t> nodes,
                                          std::span<const Edge> pairs, int thread_count) const {
  HOLDFAST_CHECK(symmetry_ == Symmetry::kSymmetric && !is_singular_);
  SelectedInverse inverse(*this, nodes, pairs);
  inverse.make(thread_count);
  return inverse;
}

SelectedInverse::SelectedInverse(const BlockLu& lu, std::span<const std::size_t> nodes,
                                 std::span<const Edge> pairs)
    : lu_(&lu) {
  const std::size_t count = lu.node_count();
  turn_.assign(count, kNone);
  for (const std::size_t node : nodes) {
    for (std::int32_t k = lu.position_[node]; k >= 0 && turn_[base::at(k)] == kNone;
         k = lu.parent_[base::at(k)]) {
      turn_[base::at(k)] = 0;
    }
  }
  for (std::size_t k = count; k-- > 0;) {
    if (turn_[k] != kNone) {
      turn_[k] = columns_.size();
      columns_.push_back(static_cast<std::int32_t>(k));
    }
  }
  std::vector<std::vector<std::int32_t>> more(count);
  for (const Edge& pair : pairs) {
    const auto [low, high] =
        std::minmax(lu.position_[base::at(pair.a)], lu.position_[base::at(pair.b)]);
    if (low != high) {
      more[base::at(low)].push_back(high);
    }
  }
  find_rows(std::move(more));
}

/// Z_ik needs Z_ij for every row j of the factors' column k. For rows i of that column the factors
/// have all of these; for `more` ones they go to their own columns, which stand behind. The parent
/// has the rows of column k below it, so that from there on it asks for the same.
void SelectedInverse::find_rows(std::vector<std::vector<std::int32_t>> more) {
  column_start_.assign(lu_->node_count() + 1, 0);
  std::vector<std::int32_t> extra;
  for (std::size_t k = 0; k < lu_->node_count(); ++k) {
    column_start_[k + 1] = column_start_[k];
    if (turn_[k] == kNone) {
      continue;
    }
    const auto begin = lu_->rows_.begin() + static_cast<std::ptrdiff_t>(lu_->column_start_[k]);
    const auto end = lu_->rows_.begin() + static_cast<std::ptrdiff_t>(lu_->column_start_[k + 1]);
    std::ranges::sort(more[k]);
    more[k].erase(std::unique(more[k].begin(), more[k].end()), more[k].end());
    extra.clear();
    std::set_difference(more[k].begin(), more[k].end(), begin, end, std::back_inserter(extra));
    for (const std::int32_t i : extra) {
      if (begin != end && i > *begin) {
        more[base::at(*begin)].push_back(i);
      } else {
        more[base::at(i)].insert(more[base::at(i)].end(), begin, end);
      }
    }
    std::merge(begin, end, extra.begin(), extra.end(), std::back_inserter(rows_));
    column_start_[k + 1] = rows_.size();
    more[k] = {};
  }
}

std::size_t SelectedInverse::product_count() const {
  std::size_t count = 0;
  for (const std::int32_t column : columns_) {
    const auto k = base::at(column);
    count += (column_start_[k + 1] - column_start_[k]) *
             (lu_->column_start_[k + 1] - lu_->column_start_[k]);
  }
  return count;
}

void SelectedInverse::make(int thread_count) {
  diagonal_.resize(lu_->node_count());
  below_.resize(rows_.size());
  const FactorView factors = lu_->view();
  const InverseView view{.column_start = column_start_.data(),
                         .rows = rows_.data(),
                         .diagonal = diagonal_.data(),
                         .below = below_.data()};
  const FactorKernels& kernels = factor_kernels();
  ColumnPipeline pipeline(columns_.size(), product_count(), thread_count);
  const bool is_made = pipeline.run<Scratch>([&](std::size_t turn, Scratch& scratch) {
    const auto k = base::at(columns_[turn]);
    const std::size_t count = column_start_[k + 1] - column_start_[k];
    scratch.blocks.resize(std::max(scratch.blocks.size(), 4 * count));
    const InverseColumn column{.k = k,
                               .straight = scratch.blocks.data(),
                               .across = scratch.blocks.data() + count,
                               .lower = scratch.blocks.data() + 2 * count,
                               .lower_across = scratch.blocks.data() + 3 * count};
    kernels.begin_inverse(factors, view, column);
    for (std::size_t row = count; row-- > 0;) {  // The parent's is made last.
      if (!pipeline.wait_for(turn_[base::at(rows_[column_start_[k] + row])])) {
        return false;
      }
      kernels.add_to_inverse(factors, view, column, row);
    }
    kernels.end_inverse(factors, view, column);
    return true;
  });
  HOLDFAST_CHECK(is_made);
}

base::Mat6<double> SelectedInverse::block(std::size_t node_a, std::size_t node_b) const {
  const std::int32_t a = lu_->position_[node_a];
  const std::int32_t b = lu_->position_[node_b];
  if (a == b) {
    return diagonal_[base::at(a)];
  }
  const auto k = base::at(std::min(a, b));
  const auto begin = rows_.begin() + static_cast<std::ptrdiff_t>(column_start_[k]);
  const auto end = rows_.begin() + static_cast<std::ptrdiff_t>(column_start_[k + 1]);
  const auto found = std::lower_bound(begin, end, std::max(a, b));
  HOLDFAST_ASSERT(found != end && *found == std::max(a, b));
  const base::Mat6<double>& below = below_[static_cast<std::size_t>(found - rows_.begin())];
  return a > b ? below : transpose(below);
}

}  // namespace holdfast::solver
