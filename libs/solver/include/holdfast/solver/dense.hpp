// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <cstddef>
#include <span>
#include <utility>
#include <vector>

/// Solves small dense systems.
namespace holdfast::solver {

/// A small dense system of linear equations, by Gauss's elimination with row pivoting.
class DenseSystem {
 public:
  explicit DenseSystem(std::size_t size) : size_(size), values_(size * size), pivot_(size) {}

  double& at(std::size_t row, std::size_t column) { return values_[row * size_ + column]; }

  /// Returns false if the matrix is singular.
  [[nodiscard]] bool factor() {
    for (std::size_t k = 0; k < size_; ++k) {
      std::size_t pivot = k;
      for (std::size_t row = k + 1; row < size_; ++row) {
        pivot = std::abs(at(row, k)) > std::abs(at(pivot, k)) ? row : pivot;
      }
      pivot_[k] = pivot;
      if (!(std::abs(at(pivot, k)) > 0)) {
        return false;
      }
      for (std::size_t column = 0; pivot != k && column < size_; ++column) {
        std::swap(at(k, column), at(pivot, column));
      }
      for (std::size_t row = k + 1; row < size_; ++row) {
        const double factor = at(row, k) /= at(k, k);
        for (std::size_t column = k + 1; factor != 0 && column < size_; ++column) {
          at(row, column) -= factor * at(k, column);
        }
      }
    }
    return true;
  }

  /// Solves in place, after factor().
  void solve(std::span<double> x) {
    for (std::size_t k = 0; k < size_; ++k) {
      std::swap(x[k], x[pivot_[k]]);
    }
    for (std::size_t row = 0; row < size_; ++row) {
      for (std::size_t k = 0; k < row; ++k) {
        x[row] -= at(row, k) * x[k];
      }
    }
    for (std::size_t row = size_; row-- > 0;) {
      for (std::size_t k = row + 1; k < size_; ++k) {
        x[row] -= at(row, k) * x[k];
      }
      x[row] /= at(row, row);
    }
  }

 private:
  std::size_t size_;
  std::vector<double> values_;
  std::vector<std::size_t> pivot_;
};

}  // namespace holdfast::solver
