// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstring>

#include "factor_kernels.hpp"

/// The loops of factor_kernels.hpp. Included once per instruction set, in a namespace of its own;
/// there is no fused multiply-add, so the bits are the same everywhere.
namespace holdfast::solver {
namespace {

using Block = base::Mat6<double>;
using Column = base::Vec6<double>;

using Two = double __attribute__((vector_size(16)));
using Four = double __attribute__((vector_size(32)));

/// The widest vectors that the machine has: so many lanes go together.
#ifdef __AVX512F__
using Wide = double __attribute__((vector_size(64)));
#else
using Wide = Four;
#endif
inline constexpr std::size_t kWide = sizeof(Wide) / sizeof(double);

template <class Vector>
inline Vector load(const double* from) {
  Vector value;
  std::memcpy(&value, from, sizeof value);
  return value;
}

template <class Vector>
inline void store(double* to, const Vector& value) {
  std::memcpy(to, &value, sizeof value);
}

inline Two all_two(double value) { return Two{value, value}; }

inline Four all_four(double value) { return Four{value, value, value, value}; }

inline Wide all_wide(double value) { return value - Wide{}; }

/// A column of a block: four numbers and two.
struct Six {
  Four head;
  Two tail;
};

inline Six load_six(const double* from) { return {load<Four>(from), load<Two>(from + 4)}; }

inline void store_six(double* to, const Six& value) {
  store(to, value.head);
  store(to + 4, value.tail);
}

/// C -= A B
inline void subtract(Block& c, const Block& a, const Block& b) {
  Six column_a[6];
  for (std::size_t k = 0; k < 6; ++k) {
    column_a[k] = load_six(a.values.data() + 6 * k);
  }
  for (std::size_t column = 0; column < 6; ++column) {
    double* const target = c.values.data() + 6 * column;
    Six sum = load_six(target);
    for (std::size_t k = 0; k < 6; ++k) {
      const double factor = b.values[6 * column + k];
      sum.head -= column_a[k].head * all_four(factor);
      sum.tail -= column_a[k].tail * all_two(factor);
    }
    store_six(target, sum);
  }
}

inline Block product(const Block& a, const Block& b) {
  Block c;
  for (std::size_t column = 0; column < 6; ++column) {
    Six sum = {all_four(0), all_two(0)};
    for (std::size_t k = 0; k < 6; ++k) {
      const Six column_a = load_six(a.values.data() + 6 * k);
      const double factor = b.values[6 * column + k];
      sum.head += column_a.head * all_four(factor);
      sum.tail += column_a.tail * all_two(factor);
    }
    store_six(c.values.data() + 6 * column, sum);
  }
  return c;
}

/// y -= A x
inline void subtract(Column& y, const Block& a, const Column& x) {
  Six sum = load_six(y.data());
  for (std::size_t k = 0; k < 6; ++k) {
    const Six column = load_six(a.values.data() + 6 * k);
    sum.head -= column.head * all_four(x[k]);
    sum.tail -= column.tail * all_two(x[k]);
  }
  store_six(y.data(), sum);
}

/// y = A y
inline void multiply_by(const Block& a, Column& y) {
  Six sum = {all_four(0), all_two(0)};
  for (std::size_t k = 0; k < 6; ++k) {
    const Six column = load_six(a.values.data() + 6 * k);
    sum.head += column.head * all_four(y[k]);
    sum.tail += column.tail * all_two(y[k]);
  }
  store_six(y.data(), sum);
}

inline Block transposed(const Block& a) {
  Block t;
  for (std::size_t row = 0; row < 6; ++row) {
    for (std::size_t column = 0; column < 6; ++column) {
      t.values[6 * row + column] = a.values[6 * column + row];
    }
  }
  return t;
}

/// Sums of the first two numbers of a and b, then of their last two.
inline Four sum_of_pairs(const Four& a, const Four& b) {
  return __builtin_shufflevector(a, b, 0, 4, 2, 6) + __builtin_shufflevector(a, b, 1, 5, 3, 7);
}

/// y -= A' x, each number a sum of pairs: ((0 + 1) + (2 + 3)) + (4 + 5).
inline void subtract_across(Column& y, const Block& a, const Column& x) {
  const Six factor = load_six(x.data());
  Six term[6];
  for (std::size_t k = 0; k < 6; ++k) {
    const Six column = load_six(a.values.data() + 6 * k);
    term[k] = {column.head * factor.head, column.tail * factor.tail};
  }
  Two head[3];
  Two tail[3];
  for (std::size_t k = 0; k < 3; ++k) {
    const Four pairs = sum_of_pairs(term[2 * k].head, term[2 * k + 1].head);
    head[k] =
        __builtin_shufflevector(pairs, pairs, 0, 1) + __builtin_shufflevector(pairs, pairs, 2, 3);
    const Two& even = term[2 * k].tail;
    const Two& odd = term[2 * k + 1].tail;
    tail[k] = __builtin_shufflevector(even, odd, 0, 2) + __builtin_shufflevector(even, odd, 1, 3);
  }
  for (std::size_t k = 0; k < 3; ++k) {
    store(y.data() + 2 * k, load<Two>(y.data() + 2 * k) - (head[k] + tail[k]));
  }
}

/// y -= A' x, lane by lane, with the same sums.
inline void subtract_across(LaneBlock& y, const Block& a, const LaneBlock& x) {
  for (std::size_t lane = 0; lane < kLaneCount; lane += kWide) {
    Wide factor[6];
    for (std::size_t k = 0; k < 6; ++k) {
      factor[k] = load<Wide>(x.values[k] + lane);
    }
    for (std::size_t i = 0; i < 6; ++i) {
      const double* const v = a.values.data() + 6 * i;
      const Wide sum = ((all_wide(v[0]) * factor[0] + all_wide(v[1]) * factor[1]) +
                        (all_wide(v[2]) * factor[2] + all_wide(v[3]) * factor[3])) +
                       (all_wide(v[4]) * factor[4] + all_wide(v[5]) * factor[5]);
      store(y.values[i] + lane, load<Wide>(y.values[i] + lane) - sum);
    }
  }
}

/// y -= A x, lane by lane.
inline void subtract(LaneBlock& y, const Block& a, const LaneBlock& x) {
  for (std::size_t lane = 0; lane < kLaneCount; lane += kWide) {
    Wide sum[6];
    for (std::size_t i = 0; i < 6; ++i) {
      sum[i] = load<Wide>(y.values[i] + lane);
    }
    for (std::size_t k = 0; k < 6; ++k) {
      const Wide factor = load<Wide>(x.values[k] + lane);
      for (std::size_t i = 0; i < 6; ++i) {
        sum[i] -= all_wide(a.values[6 * k + i]) * factor;
      }
    }
    for (std::size_t i = 0; i < 6; ++i) {
      store(y.values[i] + lane, sum[i]);
    }
  }
}

/// y = A y, lane by lane.
inline void multiply_by(const Block& a, LaneBlock& y) {
  for (std::size_t lane = 0; lane < kLaneCount; lane += kWide) {
    Wide sum[6] = {};
    for (std::size_t k = 0; k < 6; ++k) {
      const Wide factor = load<Wide>(y.values[k] + lane);
      for (std::size_t i = 0; i < 6; ++i) {
        sum[i] += all_wide(a.values[6 * k + i]) * factor;
      }
    }
    for (std::size_t i = 0; i < 6; ++i) {
      store(y.values[i] + lane, sum[i]);
    }
  }
}

inline bool is_zero(const LaneBlock& block) {
  for (const auto& row : block.values) {
    for (const double value : row) {
      if (value != 0) {
        return false;
      }
    }
  }
  return true;
}

/// What is left of the backward substitution for a place: x = D^-1 y + D^-1 `rest`, the first of
/// which is there already.
inline void add_rest(const Block& inverse, LaneBlock& rest, LaneBlock& y) {
  multiply_by(inverse, rest);
  for (std::size_t i = 0; i < 6; ++i) {
    for (std::size_t lane = 0; lane < kLaneCount; ++lane) {
      y.values[i][lane] += rest.values[i][lane];
    }
  }
}

void substitute_lanes(const FactorView& factors, LaneBlock* y) {
  const std::size_t n = factors.place_count;
  for (std::size_t k = 0; k < n; ++k) {
    if (is_zero(y[k])) {
      continue;  // Loads on a few nodes reach only the ancestors of these.
    }
    multiply_by(factors.inverse[k], y[k]);
    for (std::size_t slot = factors.column_start[k]; slot < factors.column_start[k + 1]; ++slot) {
      subtract(y[factors.rows[slot]], factors.lower[slot], y[k]);
    }
  }
  for (std::size_t k = n; k-- > 0;) {
    LaneBlock rest;
    for (std::size_t slot = factors.column_start[k]; slot < factors.column_start[k + 1]; ++slot) {
      subtract_across(rest, factors.lower[slot], y[factors.rows[slot]]);
    }
    add_rest(factors.inverse[k], rest, y[k]);
  }
}

void substitute_symmetric(const FactorView& factors, Column* y, std::size_t count) {
  const std::size_t n = factors.place_count;
  for (std::size_t k = 0; k < n; ++k) {
    for (std::size_t c = 0; c < count; ++c) {
      multiply_by(factors.inverse[k], y[count * k + c]);
    }
    for (std::size_t slot = factors.column_start[k]; slot < factors.column_start[k + 1]; ++slot) {
      Column* const row = y + count * static_cast<std::size_t>(factors.rows[slot]);
      for (std::size_t c = 0; c < count; ++c) {
        subtract(row[c], factors.lower[slot], y[count * k + c]);
      }
    }
  }
  for (std::size_t k = n; k-- > 0;) {
    for (std::size_t c = 0; c < count; ++c) {
      Column rest{};
      for (std::size_t slot = factors.column_start[k]; slot < factors.column_start[k + 1]; ++slot) {
        subtract_across(rest, factors.lower[slot],
                        y[count * static_cast<std::size_t>(factors.rows[slot]) + c]);
      }
      multiply_by(factors.inverse[k], rest);
      for (std::size_t i = 0; i < 6; ++i) {
        y[count * k + c][i] += rest[i];
      }
    }
  }
}

void substitute(const FactorView& factors, Column* y, std::size_t count) {
  if (factors.upper == nullptr) {
    substitute_symmetric(factors, y, count);
    return;
  }
  const std::size_t n = factors.place_count;
  for (std::size_t k = 0; k < n; ++k) {
    for (std::size_t slot = factors.column_start[k]; slot < factors.column_start[k + 1]; ++slot) {
      Column* const row = y + count * static_cast<std::size_t>(factors.rows[slot]);
      for (std::size_t c = 0; c < count; ++c) {
        subtract(row[c], factors.lower[slot], y[count * k + c]);
      }
    }
  }
  for (std::size_t k = n; k-- > 0;) {
    for (std::size_t slot = factors.column_start[k]; slot < factors.column_start[k + 1]; ++slot) {
      const Column* const row = y + count * static_cast<std::size_t>(factors.rows[slot]);
      for (std::size_t c = 0; c < count; ++c) {
        subtract(y[count * k + c], factors.upper[slot], row[c]);
      }
    }
    for (std::size_t c = 0; c < count; ++c) {
      multiply_by(factors.inverse[k], y[count * k + c]);
    }
  }
}

void update_column(const ColumnUpdate& update) {
  const Block l_kj = update.lower[update.source];
  const Block u_jk = update.upper[update.source];
  for (std::size_t slot = update.first; slot < update.last; ++slot) {
    const std::size_t target = update.slot_of_row[static_cast<std::size_t>(update.rows[slot])];
    subtract(update.lower[target], update.lower[slot], u_jk);
    subtract(update.upper[target], l_kj, update.upper[slot]);
  }
}

void multiply_each(Block* first, Block* last, const Block& a) {
  for (; first != last; ++first) {
    *first = product(*first, a);
  }
}

/// (L D)_ik -= (L D)_ij L_kj'
void update_symmetric(const SymmetricUpdate& update) {
  const Block across = transposed(update.lower[update.source]);
  const Block l_kj_across = product(*update.inverse, across);
  subtract(*update.pivot, update.lower[update.source], l_kj_across);
  for (std::size_t slot = update.first; slot < update.last; ++slot) {
    const std::size_t target = update.slot_of_row[static_cast<std::size_t>(update.rows[slot])];
    subtract(update.lower[target], update.lower[slot], l_kj_across);
  }
}

void begin_inverse(const FactorView& factors, const InverseView& inverse,
                   const InverseColumn& column) {
  const std::size_t k = column.k;
  for (std::size_t i = 0; i < inverse.column_start[k + 1] - inverse.column_start[k]; ++i) {
    column.straight[i] = {};
    column.across[i] = {};
  }
  const std::size_t begin = factors.column_start[k];
  for (std::size_t i = 0; i < factors.column_start[k + 1] - begin; ++i) {
    column.lower[i] = product(factors.lower[begin + i], factors.inverse[k]);
    column.lower_across[i] = transposed(column.lower[i]);
  }
}

void add_to_inverse(const FactorView& factors, const InverseView& inverse,
                    const InverseColumn& column, std::size_t row) {
  const std::int32_t* const all_rows = inverse.rows + inverse.column_start[column.k];
  const std::size_t all_count = inverse.column_start[column.k + 1] - inverse.column_start[column.k];
  const std::int32_t* const rows = factors.rows + factors.column_start[column.k];
  const std::size_t count = factors.column_start[column.k + 1] - factors.column_start[column.k];
  const std::int32_t place = all_rows[row];
  std::size_t j = 0;
  while (j < count && rows[j] < place) {
    ++j;
  }
  const bool is_of_factors = j < count && rows[j] == place;
  const Block* const l_jk = column.lower + j;
  if (is_of_factors) {
    subtract(column.straight[row], inverse.diagonal[place], *l_jk);
    ++j;
  }
  std::size_t slot = inverse.column_start[place];
  for (std::size_t i = row + 1; i < all_count; ++i) {
    const bool is_other_of_factors = j < count && rows[j] == all_rows[i];
    if (!is_of_factors && !is_other_of_factors) {
      continue;
    }
    while (inverse.rows[slot] != all_rows[i]) {
      ++slot;  // The column of this row has all that are needed.
    }
    if (is_of_factors) {
      subtract(column.straight[i], inverse.below[slot], *l_jk);
    }
    if (is_other_of_factors) {
      subtract(column.across[row], column.lower_across[j++], inverse.below[slot]);
    }
  }
}

/// Z_kk = D_k^-1 - sum of L_jk' Z_jk
void end_inverse(const FactorView& factors, const InverseView& inverse,
                 const InverseColumn& column) {
  const std::size_t k = column.k;
  const std::size_t begin = inverse.column_start[k];
  const std::int32_t* const rows = factors.rows + factors.column_start[k];
  const std::size_t count = factors.column_start[k + 1] - factors.column_start[k];
  Block pivot = factors.inverse[k];
  std::size_t j = 0;
  for (std::size_t i = 0; i < inverse.column_start[k + 1] - begin; ++i) {
    const Block other = transposed(column.across[i]);
    Block sum = column.straight[i];
    for (std::size_t v = 0; v < 36; ++v) {
      sum.values[v] += other.values[v];
    }
    inverse.below[begin + i] = sum;
    if (j < count && rows[j] == inverse.rows[begin + i]) {
      subtract(pivot, column.lower_across[j++], sum);
    }
  }
  inverse.diagonal[k] = pivot;
}

constexpr FactorKernels kFactorKernels = {.subtract_product = subtract,
                                          .multiply_each = multiply_each,
                                          .substitute_lanes = substitute_lanes,
                                          .substitute = substitute,
                                          .update_column = update_column,
                                          .update_symmetric = update_symmetric,
                                          .begin_inverse = begin_inverse,
                                          .add_to_inverse = add_to_inverse,
                                          .end_inverse = end_inverse};

}  // namespace
}  // namespace holdfast::solver
