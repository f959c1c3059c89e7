// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include "holdfast/base/algebra.hpp"
#include "holdfast/base/check.hpp"
#include "holdfast/solver/dense.hpp"

namespace holdfast::plan {

using solver::DenseSystem;

/// The inverse of a matrix of so many blocks in a row, which must not be singular.
inline std::vector<base::Mat6<double>> inverse_of(const std::vector<base::Mat6<double>>& blocks,
                                                  std::size_t count) {
  DenseSystem system(6 * count);
  for (std::size_t i = 0; i < 6 * count; ++i) {
    for (std::size_t k = 0; k < 6 * count; ++k) {
      system.at(i, k) = blocks[i / 6 * count + k / 6].values[6 * (k % 6) + i % 6];
    }
  }
  HOLDFAST_CHECK(system.factor());
  std::vector<base::Mat6<double>> inverse(count * count);
  for (std::size_t k = 0; k < 6 * count; ++k) {
    std::vector<double> column(6 * count);
    column[k] = 1;
    system.solve(column);
    for (std::size_t i = 0; i < 6 * count; ++i) {
      inverse[i / 6 * count + k / 6].values[6 * (k % 6) + i % 6] = column[i];
    }
  }
  return inverse;
}

}  // namespace holdfast::plan
