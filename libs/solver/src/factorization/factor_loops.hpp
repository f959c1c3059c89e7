// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstring>

#include "factorization/factor_kernels.hpp"

#ifdef __AVX512F__
#include <immintrin.h>
#endif

/// The loops of factor_kernels.hpp. Included once per instruction set, in a namespace of its own;
/// there is no fused multiply-add, so the bits are the same everywhere.
namespace holdfast::solver {
// NOLINTBEGIN(google-build-namespaces,misc-definitions-in-headers): a copy per instruction set.
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

/// A column of a block that many are subtracted from: in one register, where there are such.
#ifdef __AVX512F__
using Tall = Wide;

/// Loads what has lain there for a while: it is read in other pieces than it was written in.
inline Tall load_tall(const double* from) {
  constexpr __mmask8 kSix = 0x3F;
  return _mm512_maskz_loadu_pd(kSix, from);
}

inline Tall tall(const Six& value) {
  const Four tail = __builtin_shufflevector(value.tail, Two{}, 0, 1, 2, 3);
  return __builtin_shufflevector(value.head, tail, 0, 1, 2, 3, 4, 5, 6, 7);
}

inline Six six(const Tall& value) {
  return {__builtin_shufflevector(value, value, 0, 1, 2, 3),
          __builtin_shufflevector(value, value, 4, 5)};
}

inline void add_scaled(Tall& sum, const Tall& column, double factor) {
  sum += column * all_wide(factor);
}

inline void subtract_scaled(Tall& sum, const Tall& column, double factor) {
  sum -= column * all_wide(factor);
}
#else
using Tall = Six;

inline Tall load_tall(const double* from) { return load_six(from); }

inline Tall tall(const Six& value) { return value; }

inline Six six(const Tall& value) { return value; }

inline void add_scaled(Tall& sum, const Tall& column, double factor) {
  sum.head += column.head * all_four(factor);
  sum.tail += column.tail * all_two(factor);
}

inline void subtract_scaled(Tall& sum, const Tall& column, double factor) {
  sum.head -= column.head * all_four(factor);
  sum.tail -= column.tail * all_two(factor);
}
#endif

/// C -= A_0 B_0, then A_1 B_1, and so on, to the same bits as one after another; with kIsAcross the
/// transposes of the B.
template <bool kIsAcross, class A, class B>
inline void subtract_each(Block& c, const A& a, const B& b, std::size_t count) {
  Tall sum[6];
  for (std::size_t column = 0; column < 6; ++column) {
    sum[column] = tall(load_six(c.values.data() + 6 * column));
  }
  for (std::size_t j = 0; j < count; ++j) {
    const double* const a_j = a(j).values.data();
    const double* const b_j = b(j).values.data();
    for (std::size_t k = 0; k < 6; ++k) {
      const Tall column_a = load_tall(a_j + 6 * k);
      for (std::size_t column = 0; column < 6; ++column) {
        subtract_scaled(sum[column], column_a, b_j[kIsAcross ? 6 * k + column : 6 * column + k]);
      }
    }
  }
  for (std::size_t column = 0; column < 6; ++column) {
    store_six(c.values.data() + 6 * column, six(sum[column]));
  }
}

void subtract_products(Block& c, const Block* const* a, const Block* const* b, std::size_t count) {
  const auto left = [&](std::size_t j) -> const Block& { return *a[j]; };
  const auto right = [&](std::size_t j) -> const Block& { return *b[j]; };
  subtract_each<false>(c, left, right, count);
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
  Tall column_a[6];
  for (std::size_t k = 0; k < 6; ++k) {
    column_a[k] = load_tall(a.values.data() + 6 * k);
  }
  Block c;
  for (std::size_t column = 0; column < 6; ++column) {
    Tall sum = tall({all_four(0), all_two(0)});
    for (std::size_t k = 0; k < 6; ++k) {
      add_scaled(sum, column_a[k], b.values[6 * column + k]);
    }
    store_six(c.values.data() + 6 * column, six(sum));
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

/// One number of A' x, of a column of A, lane by lane, with the same sums.
inline Wide sum_across(const double* column, const Wide* factor) {
  return ((all_wide(column[0]) * factor[0] + all_wide(column[1]) * factor[1]) +
          (all_wide(column[2]) * factor[2] + all_wide(column[3]) * factor[3])) +
         (all_wide(column[4]) * factor[4] + all_wide(column[5]) * factor[5]);
}

/// y -= A' x, lane by lane.
inline void subtract_across(LaneBlock& y, const Block& a, const LaneBlock& x) {
  for (std::size_t lane = 0; lane < kLaneCount; lane += kWide) {
    Wide factor[6];
    for (std::size_t k = 0; k < 6; ++k) {
      factor[k] = load<Wide>(x.values[k] + lane);
    }
    for (std::size_t i = 0; i < 6; ++i) {
      const Wide sum = sum_across(a.values.data() + 6 * i, factor);
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

/// Columns that go through a substitution together: each has the rows of the next one, and that
/// one's own. Every sum is the same for any number of them.
inline constexpr std::size_t kForwardColumns = 4;
#ifdef __AVX512F__
inline constexpr std::size_t kBackwardColumns = 3;  ///< As many as there are registers for.
#else
inline constexpr std::size_t kBackwardColumns = 1;
#endif

inline bool has_rows_of_next(const FactorView& factors, std::size_t k) {
  const std::size_t* const start = factors.column_start + k;
  return k + 1 < factors.place_count && start[1] - start[0] == start[2] - start[1] + 1 &&
         static_cast<std::size_t>(factors.rows[start[0]]) == k + 1;
}

/// Subtracts what the columns of [first, end) contribute to the rows that all of them have.
inline void substitute_forward(const FactorView& factors, std::size_t first, std::size_t end,
                               LaneBlock* y) {
  const std::size_t* const ends = factors.column_start + 1;
  for (std::size_t back = ends[end - 1] - factors.column_start[end - 1]; back > 0; --back) {
    LaneBlock& row = y[factors.rows[ends[end - 1] - back]];
    for (std::size_t lane = 0; lane < kLaneCount; lane += kWide) {
      Wide sum[6];
      for (std::size_t i = 0; i < 6; ++i) {
        sum[i] = load<Wide>(row.values[i] + lane);
      }
      for (std::size_t column = first; column < end; ++column) {
        const double* const a = factors.lower[ends[column] - back].values.data();
        for (std::size_t k = 0; k < 6; ++k) {
          const Wide factor = load<Wide>(y[column].values[k] + lane);
          for (std::size_t i = 0; i < 6; ++i) {
            sum[i] -= all_wide(a[6 * k + i]) * factor;
          }
        }
      }
      for (std::size_t i = 0; i < 6; ++i) {
        store(row.values[i] + lane, sum[i]);
      }
    }
  }
}

/// What the rows that all of `count` columns from `first` on have contribute to these, the last row
/// first.
template <std::size_t kCount>
inline void substitute_backward(const FactorView& factors, std::size_t first, std::size_t count,
                                const LaneBlock* y, LaneBlock* rest) {
  if constexpr (kCount > 1) {
    if (count < kCount) {
      return substitute_backward<kCount - 1>(factors, first, count, y, rest);
    }
  }
  const std::size_t* const ends = factors.column_start + first + 1;
  const std::size_t end = ends[kCount - 1];
  const std::size_t row_count = end - factors.column_start[first + kCount - 1];
  for (std::size_t lane = 0; lane < kLaneCount; lane += kWide) {
    Wide sum[kCount][6] = {};
    for (std::size_t back = 1; back <= row_count; ++back) {
      const LaneBlock& row = y[factors.rows[end - back]];
      Wide factor[6];
      for (std::size_t k = 0; k < 6; ++k) {
        factor[k] = load<Wide>(row.values[k] + lane);
      }
      for (std::size_t t = 0; t < kCount; ++t) {
        const double* const a = factors.lower[ends[t] - back].values.data();
        for (std::size_t i = 0; i < 6; ++i) {
          sum[t][i] -= sum_across(a + 6 * i, factor);
        }
      }
    }
    for (std::size_t t = 0; t < kCount; ++t) {
      for (std::size_t i = 0; i < 6; ++i) {
        store(rest[t].values[i] + lane, sum[t][i]);
      }
    }
  }
}

void forward_lanes(const FactorView& factors, LaneBlock* y) {
  const std::size_t* const start = factors.column_start;
  for (std::size_t k = 0; k < factors.place_count;) {
    if (is_zero(y[k])) {
      ++k;
      continue;  // Loads on a few nodes reach only the ancestors of these.
    }
    const std::size_t first = k++;
    while (k - first < kForwardColumns && has_rows_of_next(factors, k - 1)) {
      ++k;
    }
    for (std::size_t column = first; column < k; ++column) {
      multiply_by(factors.inverse[column], y[column]);
      for (std::size_t own = 0; own + 1 < k - column; ++own) {
        subtract(y[column + 1 + own], factors.lower[start[column] + own], y[column]);
      }
    }
    substitute_forward(factors, first, k, y);
  }
}

void backward_lanes(const FactorView& factors, LaneBlock* y) {
  const std::size_t* const start = factors.column_start;
  for (std::size_t end = factors.place_count; end > 0;) {
    std::size_t first = end - 1;
    while (end - first < kBackwardColumns && first > 0 && has_rows_of_next(factors, first - 1)) {
      --first;
    }
    LaneBlock rest[kBackwardColumns];
    substitute_backward<kBackwardColumns>(factors, first, end - first, y, rest);
    for (std::size_t column = end; column-- > first;) {
      for (std::size_t own = end - 1 - column; own-- > 0;) {
        subtract_across(rest[column - first], factors.lower[start[column] + own],
                        y[column + 1 + own]);
      }
      add_rest(factors.inverse[column], rest[column - first], y[column]);
    }
    end = first;
  }
}

void solve_lanes(const FactorView& factors, LaneBlock* y) {
  forward_lanes(factors, y);
  backward_lanes(factors, y);
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
      for (std::size_t slot = factors.column_start[k + 1]; slot-- > factors.column_start[k];) {
        subtract_across(rest, factors.lower[slot],
                        y[count * static_cast<std::size_t>(factors.rows[slot]) + c]);
      }
      Column& own = y[count * k + c];
      if (factors.has_roots) {  // D^-1/2' (D^-1/2 b + rest)
        Column sum{};
        for (std::size_t i = 0; i < 6; ++i) {
          rest[i] = -own[i] - rest[i];
        }
        subtract_across(sum, factors.inverse[k], rest);
        own = sum;
        continue;
      }
      multiply_by(factors.inverse[k], rest);
      for (std::size_t i = 0; i < 6; ++i) {
        own[i] += rest[i];
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

/// (L D)_ik -= sum over the finished columns j of (L D)_ij L_kj'; with roots, L_ij L_kj'.
void update_symmetric(const SymmetricUpdate& update) {
  Block l_k[SymmetricUpdate::kSourceMax];
  for (std::size_t j = 0; j < update.source_count; ++j) {
    const SymmetricUpdate::Source& source = update.sources[j];
    l_k[j] = update.inverse == nullptr
                 ? update.lower[source.slot]
                 : product(update.lower[source.slot], update.inverse[source.column]);
  }
  const auto subtract_row = [&](Block& target, std::size_t row) {
    const auto left = [&](std::size_t j) -> const Block& {
      return update.lower[update.sources[j].slot + row];
    };
    const auto right = [&](std::size_t j) -> const Block& { return l_k[j]; };
    subtract_each<true>(target, left, right, update.source_count);
  };
  subtract_row(*update.pivot, 0);
  const std::int32_t* const rows = update.rows + update.sources[0].slot;
  for (std::size_t row = 1; row < update.row_count; ++row) {
    subtract_row(update.lower[update.slot_of_row[static_cast<std::size_t>(rows[row])]], row);
  }
}

constexpr FactorKernels kFactorKernels = {.subtract_product = subtract,
                                          .subtract_products = subtract_products,
                                          .multiply_each = multiply_each,
                                          .solve_lanes = solve_lanes,
                                          .substitute = substitute,
                                          .update_column = update_column,
                                          .update_symmetric = update_symmetric};

}  // namespace

// NOLINTEND(google-build-namespaces,misc-definitions-in-headers)
}  // namespace holdfast::solver
