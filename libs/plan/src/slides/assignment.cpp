// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "slides/assignment.hpp"

#include <algorithm>
#include <limits>
#include <numeric>
#include <utility>

namespace holdfast::plan {
namespace {

constexpr std::size_t kUnassigned = std::numeric_limits<std::size_t>::max();

/// Rows are taken up one by one, each by a shortest path in reduced costs from it to a column that
/// nobody has. Columns are listed in this order: those whose distance is settled, up to `low_`;
/// those at the least distance of all others, up to `up_`; the rest.
class Assigner {
 public:
  Assigner(std::span<const int> costs, std::size_t count)
      : costs_(costs),
        count_(count),
        price_(count),
        row_of_(count, kUnassigned),
        column_of_(count, kUnassigned),
        distance_(count),
        before_(count),
        columns_(count) {}

  Assignment run() {
    reduce_columns();
    for (std::size_t row = 0; row < count_; ++row) {
      if (column_of_[row] == kUnassigned) {
        augment(row, find_path(row));
      }
    }
    Assignment found;
    for (std::size_t row = 0; row < count_; ++row) {
      const std::size_t column = column_of_[row];
      found.cost += cost(row, column);
      found.row_price.push_back(cost(row, column) - price_[column]);
    }
    found.column_of = std::move(column_of_);
    found.column_price = std::move(price_);
    return found;
  }

 private:
  int cost(std::size_t row, std::size_t column) const { return costs_[row * count_ + column]; }

  /// The price of a column is its least cost, and the first row that has it and no column takes it.
  void reduce_columns() {
    for (std::size_t column = 0; column < count_; ++column) {
      std::size_t best = 0;
      for (std::size_t row = 1; row < count_; ++row) {
        best = cost(row, column) < cost(best, column) ? row : best;
      }
      price_[column] = cost(best, column);
      if (column_of_[best] == kUnassigned) {
        column_of_[best] = column;
        row_of_[column] = best;
      }
    }
  }

  /// The column at the end of a shortest path from a row; prices are those after it.
  std::size_t find_path(std::size_t row) {
    std::iota(columns_.begin(), columns_.end(), std::size_t{0});
    for (std::size_t column = 0; column < count_; ++column) {
      distance_[column] = cost(row, column) - price_[column];
      before_[column] = row;
    }
    low_ = up_ = 0;
    std::size_t settled = 0;
    std::size_t end = kUnassigned;
    while (end == kUnassigned) {
      if (low_ == up_) {
        settled = low_;
        end = list_nearest();
      } else {
        end = relax(columns_[low_++]);
      }
    }
    for (std::size_t i = 0; i < settled; ++i) {
      price_[columns_[i]] += distance_[columns_[i]] - least_;
    }
    return end;
  }

  /// Lists all columns at the least distance of those left; a free one of them if there is one.
  std::size_t list_nearest() {
    least_ = std::numeric_limits<int>::max();
    for (std::size_t i = low_; i < count_; ++i) {
      const std::size_t column = columns_[i];
      if (distance_[column] < least_) {
        least_ = distance_[column];
        up_ = low_;
      }
      if (distance_[column] == least_) {
        std::swap(columns_[i], columns_[up_++]);
      }
    }
    for (std::size_t i = low_; i < up_; ++i) {
      if (row_of_[columns_[i]] == kUnassigned) {
        return columns_[i];
      }
    }
    return kUnassigned;
  }

  /// Goes on from the row that has a column at the least distance; a free column as near, or none.
  std::size_t relax(std::size_t settled) {
    const std::size_t row = row_of_[settled];
    const int offset = cost(row, settled) - price_[settled] - least_;
    for (std::size_t i = up_; i < count_; ++i) {
      const std::size_t column = columns_[i];
      const int distance = cost(row, column) - price_[column] - offset;
      if (distance >= distance_[column]) {
        continue;
      }
      distance_[column] = distance;
      before_[column] = row;
      if (distance == least_) {
        if (row_of_[column] == kUnassigned) {
          return column;
        }
        std::swap(columns_[i], columns_[up_++]);
      }
    }
    return kUnassigned;
  }

  void augment(std::size_t first, std::size_t column) {
    while (true) {
      const std::size_t row = before_[column];
      row_of_[column] = row;
      std::swap(column_of_[row], column);
      if (row == first) {
        return;
      }
    }
  }

  std::span<const int> costs_;
  std::size_t count_;
  std::vector<int> price_;  ///< By column.
  std::vector<std::size_t> row_of_;
  std::vector<std::size_t> column_of_;
  std::vector<int> distance_;        ///< By column, from the row that is taken up.
  std::vector<std::size_t> before_;  ///< By column: the row before it on the shortest path.
  std::vector<std::size_t> columns_;
  std::size_t low_ = 0;
  std::size_t up_ = 0;
  int least_ = 0;
};

}  // namespace

Assignment assign(std::span<const int> costs, std::size_t count) {
  return Assigner(costs, count).run();
}

}  // namespace holdfast::plan
