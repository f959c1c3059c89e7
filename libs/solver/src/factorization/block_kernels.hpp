// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

#include "holdfast/base/algebra.hpp"

/// 6x6 arithmetic where it takes no time; factor_kernels.hpp has what does.
namespace holdfast::solver {

/// C -= A B
inline void subtract_product(base::Mat6<double>& c, const base::Mat6<double>& a,
                             const base::Mat6<double>& b) {
  for (std::size_t column = 0; column < 36; column += 6) {
    for (std::size_t k = 0; k < 6; ++k) {
      for (std::size_t i = 0; i < 6; ++i) {
        c.values[column + i] -= a.values[6 * k + i] * b.values[column + k];
      }
    }
  }
}

/// y -= A x
inline void subtract_product(base::Vec6<double>& y, const base::Mat6<double>& a,
                             const base::Vec6<double>& x) {
  for (std::size_t k = 0; k < 6; ++k) {
    for (std::size_t i = 0; i < 6; ++i) {
      y[i] -= a.values[6 * k + i] * x[k];
    }
  }
}

inline base::Mat6<double> product(const base::Mat6<double>& a, const base::Mat6<double>& b) {
  base::Mat6<double> c;
  for (std::size_t column = 0; column < 6; ++column) {
    for (std::size_t k = 0; k < 6; ++k) {
      const double factor = b.values[6 * column + k];
      for (std::size_t i = 0; i < 6; ++i) {
        c.values[6 * column + i] += a.values[6 * k + i] * factor;
      }
    }
  }
  return c;
}

inline base::Mat6<double> transpose(const base::Mat6<double>& a) {
  base::Mat6<double> t;
  for (int row = 0; row < 6; ++row) {
    for (int column = 0; column < 6; ++column) {
      t.at(column, row) = a.at(row, column);
    }
  }
  return t;
}

inline base::Mat6<double> scaled(const base::Mat6<double>& a, double factor) {
  base::Mat6<double> result = a;
  for (double& value : result.values) {
    value *= factor;
  }
  return result;
}

/// Gauss-Jordan with row pivoting. Returns false for a singular or non-finite block; `inverse` is
/// then void.
bool invert(const base::Mat6<double>& block, base::Mat6<double>& inverse);

/// Whether a symmetric block is positive definite, by Cholesky's method.
bool is_positive_definite(const base::Mat6<double>& block);

/// C^-1 of the lower triangle C with C C' = block, by Cholesky's method. A pivot below kNothing of
/// its `first_value`, before anything was eliminated, is rounding and taken as so much.
base::Mat6<double> inverse_root(const base::Mat6<double>& block,
                                const base::Mat6<double>& first_value);

}  // namespace holdfast::solver
