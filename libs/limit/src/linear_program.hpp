// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <limits>
#include <vector>

namespace holdfast::limit {

/// maximise cost . x   subject to   A x = right_side,  lower <= x <= upper;   A by columns.
struct LinearProgram {
  static constexpr double kInfinite = std::numeric_limits<double>::infinity();

  std::vector<double> right_side;
  std::vector<int> starts = {0};  ///< Of columns in `rows` and `values`; one more than columns.
  std::vector<int> rows;
  std::vector<double> values;
  std::vector<double> lower;
  std::vector<double> upper;
  std::vector<double> cost;

  int row_count() const { return static_cast<int>(right_side.size()); }

  int column_count() const { return static_cast<int>(lower.size()); }

  void add(int row, double value) {
    if (value != 0) {
      rows.push_back(row);
      values.push_back(value);
    }
  }

  /// Ends the column whose entries were added. Returns its index.
  int end_column(double lowest, double highest, double price = 0) {
    starts.push_back(static_cast<int>(rows.size()));
    lower.push_back(lowest);
    upper.push_back(highest);
    cost.push_back(price);
    return column_count() - 1;
  }
};

struct LinearSolution {
  bool is_optimal = false;  ///< It and its prices prove each other, to a millionth.
  double value = 0;
  std::vector<double> x;
  std::vector<double> prices;  ///< By row: what the value gains by one more on its right side.
};

/// Small programs by the dual simplex method, large ones by Clp's interior point method; if the
/// result does not prove itself, by the other one.
LinearSolution solve(const LinearProgram& program, double seconds_max);

}  // namespace holdfast::limit
