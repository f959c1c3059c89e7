// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

/// What takes the time in eliminating columns of dense matrices, stored column by column.
namespace holdfast::limit {

/// Rows and columns of a tile of a product. Columns are a block's, rows a whole number of vectors.
inline constexpr std::size_t kTileRows = 8;
inline constexpr std::size_t kTileColumns = 6;

struct DenseKernels {
  /// Subtracts the product of packed rows and packed columns from the top left corner, so large, of
  /// a tile of a matrix. Packed: kTileRows, or kTileColumns, numbers for each of `depth` factors.
  void (*subtract_tile)(double* dense, std::size_t stride, const double* rows,
                        const double* columns, std::size_t depth, std::size_t row_count,
                        std::size_t column_count);
  /// Solves X L' = B in place, L a lower triangle of `count` columns.
  void (*divide)(double* rows, std::size_t stride, std::size_t row_count, const double* triangle,
                 std::size_t triangle_stride, std::size_t count);
};

/// The kernels for this machine; their bits are the same on all.
const DenseKernels& dense_kernels();

}  // namespace holdfast::limit
