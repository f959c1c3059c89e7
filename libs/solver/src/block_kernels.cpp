// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "block_kernels.hpp"

#include <array>
#include <cmath>
#include <utility>

namespace holdfast::solver {
namespace {

using Weights = std::array<double, 6>;

/// Rows are forces and torques, soft and stiff: what is large in one is small in another. Beside
/// the roots of the diagonal all are numbers around 1, as in a matrix scaled from both sides.
Weights row_weights(const base::Mat6<double>& block) {
  Weights weight;
  for (std::size_t row = 0; row < 6; ++row) {
    const double diagonal = std::abs(block.values[7 * row]);
    weight[row] = diagonal > 0 ? 1 / std::sqrt(diagonal) : 1;
  }
  return weight;
}

/// Swaps rows so that the largest weighted element of a column, from the diagonal down, is the
/// pivot. Returns its row.
std::size_t bring_up_pivot(base::Mat6<double>& work, Weights& weight, std::size_t step) {
  double* const v = work.values.data();
  std::size_t pivot = step;
  for (std::size_t row = step + 1; row < 6; ++row) {
    if (std::abs(v[6 * step + row]) * weight[row] > std::abs(v[6 * step + pivot]) * weight[pivot]) {
      pivot = row;
    }
  }
  std::swap(weight[step], weight[pivot]);
  for (std::size_t column = 0; pivot != step && column < 6; ++column) {
    std::swap(v[6 * column + step], v[6 * column + pivot]);
  }
  return pivot;
}

}  // namespace

// In place: a column that is done makes room for that of the inverse. Swapped rows of the block are
// swapped columns of its inverse.
bool invert(const base::Mat6<double>& block, base::Mat6<double>& inverse) {
  inverse = block;
  double* const v = inverse.values.data();
  Weights weight = row_weights(block);
  std::size_t pivot_row[6];
  for (std::size_t step = 0; step < 6; ++step) {
    pivot_row[step] = bring_up_pivot(inverse, weight, step);
    double* const own = v + 6 * step;
    const double pivot = own[step];
    if (!(std::abs(pivot) > 0) || !std::isfinite(pivot)) {
      return false;
    }
    const double scale = 1 / pivot;
    for (std::size_t column = 0; column < 36; column += 6) {
      if (column == 6 * step) {
        continue;
      }
      const double value = v[column + step] * scale;
      for (std::size_t row = 0; row < 6; ++row) {
        v[column + row] -= own[row] * value;
      }
      v[column + step] = value;
    }
    for (std::size_t row = 0; row < 6; ++row) {
      own[row] *= -scale;
    }
    own[step] = scale;
  }
  for (std::size_t step = 6; step-- > 0;) {
    for (std::size_t row = 0; pivot_row[step] != step && row < 6; ++row) {
      std::swap(v[6 * step + row], v[6 * pivot_row[step] + row]);
    }
  }
  return true;
}

}  // namespace holdfast::solver
