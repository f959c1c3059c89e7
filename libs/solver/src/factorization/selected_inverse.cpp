// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <iterator>
#include <span>
#include <utility>
#include <vector>

#include "factorization/block_kernels.hpp"
#include "factorization/column_pipeline.hpp"
#include "factorization/factor_kernels.hpp"
#include "holdfast/base/check.hpp"
#include "holdfast/solver/block_lu.hpp"

namespace holdfast::solver {
namespace {

using Square = base::Mat6<double>;

/// More columns share what is looked up for their rows, fewer let threads share the last columns,
/// which need one another.
constexpr std::size_t kPanelColumnMax = 8;

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
  find_panels();
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

void SelectedInverse::find_panels() {
  const auto has_rows_of_next = [](const std::vector<std::size_t>& start, std::size_t k) {
    return start[k + 1] - start[k] == start[k + 2] - start[k + 1] + 1;
  };
  for (const std::int32_t column : columns_) {
    const auto k = base::at(column);
    if (!panels_.empty() && lu_->parent_[k] == column + 1 &&
        panels_.back().column_count < kPanelColumnMax && has_rows_of_next(lu_->column_start_, k) &&
        has_rows_of_next(column_start_, k)) {
      panels_.back().first = k;
      ++panels_.back().column_count;
    } else {
      panels_.push_back({.first = k, .column_count = 1});
    }
    turn_[k] = panels_.size() - 1;
  }
}

/// Makes the panels J of Z, one after another, with what it needs for each. For the rows R below
/// that the factors or Z have,
///   Z_RJ = - Z_RF M,   M = L_FJ L_JJ^-1,   F: the factors' rows,
/// and then for its columns k, from the last to the first, with H the other rows of column k in L,
///   Z_ik = - Z_iH L_Hk for i in J,   Z_kk = D_k^-1 - Z_Hk' L_Hk.
/// Of Z_ij and Z_ji' one is there; what the other gives is summed up transposed.
class SelectedInverse::PanelMaker {
 public:
  PanelMaker() = default;

  /// Keeps a reference.
  void begin(SelectedInverse& inverse, const Panel& panel) {
    z_ = &inverse;
    lu_ = inverse.lu_;
    panel_ = panel;
    const std::size_t last = panel.first + panel.column_count - 1;
    rows_ = std::span(z_->rows_).subspan(z_->column_start_[last],
                                         z_->column_start_[last + 1] - z_->column_start_[last]);
    find_ranks(std::span(lu_->rows_)
                   .subspan(lu_->column_start_[last],
                            lu_->column_start_[last + 1] - lu_->column_start_[last]));
    take_factors();
    across_.assign(panel_.column_count * rows_.size(), Square{});
    by_row_.resize(kPanelColumnMax * rows_.size());
  }

  /// Takes what the columns of other panels give; false if one of these will not be made. The
  /// parent's is the last.
  template <class WaitFor>
  [[nodiscard]] bool take_others(const WaitFor& wait_for) {
    for (std::size_t end = rows_.size(); end > 0;) {
      const std::size_t turn = z_->turn_[base::at(rows_[end - 1])];
      std::size_t begin = end;
      while (begin > 0 && z_->turn_[base::at(rows_[begin - 1])] == turn) {
        --begin;
      }
      if (!wait_for(turn)) {
        return false;
      }
      for (std::size_t p = begin; p < end; ++p) {
        take_column(p, ranks_before_[begin]);
      }
      take_straight(begin, end);
      end = begin;
    }
    return true;
  }

  void finish() {
    for (std::size_t t = 0; t < panel_.column_count; ++t) {
      for (std::size_t i = 0; i < rows_.size(); ++i) {
        base::add_to(below(t, i), transpose(across_[t * rows_.size() + i]));
      }
    }
    own_.assign(panel_.column_count * panel_.column_count, Square{});
    for (std::size_t t = panel_.column_count; t-- > 0;) {
      finish_column(t);
    }
  }

 private:
  using Blocks = std::vector<Square>;
  using List = std::vector<const Square*>;

  /// Finds which of the rows the factors have.
  void find_ranks(std::span<const std::int32_t> factor_rows) {
    factor_row_count_ = factor_rows.size();
    ranks_before_.assign(1, 0);
    row_of_rank_.clear();
    for (std::size_t i = 0; i < rows_.size(); ++i) {
      const std::size_t rank = ranks_before_.back();
      const bool is_of_factors = rank < factor_row_count_ && factor_rows[rank] == rows_[i];
      if (is_of_factors) {
        row_of_rank_.push_back(i);
      }
      ranks_before_.push_back(rank + (is_of_factors ? 1 : 0));
    }
  }

  bool is_of_factors(std::size_t i) const { return ranks_before_[i + 1] > ranks_before_[i]; }

  /// L and M with their transposes. Of a column of the panel its own rows come first.
  void take_factors() {
    const std::size_t columns = panel_.column_count;
    const std::size_t stride = columns + factor_row_count_;
    for (Blocks* const blocks : {&lower_, &lower_across_, &solved_, &solved_across_}) {
      blocks->resize(columns * stride);
    }
    for (List* const list : {&lower_across_list_, &solved_list_, &solved_across_list_}) {
      list->resize(columns * stride);
    }
    stride_ = stride;
    for (std::size_t t = columns; t-- > 0;) {
      const std::size_t k = panel_.first + t;
      const Square* const from = lu_->lower_.data() + lu_->column_start_[k];
      const std::size_t own = columns - 1 - t;
      for (std::size_t i = 0; i < own + factor_row_count_; ++i) {
        const std::size_t at = t * stride + i;
        lower_[at] = product(from[i], lu_->inverse_[k]);
        lower_across_[at] = transpose(lower_[at]);
        lower_across_list_[at] = &lower_across_[at];
      }
      solve_column(t, own);
    }
  }

  /// M_t = L_t - sum over the columns u of the panel behind t of M_u L_ut, by rank.
  void solve_column(std::size_t t, std::size_t own) {
    const Square* left[kPanelColumnMax];
    const Square* right[kPanelColumnMax];
    for (std::size_t i = 0; i < factor_row_count_; ++i) {
      const std::size_t at = t * stride_ + i;
      solved_[at] = lower_[t * stride_ + own + i];
      for (std::size_t u = 0; u < own; ++u) {
        left[u] = &solved_[(t + 1 + u) * stride_ + i];
        right[u] = &lower_[t * stride_ + u];
      }
      factor_kernels().subtract_products(solved_[at], left, right, own);
      solved_across_[at] = transpose(solved_[at]);
      solved_list_[at] = &solved_[at];
      solved_across_list_[at] = &solved_across_[at];
    }
  }

  /// Row i of the rows below the panel in its column t.
  Square& below(std::size_t t, std::size_t i) {
    return z_->below_[z_->column_start_[panel_.first + t] + panel_.column_count - 1 - t + i];
  }

  /// Lists the blocks Z_ip for rows i from p on, and takes Z_pi M_i of those below it.
  void take_column(std::size_t p, std::size_t rank_begin) {
    const auto place = base::at(rows_[p]);
    const bool is_straight = is_of_factors(p);
    by_column_.clear();
    if (is_straight) {
      by_row_[kPanelColumnMax * p + ranks_before_[p] - rank_begin] = &z_->diagonal_[place];
    }
    std::size_t slot = z_->column_start_[place];
    for (std::size_t i = p + 1; i < rows_.size(); ++i) {
      if (!is_straight && !is_of_factors(i)) {
        continue;
      }
      while (z_->rows_[slot] != rows_[i]) {
        ++slot;  // The column of this row has all that are needed.
      }
      const Square* const block = &z_->below_[slot];
      if (is_straight) {
        by_row_[kPanelColumnMax * i + ranks_before_[p] - rank_begin] = block;
      }
      if (is_of_factors(i)) {
        by_column_.push_back(block);
      }
    }
    for (std::size_t t = 0; t < panel_.column_count; ++t) {
      factor_kernels().subtract_products(
          across_[t * rows_.size() + p],
          solved_across_list_.data() + t * stride_ + ranks_before_[p + 1], by_column_.data(),
          by_column_.size());
    }
  }

  /// Takes Z_ip M_p for all p of [begin, end) and the rows i from p on.
  void take_straight(std::size_t begin, std::size_t end) {
    const std::size_t rank_begin = ranks_before_[begin];
    for (std::size_t i = begin; i < rows_.size(); ++i) {
      const std::size_t count = ranks_before_[std::min(i + 1, end)] - rank_begin;
      for (std::size_t t = 0; t < panel_.column_count && count > 0; ++t) {
        factor_kernels().subtract_products(below(t, i), by_row_.data() + kPanelColumnMax * i,
                                           solved_list_.data() + t * stride_ + rank_begin, count);
      }
    }
  }

  void finish_column(std::size_t t) {
    const std::size_t columns = panel_.column_count;
    const std::size_t own = columns - 1 - t;
    const std::size_t k = panel_.first + t;
    const Square* const* const lower_across = lower_across_list_.data() + t * stride_;
    const auto list_below = [&](std::size_t u) {
      for (const std::size_t i : row_of_rank_) {
        by_column_.push_back(&below(u, i));
      }
    };
    for (std::size_t u = columns - 1; u > t; --u) {
      by_column_.clear();
      list_below(u);
      Square turned;
      factor_kernels().subtract_products(turned, lower_across + own, by_column_.data(),
                                         factor_row_count_);
      Square block = transpose(turned);
      for (std::size_t v = t + 1; v < columns; ++v) {
        factor_kernels().subtract_product(block, own_[u * columns + v],
                                          lower_[t * stride_ + v - t - 1]);
      }
      own_[u * columns + t] = block;
      own_[t * columns + u] = transpose(block);
      z_->below_[z_->column_start_[k] + u - t - 1] = block;
    }
    by_column_.clear();
    for (std::size_t u = t + 1; u < columns; ++u) {
      by_column_.push_back(&own_[u * columns + t]);
    }
    list_below(t);
    Square pivot = lu_->inverse_[k];
    factor_kernels().subtract_products(pivot, lower_across, by_column_.data(), by_column_.size());
    z_->diagonal_[k] = pivot;
    own_[t * columns + t] = pivot;
  }

  SelectedInverse* z_ = nullptr;
  const BlockLu* lu_ = nullptr;
  Panel panel_;
  std::span<const std::int32_t> rows_;     ///< R
  std::size_t factor_row_count_ = 0;       ///< Of F; its rows count by rank.
  std::vector<std::size_t> ranks_before_;  ///< By row of R.
  std::vector<std::size_t> row_of_rank_;
  std::size_t stride_ = 0;  ///< From column to column of what follows.
  Blocks lower_;            ///< L by row of the panel, then by rank.
  Blocks lower_across_;
  Blocks solved_;  ///< M by rank.
  Blocks solved_across_;
  List lower_across_list_;
  List solved_list_;
  List solved_across_list_;
  Blocks across_;  ///< By column of the panel, then row of R.
  Blocks own_;     ///< Z_JJ
  List by_row_;    ///< Z_ip by row i of R, then p by rank.
  List by_column_;
};

void SelectedInverse::make(int thread_count) {
  diagonal_.resize(lu_->node_count());
  below_.resize(rows_.size());
  ColumnPipeline pipeline(panels_.size(), product_count(), thread_count);
  const auto wait_for = [&](std::size_t turn) { return pipeline.wait_for(turn); };
  const bool is_made = pipeline.run<PanelMaker>([&](std::size_t turn, PanelMaker& maker) {
    maker.begin(*this, panels_[turn]);
    if (!maker.take_others(wait_for)) {
      return false;
    }
    maker.finish();
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
