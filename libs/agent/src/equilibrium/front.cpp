// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "holdfast/agent/equilibrium/front.hpp"

#include "algebra/scalar.hpp"

namespace holdfast::agent {

std::span<FrontNode> FrontMemory::take_nodes(std::size_t count) {
  if (nodes.size() - nodes_used < count) {
    return {};
  }
  const std::span<FrontNode> taken = nodes.subspan(nodes_used, count);
  nodes_used += count;
  return taken;
}

std::span<float> FrontMemory::take_reals(std::size_t count) {
  if (reals.size() - reals_used < count) {
    return {};
  }
  const std::span<float> taken = reals.subspan(reals_used, count);
  reals_used += count;
  reals_most = reals_used > reals_most ? reals_used : reals_most;
  for (float& value : taken) {
    value = 0;
  }
  return taken;
}

bool Front::make(std::span<FrontNode> nodes, FrontMemory& memory) {
  nodes_ = nodes;
  complete_count_ = 0;
  for (std::size_t i = 0; i < nodes_.size(); ++i) {
    if (nodes_[i].is_complete()) {
      const FrontNode complete = nodes_[i];
      nodes_[i] = nodes_[complete_count_];
      nodes_[complete_count_++] = complete;
    }
  }
  rows_ = 0;
  complete_rows_ = 0;
  for (std::size_t i = 0; i < nodes_.size(); ++i) {
    rows_ += nodes_[i].is_fixed ? 0 : 6;
    complete_rows_ = i < complete_count_ ? rows_ : complete_rows_;
  }
  const auto rows = static_cast<std::size_t>(rows_);
  const std::size_t triangle = triangle_reals(rows);
  const std::size_t low = memory.has_low_parts ? triangle : 0;
  const std::span<float> all = memory.take_reals(triangle + low + 2 * rows);
  if (all.empty() && rows > 0) {
    return false;
  }
  loads_ = all.first(rows);
  shifts_ = all.subspan(rows, rows);
  matrix_ = all.subspan(2 * rows, triangle);
  low_ = all.subspan(2 * rows + triangle);
  return true;
}

void Front::set(std::size_t place, double value) {
  matrix_[place] = static_cast<float>(value);
  if (!low_.empty()) {
    low_[place] = static_cast<float>(value - static_cast<double>(matrix_[place]));
  }
}

void Front::add(int row, int column, double value) {
  const std::size_t place = row >= column ? at(row, column) : at(column, row);
  if (low_.empty()) {
    matrix_[place] += static_cast<float>(value);
  } else {
    set(place, this->value(place) + value);
  }
}

int Front::row_of(std::size_t node) const {
  if (nodes_[node].is_fixed) {
    return -1;
  }
  int row = 0;
  for (std::size_t i = 0; i < node; ++i) {
    row += nodes_[i].is_fixed ? 0 : 6;
  }
  return row;
}

void Front::add_block(int row, int column, const base::Mat6<double>& block) {
  for (int i = 0; i < 6; ++i) {
    for (int j = 0; j < 6; ++j) {
      // Of a block on the diagonal the upper triangle is the lower one again.
      if (row != column || j <= i) {
        add(row + i, column + j, block.at(i, j));
      }
    }
  }
}

/// The first `count` elements of two rows.
double Front::product(int row, int column, int count) const {
  const std::size_t a = at(row, 0);
  const std::size_t b = at(column, 0);
  double sum = 0;
  for (std::size_t k = 0; k < static_cast<std::size_t>(count); ++k) {
    sum += value(a + k) * value(b + k);
  }
  return sum;
}

float Front::element_left(int index, bool is_low) const {
  int row = complete_rows_;
  while (row < rows_ && index > row - complete_rows_) {
    index -= ++row - complete_rows_;
  }
  if (row >= rows_) {
    return 0;
  }
  const std::size_t place = at(row, complete_rows_ + index);
  return is_low ? low_[place] : matrix_[place];
}

bool Front::factor_row(int row) {
  for (int column = 0; column <= row; ++column) {
    const std::size_t place = at(row, column);
    const bool is_complete = column < complete_rows_;
    const int count = is_complete ? column : complete_rows_;
    const double rest = value(place) - product(row, column, count);
    if (is_complete && row == column) {
      if (!(rest > 0)) {
        return false;
      }
      set(place, square_root(rest));
    } else {
      set(place, is_complete ? rest / element(column, column) : rest);
    }
  }
  return true;
}

void Front::clear_loads() {
  for (float& value : loads_) {
    value = 0;
  }
}

void Front::condense_loads() {
  for (int row = 0; row < rows_; ++row) {
    const int count = row < complete_rows_ ? row : complete_rows_;
    auto rest = static_cast<double>(load(row));
    for (int k = 0; k < count; ++k) {
      rest -= element(row, k) * static_cast<double>(load(k));
    }
    load(row) = static_cast<float>(row < complete_rows_ ? rest / element(row, row) : rest);
  }
}

void Front::find_shifts() {
  for (int row = complete_rows_ - 1; row >= 0; --row) {
    auto rest = static_cast<double>(load(row));
    for (int i = row + 1; i < rows_; ++i) {
      rest -= element(i, row) * static_cast<double>(shift(i));
    }
    shift(row) = static_cast<float>(rest / element(row, row));
  }
}

}  // namespace holdfast::agent
