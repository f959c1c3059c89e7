// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "factorization/block_kernels.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace holdfast::solver {
namespace {

/// Swaps rows so that the largest element of a column, from the diagonal down, is the pivot.
/// Returns its row.
std::size_t bring_up_pivot(base::Mat6<double>& work, std::size_t step) {
  double* const v = work.values.data();
  std::size_t pivot = step;
  for (std::size_t row = step + 1; row < 6; ++row) {
    if (std::abs(v[6 * step + row]) > std::abs(v[6 * step + pivot])) {
      pivot = row;
    }
  }
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
  std::size_t pivot_row[6];
  for (std::size_t step = 0; step < 6; ++step) {
    pivot_row[step] = bring_up_pivot(inverse, step);
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

bool is_positive_definite(const base::Mat6<double>& block) {
  base::Mat6<double> root;
  for (int k = 0; k < 6; ++k) {
    for (int row = k; row < 6; ++row) {
      double rest = block.at(row, k);
      for (int j = 0; j < k; ++j) {
        rest -= root.at(row, j) * root.at(k, j);
      }
      if (row == k && !(rest > 0)) {
        return false;
      }
      root.at(row, k) = row == k ? std::sqrt(rest) : rest / root.at(k, k);
    }
  }
  return true;
}

base::Mat6<double> inverse_root(const base::Mat6<double>& block,
                                const base::Mat6<double>& first_value) {
  constexpr double kNothing = 1e-15;
  base::Mat6<double> root;
  base::Mat6<double> inverse;
  for (int k = 0; k < 6; ++k) {
    for (int row = k; row < 6; ++row) {
      double rest = block.at(row, k);
      for (int j = 0; j < k; ++j) {
        rest -= root.at(row, j) * root.at(k, j);
      }
      root.at(row, k) = row == k ? std::sqrt(std::max(rest, kNothing * first_value.at(k, k)))
                                 : rest / root.at(k, k);
    }
  }
  for (int column = 0; column < 6; ++column) {
    for (int row = column; row < 6; ++row) {
      double rest = row == column ? 1 : 0;
      for (int j = column; j < row; ++j) {
        rest -= root.at(row, j) * inverse.at(j, column);
      }
      inverse.at(row, column) = rest / root.at(row, row);
    }
  }
  return inverse;
}

}  // namespace holdfast::solver
