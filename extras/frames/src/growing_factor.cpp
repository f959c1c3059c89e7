// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "holdfast/frames/growing_factor.hpp"

#include <algorithm>
#include <limits>
#include <utility>

#include "factorization/block_kernels.hpp"
#include "holdfast/base/check.hpp"

namespace holdfast::frames {
namespace {

using base::Mat6;
using base::Vec6;
using solver::invert;
using solver::product;
using solver::scaled;
using solver::subtract_product;
using solver::transpose;

Mat6<double> identity() {
  return base::matrix_of<double>([](const Vec6<double>& x) { return x; });
}

bool is_zero(const Mat6<double>& a) {
  return std::ranges::all_of(a.values, [](double value) { return value == 0; });
}

void make_symmetric(Mat6<double>& a) {
  for (int row = 1; row < 6; ++row) {
    for (int column = 0; column < row; ++column) {
      const double mean = (a.at(row, column) + a.at(column, row)) / 2;
      a.at(row, column) = mean;
      a.at(column, row) = mean;
    }
  }
}

/// y -= A' x
void subtract_transposed_product(Vec6<double>& y, const Mat6<double>& a, const Vec6<double>& x) {
  for (std::size_t column = 0; column < 6; ++column) {
    const double* const v = a.values.data() + 6 * column;
    y[column] -=
        ((v[0] * x[0] + v[1] * x[1]) + (v[2] * x[2] + v[3] * x[3])) + (v[4] * x[4] + v[5] * x[5]);
  }
}

/// Whether all pivots of the block are positive: of a sum of springs that holds they are.
bool is_positive(const Mat6<double>& block) {
  Mat6<double> rest = block;
  for (int k = 0; k < 6; ++k) {
    const double pivot = rest.at(k, k);
    // Rounding alone leaves some 1e-16 of what was subtracted.
    if (!(pivot > 1e-14 * block.at(k, k))) {
      return false;
    }
    for (int column = k + 1; column < 6; ++column) {
      const double factor = rest.at(k, column) / pivot;
      for (int row = column; row < 6; ++row) {
        rest.at(row, column) -= rest.at(row, k) * factor;
        rest.at(column, row) = rest.at(row, column);
      }
    }
  }
  return true;
}

}  // namespace

GrowingFactor::GrowingFactor(std::size_t node_count, std::span<const solver::Edge> edges)
    : pattern_(*solver::block_pattern(node_count, edges, std::numeric_limits<std::size_t>::max())),
      row_start_(node_count + 1, 0),
      row_entries_(pattern_.rows.size()),
      term_count_(node_count, 0),
      is_present_(node_count, 0),
      diagonal_(node_count),
      inverse_(node_count),
      lower_(pattern_.rows.size()),
      w_(node_count),
      slot_of_row_(node_count),
      y_(node_count) {
  for (const std::int32_t row : pattern_.rows) {
    ++row_start_[base::at(row) + 1];
  }
  for (std::size_t k = 0; k < node_count; ++k) {
    row_start_[k + 1] += row_start_[k];
  }
  std::vector<std::size_t> next(row_start_.begin(), row_start_.end() - 1);
  for (std::size_t k = 0; k < node_count; ++k) {
    for (std::size_t slot = pattern_.column_start[k]; slot < pattern_.column_start[k + 1]; ++slot) {
      row_entries_[next[base::at(pattern_.rows[slot])]++] = {k, slot};
    }
  }
}

void GrowingFactor::begin(const LowRankTerm& term, int sign) {
  journal_.columns.clear();
  journal_.blocks.clear();
  journal_.cleared_slots.clear();
  journal_.cleared_blocks.clear();
  journal_.a = place(term.a);
  journal_.b = place(term.b);
  journal_.toggled = -1;
  journal_.sign = sign;
  is_singular_ = false;
  for (const std::int32_t end : {journal_.a, journal_.b}) {
    if (end >= 0) {
      term_count_[base::at(end)] += sign;
    }
  }
}

void GrowingFactor::save(std::size_t column) {
  journal_.columns.push_back(column);
  journal_.blocks.push_back(diagonal_[column]);
  journal_.blocks.push_back(inverse_[column]);
  journal_.blocks.insert(
      journal_.blocks.end(),
      lower_.begin() + static_cast<std::ptrdiff_t>(pattern_.column_start[column]),
      lower_.begin() + static_cast<std::ptrdiff_t>(pattern_.column_start[column + 1]));
}

bool GrowingFactor::add(const LowRankTerm& term) {
  const std::int32_t a = place(term.a);
  const std::int32_t b = place(term.b);
  const bool has_a = a < 0 || is_present_[base::at(a)] != 0;
  const bool has_b = is_present_[base::at(b)] != 0;
  if (!has_a && !has_b) {
    return false;
  }
  begin(term, 1);
  const std::int32_t entering = !has_a ? a : !has_b ? b : -1;
  if (entering >= 0) {
    journal_.toggled = entering;
    is_present_[base::at(entering)] = 1;
  }
  spread(term, a < 0 ? b : std::min(a, b), entering, -1, term.stiffness);
  if (is_singular_) {
    undo();
    return false;
  }
  return true;
}

bool GrowingFactor::remove(const LowRankTerm& term) {
  const std::int32_t a = place(term.a);
  const std::int32_t b = place(term.b);
  begin(term, -1);
  const bool loses_a = a >= 0 && term_count_[base::at(a)] == 0;
  const bool loses_b = term_count_[base::at(b)] == 0;
  HOLDFAST_ASSERT(!(loses_a && loses_b));
  const std::int32_t leaving = loses_a ? a : loses_b ? b : -1;
  const std::int32_t first = a < 0 ? b : std::min(a, b);
  if (leaving != first) {
    spread(term, first, -1, leaving, scaled(term.stiffness, -1));
  }
  if (leaving >= 0 && !is_singular_) {
    leave(base::at(leaving));
  }
  if (is_singular_) {
    undo();
    return false;
  }
  return true;
}

/// Takes the term, W S W', along the way from place `from` to the root, or to where its effect
/// ends: behind the place that enters, before the place `stop`.
void GrowingFactor::spread(const LowRankTerm& term, std::int32_t from, std::int32_t entering,
                           std::int32_t stop, Mat6<double> s) {
  if (term.a >= 0) {
    w_[base::at(place(term.a))] = term.lever;
  }
  w_[base::at(place(term.b))] = identity();
  bool is_over = false;
  for (std::int32_t k = from; k >= 0; k = pattern_.parent[base::at(k)]) {
    const std::size_t column = base::at(k);
    is_over = is_over || k == stop;
    if (!is_over && is_present_[column] != 0 && !is_zero(w_[column])) {
      save(column);
      is_over = !update_column(column, entering, s) || k == entering;
    }
    w_[column] = {};
  }
}

bool GrowingFactor::update_column(std::size_t k, std::int32_t entering, Mat6<double>& s) {
  const Mat6<double> p = w_[k];
  const Mat6<double> p_s = product(p, s);
  if (static_cast<std::int32_t>(k) == entering) {
    diagonal_[k] = product(p_s, transpose(p));
  } else {
    add_to(diagonal_[k], product(p_s, transpose(p)));
  }
  make_symmetric(diagonal_[k]);
  if (!is_positive(diagonal_[k]) || !invert(diagonal_[k], inverse_[k])) {
    is_singular_ = true;
    return false;
  }
  const Mat6<double> b = product(transpose(p_s), inverse_[k]);
  const Mat6<double> minus_b = scaled(b, -1);
  for (std::size_t slot = pattern_.column_start[k]; slot < pattern_.column_start[k + 1]; ++slot) {
    const std::size_t row = base::at(pattern_.rows[slot]);
    if (is_present_[row] != 0) {
      subtract_product(w_[row], lower_[slot], p);
      subtract_product(lower_[slot], w_[row], minus_b);
    }
  }
  subtract_product(s, b, p_s);
  make_symmetric(s);
  return true;
}

/// Takes the last trace of a place out of the factors: its column and its row.
void GrowingFactor::leave(std::size_t k) {
  save(k);
  journal_.toggled = static_cast<std::int32_t>(k);
  is_present_[k] = 0;
  diagonal_[k] = {};
  inverse_[k] = {};
  for (std::size_t slot = pattern_.column_start[k]; slot < pattern_.column_start[k + 1]; ++slot) {
    lower_[slot] = {};
  }
  for (std::size_t entry = row_start_[k]; entry < row_start_[k + 1]; ++entry) {
    const std::size_t slot = row_entries_[entry].slot;
    if (is_present_[row_entries_[entry].column] != 0) {
      journal_.cleared_slots.push_back(slot);
      journal_.cleared_blocks.push_back(lower_[slot]);
      lower_[slot] = {};
    }
  }
}

void GrowingFactor::undo() {
  HOLDFAST_CHECK(journal_.sign != 0);
  for (std::size_t i = 0; i < journal_.cleared_slots.size(); ++i) {
    lower_[journal_.cleared_slots[i]] = journal_.cleared_blocks[i];
  }
  auto saved = journal_.blocks.begin();
  for (const std::size_t k : journal_.columns) {
    diagonal_[k] = *saved++;
    inverse_[k] = *saved++;
    for (std::size_t slot = pattern_.column_start[k]; slot < pattern_.column_start[k + 1]; ++slot) {
      lower_[slot] = *saved++;
    }
  }
  for (const std::int32_t end : {journal_.a, journal_.b}) {
    if (end >= 0) {
      term_count_[base::at(end)] -= journal_.sign;
    }
  }
  if (journal_.toggled >= 0) {
    is_present_[base::at(journal_.toggled)] = journal_.sign > 0 ? 0 : 1;
  }
  journal_.sign = 0;
  is_singular_ = false;
}

bool GrowingFactor::factor(std::span<const LowRankTerm* const> terms) {
  journal_.sign = 0;
  is_singular_ = false;
  std::ranges::fill(term_count_, 0);
  std::ranges::fill(is_present_, std::uint8_t{0});
  std::ranges::fill(diagonal_, Mat6<double>{});
  std::ranges::fill(inverse_, Mat6<double>{});
  std::ranges::fill(lower_, Mat6<double>{});
  for (const LowRankTerm* const term : terms) {
    const std::size_t b = base::at(place(term->b));
    ++term_count_[b];
    is_present_[b] = 1;
    add_to(diagonal_[b], term->stiffness);
    if (term->a < 0) {
      continue;
    }
    const std::size_t a = base::at(place(term->a));
    ++term_count_[a];
    is_present_[a] = 1;
    const Mat6<double> ab = product(term->lever, term->stiffness);
    add_to(diagonal_[a], product(ab, transpose(term->lever)));
    const auto [low, high] = std::minmax(a, b);
    const auto first =
        pattern_.rows.begin() + static_cast<std::ptrdiff_t>(pattern_.column_start[low]);
    const auto last =
        pattern_.rows.begin() + static_cast<std::ptrdiff_t>(pattern_.column_start[low + 1]);
    const auto found = std::lower_bound(first, last, static_cast<std::int32_t>(high));
    add_to(lower_[static_cast<std::size_t>(found - pattern_.rows.begin())],
           a > b ? ab : transpose(ab));
  }
  for (std::size_t k = 0; k < is_present_.size() && !is_singular_; ++k) {
    if (is_present_[k] != 0) {
      make_column(k);
    }
  }
  return !is_singular_;
}

/// Column k of L: that of A minus what the columns to the left contribute.
void GrowingFactor::make_column(std::size_t k) {
  const std::size_t begin = pattern_.column_start[k];
  const std::size_t end = pattern_.column_start[k + 1];
  for (std::size_t slot = begin; slot < end; ++slot) {
    slot_of_row_[base::at(pattern_.rows[slot])] = slot;
  }
  for (std::size_t entry = row_start_[k]; entry < row_start_[k + 1]; ++entry) {
    const auto [left, slot_k] = row_entries_[entry];
    if (is_present_[left] == 0) {
      continue;
    }
    const Mat6<double> d_l = product(diagonal_[left], transpose(lower_[slot_k]));
    subtract_product(diagonal_[k], lower_[slot_k], d_l);
    for (std::size_t slot = slot_k + 1; slot < pattern_.column_start[left + 1]; ++slot) {
      const std::size_t row = base::at(pattern_.rows[slot]);
      if (is_present_[row] != 0) {
        subtract_product(lower_[slot_of_row_[row]], lower_[slot], d_l);
      }
    }
  }
  make_symmetric(diagonal_[k]);
  if (!is_positive(diagonal_[k]) || !invert(diagonal_[k], inverse_[k])) {
    is_singular_ = true;
    return;
  }
  for (std::size_t slot = begin; slot < end; ++slot) {
    lower_[slot] = product(lower_[slot], inverse_[k]);
  }
}

void GrowingFactor::solve(std::span<Vec6<double>> x) const {
  const std::size_t n = is_present_.size();
  HOLDFAST_CHECK(x.size() == n && !is_singular_);
  for (std::size_t node = 0; node < n; ++node) {
    y_[base::at(pattern_.position[node])] = is_present(node) ? x[node] : Vec6<double>{};
  }
  for (std::size_t k = 0; k < n; ++k) {
    if (is_present_[k] == 0) {
      continue;
    }
    const Vec6<double> y_k = y_[k];
    for (std::size_t slot = pattern_.column_start[k]; slot < pattern_.column_start[k + 1]; ++slot) {
      const std::size_t row = base::at(pattern_.rows[slot]);
      if (is_present_[row] != 0) {
        subtract_product(y_[row], lower_[slot], y_k);
      }
    }
  }
  for (std::size_t k = n; k-- > 0;) {
    if (is_present_[k] == 0) {
      continue;
    }
    Vec6<double> y_k = multiply(inverse_[k], y_[k]);
    for (std::size_t slot = pattern_.column_start[k]; slot < pattern_.column_start[k + 1]; ++slot) {
      const std::size_t row = base::at(pattern_.rows[slot]);
      if (is_present_[row] != 0) {
        subtract_transposed_product(y_k, lower_[slot], y_[row]);
      }
    }
    y_[k] = y_k;
  }
  for (std::size_t node = 0; node < n; ++node) {
    x[node] = y_[base::at(pattern_.position[node])];
  }
}

}  // namespace holdfast::frames
