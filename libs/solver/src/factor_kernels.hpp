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
  const base::Mat6<double>* lower = nullptr;    ///< L; of a symmetric matrix L D.
  const base::Mat6<double>* upper = nullptr;    ///< None of a symmetric matrix.
  const base::Mat6<double>* inverse = nullptr;  ///< Of the pivots.
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

/// The same of a symmetric matrix, where the finished column holds L D.
struct SymmetricUpdate {
  const std::int32_t* rows = nullptr;
  const std::size_t* slot_of_row = nullptr;
  base::Mat6<double>* lower = nullptr;
  base::Mat6<double>* pivot = nullptr;          ///< Of column k.
  const base::Mat6<double>* inverse = nullptr;  ///< Of the finished column's pivot.
  std::size_t source = 0;
  std::size_t first = 0;
  std::size_t last = 0;
};

/// The blocks of an inverse A^-1 = Z of a symmetric matrix, lower half: its diagonal by place, what
/// is below by slot. Each column has the rows of the factors' column, and maybe more.
struct InverseView {
  const std::size_t* column_start = nullptr;
  const std::int32_t* rows = nullptr;
  base::Mat6<double>* diagonal = nullptr;
  base::Mat6<double>* below = nullptr;
};

/// A column k of Z as it is made: Z_ik = - sum over rows j of the factors' column k of Z_ij L_jk
/// [Takahashi 1973]. Of Z_ij and Z_ji' one is stored: what the other gives is summed up transposed.
struct InverseColumn {
  std::size_t k = 0;
  base::Mat6<double>* straight = nullptr;      ///< By row of the column of Z.
  base::Mat6<double>* across = nullptr;        ///< The same.
  base::Mat6<double>* lower = nullptr;         ///< L by row of the factors' column.
  base::Mat6<double>* lower_across = nullptr;  ///< L', the same.
};

struct FactorKernels {
  /// C -= A B
  void (*subtract_product)(base::Mat6<double>& c, const base::Mat6<double>& a,
                           const base::Mat6<double>& b);

  /// C = C A for all blocks C of a range.
  void (*multiply_each)(base::Mat6<double>* first, base::Mat6<double>* last,
                        const base::Mat6<double>& a);

  /// Solves in place for kLaneCount right-hand sides of a symmetric matrix; y by place in the order
  /// of elimination.
  void (*substitute_lanes)(const FactorView& factors, LaneBlock* y);

  /// The same for `count` right-hand sides, y by place, then by side.
  void (*substitute)(const FactorView& factors, base::Vec6<double>* y, std::size_t count);

  void (*update_column)(const ColumnUpdate& update);
  void (*update_symmetric)(const SymmetricUpdate& update);

  /// A column of Z: begin, then take what the columns of its rows give, the row by its number, then
  /// end.
  void (*begin_inverse)(const FactorView& factors, const InverseView& inverse,
                        const InverseColumn& column);
  void (*add_to_inverse)(const FactorView& factors, const InverseView& inverse,
                         const InverseColumn& column, std::size_t row);
  void (*end_inverse)(const FactorView& factors, const InverseView& inverse,
                      const InverseColumn& column);
};

/// Those for this machine.
const FactorKernels& factor_kernels();

}  // namespace holdfast::solver
