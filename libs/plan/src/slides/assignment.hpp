// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace holdfast::plan {

/// A cheapest assignment of rows to columns, and the prices that prove it.
struct Assignment {
  std::int64_t cost = 0;
  std::vector<std::size_t> column_of;  ///< By row.
  /// Price of row + price of column <= cost of the pair, and equal for the assigned pairs.
  std::vector<int> row_price;
  std::vector<int> column_price;
};

/// A cheapest assignment in a square matrix by rows of costs from 0 to 10^6, by shortest
/// augmenting paths [Jonker 1987], in O(count^3).
Assignment assign(std::span<const int> costs, std::size_t count);

}  // namespace holdfast::plan
