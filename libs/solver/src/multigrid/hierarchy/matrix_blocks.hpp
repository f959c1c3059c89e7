// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "factorization/block_kernels.hpp"
#include "holdfast/base/check.hpp"
#include "multigrid/coarsening/springs.hpp"
#include "multigrid/kernels/kernels.hpp"

/// Turns matrices into what the kernels read.
namespace holdfast::solver {

/// The row of a table of beams: one entry for each length.
inline constexpr std::size_t kRow = kBeamLengthMax + 1;

/// The displacement that each one bends with on a beam along an axis; see lanes.hpp.
inline constexpr std::size_t kSwap[3][6] = {
    {0, 5, 4, 3, 2, 1}, {5, 1, 3, 2, 4, 0}, {4, 3, 2, 1, 0, 5}};

template <class Real>
Block<Real> block_of(const Mat& matrix) {
  Block<Real> block;
  for (int column = 0; column < 6; ++column) {
    for (int row = 0; row < 6; ++row) {
      block.column(column)[row] = static_cast<Real>(matrix.at(row, column));
    }
  }
  return block;
}

/// The inverse of a matrix that has one, as those of beams have.
inline Mat inverse_of(const Mat& matrix) {
  Mat inverse;
  HOLDFAST_CHECK(invert(matrix, inverse));
  return inverse;
}

/// The inverse as a block, or zero if there is none.
inline Block<float> inverse_block(const Mat& matrix) {
  Mat inverse;
  return invert(matrix, inverse) ? block_of<float>(inverse) : Block<float>{};
}

/// K_pq of the node that sees the spring.
inline Mat coupling(const Spring& spring) {
  return scaled(times_carry(spring.stiffness, difference({}, spring.partner)), -1);
}

}  // namespace holdfast::solver
