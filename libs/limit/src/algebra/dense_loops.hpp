// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstring>

#include "algebra/dense_kernels.hpp"

/// The loops of dense_kernels.hpp. Included once per instruction set, in a namespace of its own;
/// every number is made by the same operations in the same order, without fused multiply-add, so
/// the bits are the same everywhere.
namespace holdfast::limit {
namespace {

using Four = double __attribute__((vector_size(32)));

inline Four load_four(const double* from) {
  Four value;
  std::memcpy(&value, from, sizeof value);
  return value;
}

inline void store_four(double* to, const Four& value) { std::memcpy(to, &value, sizeof value); }

inline Four all_four(double value) { return Four{value, value, value, value}; }

/// As many rows of a tile at once as its sums fit into registers.
#ifdef __AVX2__
constexpr std::size_t kVectorCount = 2;
#else
constexpr std::size_t kVectorCount = 1;
#endif

/// Sums of products of kVectorCount times four packed rows with the packed columns.
inline void add_up(const double* rows, const double* columns, std::size_t depth, double* sums) {
  Four sum[kTileColumns][kVectorCount] = {};
  for (std::size_t k = 0; k < depth; ++k) {
    Four row[kVectorCount];
    for (std::size_t v = 0; v < kVectorCount; ++v) {
      row[v] = load_four(rows + kTileRows * k + 4 * v);
    }
    for (std::size_t j = 0; j < kTileColumns; ++j) {
      const Four factor = all_four(columns[kTileColumns * k + j]);
      for (std::size_t v = 0; v < kVectorCount; ++v) {
        sum[j][v] += row[v] * factor;
      }
    }
  }
  for (std::size_t j = 0; j < kTileColumns; ++j) {
    for (std::size_t v = 0; v < kVectorCount; ++v) {
      store_four(sums + kTileRows * j + 4 * v, sum[j][v]);
    }
  }
}

void subtract_tile(double* dense, std::size_t stride, const double* rows, const double* columns,
                   std::size_t depth, std::size_t row_count, std::size_t column_count) {
  double sums[kTileRows * kTileColumns];
  for (std::size_t r = 0; r < kTileRows; r += 4 * kVectorCount) {
    add_up(rows + r, columns, depth, sums + r);
  }
  for (std::size_t j = 0; j < column_count; ++j) {
    double* column = dense + j * stride;
    if (row_count == kTileRows) {
      for (std::size_t r = 0; r < kTileRows; r += 4) {
        store_four(column + r, load_four(column + r) - load_four(sums + kTileRows * j + r));
      }
    } else {
      for (std::size_t r = 0; r < row_count; ++r) {
        column[r] -= sums[kTileRows * j + r];
      }
    }
  }
}

/// Rows that are divided at once.
constexpr std::size_t kStrip = 16;

void divide_strip(double* strip, std::size_t stride, const double* triangle,
                  std::size_t triangle_stride, std::size_t count) {
  for (std::size_t k = 0; k < count; ++k) {
    Four sum[kStrip / 4];
    for (std::size_t v = 0; v < kStrip / 4; ++v) {
      sum[v] = load_four(strip + k * stride + 4 * v);
    }
    for (std::size_t j = 0; j < k; ++j) {
      const Four factor = all_four(triangle[j * triangle_stride + k]);
      for (std::size_t v = 0; v < kStrip / 4; ++v) {
        sum[v] -= load_four(strip + j * stride + 4 * v) * factor;
      }
    }
    const Four pivot = all_four(triangle[k * triangle_stride + k]);
    for (std::size_t v = 0; v < kStrip / 4; ++v) {
      store_four(strip + k * stride + 4 * v, sum[v] / pivot);
    }
  }
}

void divide(double* rows, std::size_t stride, std::size_t row_count, const double* triangle,
            std::size_t triangle_stride, std::size_t count) {
  std::size_t row = 0;
  for (; row + kStrip <= row_count; row += kStrip) {
    divide_strip(rows + row, stride, triangle, triangle_stride, count);
  }
  for (; row < row_count; ++row) {
    for (std::size_t k = 0; k < count; ++k) {
      double sum = rows[k * stride + row];
      for (std::size_t j = 0; j < k; ++j) {
        sum -= rows[j * stride + row] * triangle[j * triangle_stride + k];
      }
      rows[k * stride + row] = sum / triangle[k * triangle_stride + k];
    }
  }
}

constexpr DenseKernels kDenseKernels = {.subtract_tile = subtract_tile, .divide = divide};

}  // namespace
}  // namespace holdfast::limit
