// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "algebra/dense_elimination.hpp"

#include <algorithm>
#include <cmath>

#include "algebra/dense_kernels.hpp"
#include "algebra/for_each.hpp"

namespace holdfast::limit {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;

/// Columns that are eliminated from all others at once: what is left, larger than any cache, is
/// gone through once for so many. And of these those that are eliminated one by one.
constexpr Index kPanel = 192;
constexpr Index kNarrow = 24;
/// Rows of what is left that stay in the second cache, packed, while all columns pass.
constexpr auto kRows = static_cast<Index>(kTileRows);
constexpr auto kColumns = static_cast<Index>(kTileColumns);
constexpr Index kRowsAtOnce = 32 * kRows;

std::size_t parts_of(Index count, Index part) {
  return static_cast<std::size_t>((count + part - 1) / part);
}

/// A tile of rows or columns, packed; rows that are not there are zeros.
template <std::size_t kCount>
void pack_tile(const MatrixXd& dense, Index from, Index depth, Index begin, Index end,
               double* packed) {
  const Index count = std::min<Index>(static_cast<Index>(kCount), end - begin);
  for (Index k = 0; k < depth; ++k) {
    const double* column = &dense(begin, from + k);
    for (Index i = 0; i < static_cast<Index>(kCount); ++i) {
      *packed++ = i < count ? column[i] : 0;
    }
  }
}

void factor_triangle(MatrixXd& dense, Index begin, Index end, const Eigen::VectorXd& first_value) {
  for (Index k = begin; k < end; ++k) {
    const double least = DenseElimination::kNothing * first_value[k];
    dense(k, k) = std::sqrt(std::max(dense(k, k), least));
    const Index below = end - k - 1;
    dense.col(k).segment(k + 1, below) /= dense(k, k);
    for (Index j = k + 1; j < end; ++j) {
      dense.col(j).segment(j, end - j) -= dense(j, k) * dense.col(k).segment(j, end - j);
    }
  }
}

}  // namespace

void DenseElimination::run(MatrixXd& dense, Index width, const Eigen::VectorXd& first_value,
                           host::Team& team) {
  for (Index begin = 0; begin < width; begin += kPanel) {
    const Index end = std::min(begin + kPanel, width);
    factor_panel(dense, begin, end, first_value, team);
    subtract(dense, begin, end - begin, end, dense.rows(), team);
  }
}

/// Columns [begin, end), with all rows below them.
void DenseElimination::factor_panel(MatrixXd& dense, Index begin, Index end,
                                    const Eigen::VectorXd& first_value, host::Team& team) {
  const auto stride = static_cast<std::size_t>(dense.outerStride());
  for (Index narrow = begin; narrow < end; narrow += kNarrow) {
    const Index next = std::min(narrow + kNarrow, end);
    factor_triangle(dense, narrow, next, first_value);
    const Index rest = dense.rows() - next;
    for_each(team, parts_of(rest, kRowsAtOnce), [&](std::size_t part) {
      const Index row = next + static_cast<Index>(part) * kRowsAtOnce;
      const Index count = std::min(kRowsAtOnce, dense.rows() - row);
      dense_kernels().divide(&dense(row, narrow), stride, static_cast<std::size_t>(count),
                             &dense(narrow, narrow), stride,
                             static_cast<std::size_t>(next - narrow));
    });
    subtract(dense, narrow, next - narrow, next, end, team);
  }
}

/// From the lower triangle in columns [begin, end) the product of the `depth` columns beginning at
/// `from` with themselves.
void DenseElimination::subtract(MatrixXd& dense, Index from, Index depth, Index begin, Index end,
                                host::Team& team) {
  if (begin == end) {
    return;
  }
  pack(dense, from, depth, begin, end, team);
  const auto stride = static_cast<std::size_t>(dense.outerStride());
  const DenseKernels& kernels = dense_kernels();
  const std::size_t part_count = parts_of(dense.rows() - begin, kRowsAtOnce);
  for_each(team, part_count, [&](std::size_t part) {
    // The longest first.
    const Index first = begin + static_cast<Index>(part_count - 1 - part) * kRowsAtOnce;
    const Index last = std::min(first + kRowsAtOnce, dense.rows());
    for (Index column = begin; column < std::min(last, end); column += kColumns) {
      const double* columns = &columns_[static_cast<std::size_t>((column - begin) * depth)];
      const auto column_count = static_cast<std::size_t>(std::min(kColumns, end - column));
      const Index skipped = std::max<Index>(0, (column - first) / kRows);
      for (Index row = first + skipped * kRows; row < last; row += kRows) {
        kernels.subtract_tile(&dense(row, column), stride,
                              &rows_[static_cast<std::size_t>((row - begin) * depth)], columns,
                              static_cast<std::size_t>(depth),
                              static_cast<std::size_t>(std::min(kRows, last - row)), column_count);
      }
    }
  });
}

void DenseElimination::pack(const MatrixXd& dense, Index from, Index depth, Index begin, Index end,
                            host::Team& team) {
  // A multiple of both tiles at once.
  constexpr Index kAtOnce = 4 * kRows * kColumns;
  const auto enlarge = [&](std::vector<double>& memory, Index count) {
    memory.resize(std::max(memory.size(),
                           parts_of(count, kAtOnce) * static_cast<std::size_t>(kAtOnce * depth)));
  };
  enlarge(rows_, dense.rows() - begin);
  enlarge(columns_, end - begin);
  for_each(team, parts_of(dense.rows() - begin, kAtOnce), [&](std::size_t part) {
    const Index first = begin + static_cast<Index>(part) * kAtOnce;
    const Index last_row = std::min(first + kAtOnce, dense.rows());
    for (Index row = first; row < last_row; row += kRows) {
      pack_tile<kTileRows>(dense, from, depth, row, dense.rows(),
                           &rows_[static_cast<std::size_t>((row - begin) * depth)]);
    }
    const Index last_column = std::min(first + kAtOnce, end);
    for (Index column = first; column < last_column; column += kColumns) {
      pack_tile<kTileColumns>(dense, from, depth, column, end,
                              &columns_[static_cast<std::size_t>((column - begin) * depth)]);
    }
  });
}

}  // namespace holdfast::limit
