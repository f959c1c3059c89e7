// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>

#include "holdfast/base/algebra.hpp"
#include "holdfast/solver/lanes.hpp"

/// The loops of BlockLu that take the time, compiled three times: for the machine that the compiler
/// aims at, for AVX2 and for AVX-512. Every number comes about by the same operations in the same
/// order, so the bits are the same.
namespace holdfast::solver {

/// The factors of BlockLu as they lie.
struct FactorView {
  std::size_t place_count = 0;
  const std::size_t* column_start = nullptr;
  const std::int32_t* rows = nullptr;
  const base::Mat6<double>* lower = nullptr;    ///< As BlockLu has it.
  const base::Mat6<double>* upper = nullptr;    ///< None of a symmetric matrix.
  const base::Mat6<double>* inverse = nullptr;  ///< Of the pivots, or of their roots.
  bool has_roots = false;                       ///< Of a positive matrix.
};

/// What a finished column takes from a column to its right: slots `first` to `last` of the finished
/// one lie below row k, its slot `source` in row k. The target of a row is slot_of_row[row].
struct ColumnUpdate {
  const std::int32_t* rows = nullptr;
  const std::size_t* slot_of_row = nullptr;
  base::Mat6<double>* lower = nullptr;
  base::Mat6<double>* upper = nullptr;
  std::size_t source = 0;
  std::size_t first = 0;
  std::size_t last = 0;
};

/// A ColumnUpdate of a symmetric matrix, whose finished columns hold L D: by several of these at
/// once that have the same rows from row k on.
struct SymmetricUpdate {
  /// Enough to keep what is subtracted from in registers, few enough that the last ones, which
  /// other threads may be at, are not long waited for.
  static constexpr std::size_t kSourceMax = 8;

  struct Source {
    std::size_t column = 0;
    std::size_t slot = 0;  ///< Of its row k; those of the rows below follow.
  };

  const std::int32_t* rows = nullptr;
  const std::size_t* slot_of_row = nullptr;
  base::Mat6<double>* lower = nullptr;
  base::Mat6<double>* pivot = nullptr;          ///< Of column k.
  const base::Mat6<double>* inverse = nullptr;  ///< Of the pivots, by column; none with roots.
  const Source* sources = nullptr;              ///< Ascending.
  std::size_t source_count = 0;
  std::size_t row_count = 0;  ///< From row k on.
};

struct FactorKernels {
  /// C -= A B
  void (*subtract_product)(base::Mat6<double>& c, const base::Mat6<double>& a,
                           const base::Mat6<double>& b);

  /// C -= A B for `count` products, one after the other; to the same bits.
  void (*subtract_products)(base::Mat6<double>& c, const base::Mat6<double>* const* a,
                            const base::Mat6<double>* const* b, std::size_t count);

  /// C = C A for all blocks C of a range.
  void (*multiply_each)(base::Mat6<double>* first, base::Mat6<double>* last,
                        const base::Mat6<double>& a);

  /// Solves in place for kLaneCount right-hand sides of a symmetric matrix, y by place in the order
  /// of elimination.
  void (*solve_lanes)(const FactorView& factors, LaneBlock* y);

  /// Solves in place for `count` right-hand sides, y by place, then by side.
  void (*substitute)(const FactorView& factors, base::Vec6<double>* y, std::size_t count);

  void (*update_column)(const ColumnUpdate& update);
  void (*update_symmetric)(const SymmetricUpdate& update);
};

/// The kernels for this machine.
const FactorKernels& factor_kernels();

}  // namespace holdfast::solver
