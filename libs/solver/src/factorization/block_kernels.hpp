// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstring>

#include "holdfast/base/algebra.hpp"

/// The 6x6 arithmetic of BlockLu. A column is three pairs of doubles: the product that takes most
/// of the time says so to the compiler, for the others plain loops suffice.
namespace holdfast::solver {

using Pair = double __attribute__((vector_size(16)));

inline Pair load(const double* from) {
  Pair pair;
  std::memcpy(&pair, from, sizeof pair);
  return pair;
}

inline void store(double* to, Pair pair) { std::memcpy(to, &pair, sizeof pair); }

/// C -= A B
inline void subtract_product(base::Mat6<double>& c, const base::Mat6<double>& a,
                             const base::Mat6<double>& b) {
  for (std::size_t column = 0; column < 6; ++column) {
    double* const target = c.values.data() + 6 * column;
    Pair low = load(target);
    Pair middle = load(target + 2);
    Pair high = load(target + 4);
    for (std::size_t k = 0; k < 6; ++k) {
      const double value = b.values[6 * column + k];
      const Pair factor = {value, value};
      const double* const from = a.values.data() + 6 * k;
      low -= load(from) * factor;
      middle -= load(from + 2) * factor;
      high -= load(from + 4) * factor;
    }
    store(target, low);
    store(target + 2, middle);
    store(target + 4, high);
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

}  // namespace holdfast::solver
