// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "block_kernels.hpp"

#include <cmath>
#include <utility>

namespace holdfast::solver {
namespace {

/// Swaps rows so that the largest element of a column, from the diagonal down, is the pivot.
void bring_up_pivot(base::Mat6<double>& work, base::Mat6<double>& inverse, int step) {
  int pivot = step;
  for (int row = step + 1; row < 6; ++row) {
    if (std::abs(work.at(row, step)) > std::abs(work.at(pivot, step))) {
      pivot = row;
    }
  }
  for (int column = 0; pivot != step && column < 6; ++column) {
    std::swap(work.at(step, column), work.at(pivot, column));
    std::swap(inverse.at(step, column), inverse.at(pivot, column));
  }
}

}  // namespace

bool invert(const base::Mat6<double>& block, base::Mat6<double>& inverse) {
  base::Mat6<double> work = block;
  inverse = {};
  for (int i = 0; i < 6; ++i) {
    inverse.at(i, i) = 1;
  }
  for (int step = 0; step < 6; ++step) {
    bring_up_pivot(work, inverse, step);
    const double pivot = work.at(step, step);
    if (!(std::abs(pivot) > 0) || !std::isfinite(pivot)) {
      return false;
    }
    const double scale = 1 / pivot;
    base::Vec6<double> factor;
    for (int row = 0; row < 6; ++row) {
      factor[static_cast<std::size_t>(row)] = row == step ? 1 - scale : work.at(row, step) * scale;
    }
    // Row `step` becomes itself times scale; every other row loses its multiple of it.
    for (auto* matrix : {&work, &inverse}) {
      for (int column = 0; column < 6; ++column) {
        const double value = matrix->at(step, column);
        for (int row = 0; row < 6; ++row) {
          matrix->at(row, column) -= factor[static_cast<std::size_t>(row)] * value;
        }
      }
    }
  }
  return true;
}

}  // namespace holdfast::solver
