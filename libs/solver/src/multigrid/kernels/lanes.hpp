// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstring>
#ifdef __AVX2__
#include <immintrin.h>
#endif

#include "multigrid/kernels/kernels.hpp"
#include "multigrid/kernels/split_numbers.hpp"

/// Eight lanes at once: a node's vector of single or double precision.
/// Included once per instruction set, in a namespace of its own.
namespace holdfast::solver {
// NOLINTBEGIN(google-build-namespaces,misc-definitions-in-headers): a copy per instruction set.
namespace {

using Single = float __attribute__((vector_size(32)));
using Quad = float __attribute__((vector_size(16)));
using Double = double __attribute__((vector_size(32)));
using Pair = double __attribute__((vector_size(16)));
using Places = std::int64_t __attribute__((vector_size(32)));
using Ints = std::int32_t __attribute__((vector_size(16)));
using Shorts = std::int16_t __attribute__((vector_size(8)));
using EightShorts = std::int16_t __attribute__((vector_size(16)));

/// A level whose stencil is along the axes: a type of its own, so that loops take the forces that
/// know it.
template <class Real>
struct AxesView : ClusterView<Real> {};

/// Calls a loop with the level as what it is.
template <class Real, class Loop>
decltype(auto) with_shape(const ClusterView<Real>& level, const Loop& loop) {
  return level.stencil.is_along_axes() ? loop(AxesView<Real>{level}) : loop(level);
}

/// Eight lanes of double precision.
struct Wide {
  Double low;
  Double high;

  Wide& operator+=(const Wide& b) {
    low += b.low;
    high += b.high;
    return *this;
  }

  Wide& operator-=(const Wide& b) {
    low -= b.low;
    high -= b.high;
    return *this;
  }

  friend Wide operator+(Wide a, const Wide& b) { return a += b; }

  friend Wide operator-(Wide a, const Wide& b) { return a -= b; }

  friend Wide operator*(const Wide& a, const Wide& b) { return {a.low * b.low, a.high * b.high}; }

  friend Wide operator*(double a, const Wide& b) { return {a * b.low, a * b.high}; }
};

inline Single load(const float* lanes) {
  Single value;
  std::memcpy(&value, lanes, sizeof value);
  return value;
}

inline Double load_double(const double* lanes) {
  Double value;
  std::memcpy(&value, lanes, sizeof value);
  return value;
}

inline Wide load(const double* lanes) { return {load_double(lanes), load_double(lanes + 4)}; }

inline Double load_high(const double* lanes) {
  Pair pair;
  std::memcpy(&pair, lanes, sizeof pair);
  return Double{pair[0], pair[1], 0, 0};
}

inline Single load(const Eight<float>& lanes) { return load(lanes.v); }

inline Wide load(const Eight<double>& lanes) { return load(lanes.v); }

inline Wide load(const Six<double>& six) { return {load_double(six.v), load_high(six.v + 4)}; }

/// The first two of four, and zeros.
inline Quad load_two(const float* lanes) {
  Pair two = {};
  std::memcpy(&two, lanes, 8);
  Quad quad;
  std::memcpy(&quad, &two, 16);
  return quad;
}

inline void store_two(float* lanes, Quad quad) {
  Pair two;
  std::memcpy(&two, &quad, 16);
  const double both = two[0];
  std::memcpy(lanes, &both, 8);
}

inline Single load(const Six<float>& six) {
  Quad low;
  std::memcpy(&low, six.v, 16);
#ifdef __AVX2__
  return _mm256_set_m128(load_two(six.v + 4), low);
#else
  return __builtin_shufflevector(low, load_two(six.v + 4), 0, 1, 2, 3, 4, 5, 6, 7);
#endif
}

inline void store(Six<float>& six, Single value) {
  const Quad low = __builtin_shufflevector(value, value, 0, 1, 2, 3);
  std::memcpy(six.v, &low, 16);
  store_two(six.v + 4, __builtin_shufflevector(value, value, 4, 5, 6, 7));
}

inline void store(Six<double>& six, const Wide& value) {
  std::memcpy(six.v, &value.low, 32);
  std::memcpy(six.v + 4, &value.high, 16);
}

/// Converts in one instruction, of which g++ 12 makes five.
inline Double widened(Quad a) {
#ifdef __AVX2__
  return _mm256_cvtps_pd(a);
#else
  return __builtin_convertvector(a, Double);
#endif
}

inline Double low(Single a) { return widened(__builtin_shufflevector(a, a, 0, 1, 2, 3)); }

inline Double high(Single a) { return widened(__builtin_shufflevector(a, a, 4, 5, 6, 7)); }

inline Double low(const Wide& a) { return a.low; }

inline Double high(const Wide& a) { return a.high; }

/// Loads six numbers in double precision, whatever theirs is.
inline Wide load_wide(const Six<float>& six) {
  Quad low;
  std::memcpy(&low, six.v, 16);
  return {widened(low), widened(load_two(six.v + 4))};
}

inline Wide load_wide(const Six<double>& six) { return load(six); }

/// Rounds six numbers to the precision of the preconditioner.
inline void store_rounded(Six<float>& six, Double low, Double high) {
  const Quad single_low = __builtin_convertvector(low, Quad);
  const Quad single_high = __builtin_convertvector(high, Quad);
  std::memcpy(six.v, &single_low, 16);
  store_two(six.v + 4, single_high);
}

/// split_numbers.hpp, four numbers at a time.
inline Double joined_lanes(Double rounded, Shorts low) {
  Places places;
  std::memcpy(&places, &rounded, sizeof places);
  places += __builtin_convertvector(low, Places) * kUnit;
  std::memcpy(&rounded, &places, sizeof rounded);
  return rounded;
}

inline Shorts low_lanes(Double value, Quad rounded) {
  const Double near = widened(rounded);
  Places places;
  Places near_places;
  Ints bits;
  std::memcpy(&places, &value, sizeof places);
  std::memcpy(&near_places, &near, sizeof near_places);
  std::memcpy(&bits, &rounded, sizeof bits);
  const Ints beyond = __builtin_convertvector(places - near_places, Ints);
  const Ints units = (beyond + kUnit / 2) >> kUnitBits;
  const Ints kept = units & ((bits & kExponentBits) != 0);
  EightShorts halves;
  std::memcpy(&halves, &kept, sizeof halves);
  return __builtin_shufflevector(halves, halves, 0, 2, 4, 6);
}

inline Wide load(const SplitView<float>& split, std::size_t node) {
  const Wide rounded = load_wide(split.rounded[node]);
  Shorts four;
  Shorts two = {};
  std::memcpy(&four, split.low + 6 * node, 8);
  std::memcpy(&two, split.low + 6 * node + 4, 4);
  return {joined_lanes(rounded.low, four), joined_lanes(rounded.high, two)};
}

inline Wide load(const SplitView<double>& split, std::size_t node) {
  return load(split.rounded[node]);
}

inline void store(const SplitView<float>& split, std::size_t node, const Wide& value) {
  const Quad four = __builtin_convertvector(value.low, Quad);
  const Quad two = __builtin_convertvector(value.high, Quad);
  const Shorts low_four = low_lanes(value.low, four);
  const Shorts low_two = low_lanes(value.high, two);
  std::memcpy(split.rounded[node].v, &four, 16);
  store_two(split.rounded[node].v + 4, two);
  std::memcpy(split.low + 6 * node, &low_four, 8);
  std::memcpy(split.low + 6 * node + 4, &low_two, 4);
}

inline void store(const SplitView<double>& split, std::size_t node, const Wide& value) {
  store(split.rounded[node], value);
}

template <int kLane>
inline Single broadcast(Single a) {
  return __builtin_shufflevector(a, a, kLane, kLane, kLane, kLane, kLane, kLane, kLane, kLane);
}

/// Lane 0 to 5 of eight.
template <int kLane>
inline Double broadcast(const Wide& a) {
  if constexpr (kLane < 4) {
    return __builtin_shufflevector(a.low, a.low, kLane, kLane, kLane, kLane);
  } else {
    return __builtin_shufflevector(a.high, a.high, kLane - 4, kLane - 4, kLane - 4, kLane - 4);
  }
}

/// Swaps what bends together: the axis keeps its own pair, the others cross.
template <int kAxis>
inline Single swap(Single a) {
  if constexpr (kAxis == 0) {
    return __builtin_shufflevector(a, a, 0, 5, 4, 3, 2, 1, 6, 7);
  } else if constexpr (kAxis == 1) {
    return __builtin_shufflevector(a, a, 5, 1, 3, 2, 4, 0, 6, 7);
  } else {
    return __builtin_shufflevector(a, a, 4, 3, 2, 1, 0, 5, 6, 7);
  }
}

template <int kAxis>
inline Wide swap(const Wide& a) {
  if constexpr (kAxis == 0) {
    return {__builtin_shufflevector(a.low, a.high, 0, 5, 4, 3),
            __builtin_shufflevector(a.low, a.high, 2, 1, 6, 7)};
  } else if constexpr (kAxis == 1) {
    return {__builtin_shufflevector(a.low, a.high, 5, 1, 3, 2),
            __builtin_shufflevector(a.low, a.high, 4, 0, 6, 7)};
  } else {
    return {__builtin_shufflevector(a.low, a.high, 4, 3, 2, 1),
            __builtin_shufflevector(a.low, a.high, 0, 5, 6, 7)};
  }
}

inline Single multiply(const Block<float>& block, Single x) {
  const Single a =
      load(block.column(0)) * broadcast<0>(x) + load(block.column(1)) * broadcast<1>(x);
  const Single b =
      load(block.column(2)) * broadcast<2>(x) + load(block.column(3)) * broadcast<3>(x);
  const Single c =
      load(block.column(4)) * broadcast<4>(x) + load(block.column(5)) * broadcast<5>(x);
  return a + b + c;
}

/// Number i + kTurn of each three at place i, cyclically; the halves swapped if need be.
template <int kTurn>
inline Single turned(Single a) {
  if constexpr (kTurn == 0) {
    return a;
  } else if constexpr (kTurn == 1) {
    return __builtin_shufflevector(a, a, 1, 2, 0, 4, 5, 3, 6, 7);
  } else {
    return __builtin_shufflevector(a, a, 2, 0, 1, 5, 3, 4, 6, 7);
  }
}

template <int kTurn>
inline Single turned_swapped(Single a) {
  if constexpr (kTurn == 0) {
    return __builtin_shufflevector(a, a, 3, 4, 5, 0, 1, 2, 6, 7);
  } else if constexpr (kTurn == 1) {
    return __builtin_shufflevector(a, a, 4, 5, 3, 1, 2, 0, 6, 7);
  } else {
    return __builtin_shufflevector(a, a, 5, 3, 4, 2, 0, 1, 6, 7);
  }
}

template <int kTurn>
inline Wide turned(const Wide& a) {
  if constexpr (kTurn == 0) {
    return a;
  } else if constexpr (kTurn == 1) {
    return {__builtin_shufflevector(a.low, a.high, 1, 2, 0, 4),
            __builtin_shufflevector(a.low, a.high, 5, 3, 6, 7)};
  } else {
    return {__builtin_shufflevector(a.low, a.high, 2, 0, 1, 5),
            __builtin_shufflevector(a.low, a.high, 3, 4, 6, 7)};
  }
}

template <int kTurn>
inline Wide turned_swapped(const Wide& a) {
  if constexpr (kTurn == 0) {
    return {__builtin_shufflevector(a.low, a.high, 3, 4, 5, 0),
            __builtin_shufflevector(a.low, a.high, 1, 2, 6, 7)};
  } else if constexpr (kTurn == 1) {
    return {__builtin_shufflevector(a.low, a.high, 4, 5, 3, 1),
            __builtin_shufflevector(a.low, a.high, 2, 0, 6, 7)};
  } else {
    return {__builtin_shufflevector(a.low, a.high, 5, 3, 4, 2),
            __builtin_shufflevector(a.low, a.high, 0, 1, 6, 7)};
  }
}

/// What two opposite neighbours contribute.
template <class Real, class Lanes>
inline Lanes pair_product(const PairRow<Real>& row, const Lanes& plus, const Lanes& minus) {
  const Lanes sum = plus + minus;
  const Lanes difference = plus - minus;
  return ((load(row.direct[0]) * turned<0>(sum) +
           load(row.crossed[0]) * turned_swapped<0>(difference)) +
          (load(row.direct[1]) * turned<1>(sum) +
           load(row.crossed[1]) * turned_swapped<1>(difference))) +
         (load(row.direct[2]) * turned<2>(sum) +
          load(row.crossed[2]) * turned_swapped<2>(difference));
}

inline Single repeated(float x) { return Single{x, x, x, x, x, x, x, x}; }

/// Multiplies to the same bits an x in memory, from where numbers are repeated for nothing.
inline Single multiply(const Block<float>& block, const Six<float>& x) {
  const Single a =
      load(block.column(0)) * repeated(x.v[0]) + load(block.column(1)) * repeated(x.v[1]);
  const Single b =
      load(block.column(2)) * repeated(x.v[2]) + load(block.column(3)) * repeated(x.v[3]);
  const Single c =
      load(block.column(4)) * repeated(x.v[4]) + load(block.column(5)) * repeated(x.v[5]);
  return a + b + c;
}

template <int kColumn>
inline Wide column_product(const Block<double>& block, const Wide& x) {
  const Double factor = broadcast<kColumn>(x);
  const double* const column = block.column(kColumn);
  return {load_double(column) * factor, load_high(column + 4) * factor};
}

inline Wide multiply(const Block<double>& block, const Wide& x) {
  return (column_product<0>(block, x) + column_product<1>(block, x)) +
         (column_product<2>(block, x) + column_product<3>(block, x)) +
         (column_product<4>(block, x) + column_product<5>(block, x));
}

/// Three numbers, and what follows them in memory left out.
inline Double load_arm(const double* arm) { return Double{arm[0], arm[1], arm[2], 0}; }

/// [f, m] at a node is [f, m + arm x f] at the point that lies -arm from it.
inline Single force_moved(const float* arm, Single force) {
  const float x = arm[0];
  const float y = arm[1];
  const float z = arm[2];
  const Single first = {0, 0, 0, y, z, x, 0, 0};
  const Single second = {0, 0, 0, z, x, y, 0, 0};
  return force + (first * __builtin_shufflevector(force, force, 6, 6, 6, 2, 0, 1, 6, 7) -
                  second * __builtin_shufflevector(force, force, 6, 6, 6, 1, 2, 0, 6, 7));
}

inline Wide force_moved(const double* arm, Wide force) {
  const Double a = load_arm(arm);
  const Double f = force.low;
  const Double torque =
      __builtin_shufflevector(a, a, 1, 2, 0, 3) * __builtin_shufflevector(f, f, 2, 0, 1, 3) -
      __builtin_shufflevector(a, a, 2, 0, 1, 3) * __builtin_shufflevector(f, f, 1, 2, 0, 3);
  const Double zero = {};
  force.low += __builtin_shufflevector(torque, zero, 4, 4, 4, 0);
  force.high += __builtin_shufflevector(torque, zero, 1, 2, 4, 4);
  return force;
}

/// [u, t] of a body is [u + t x arm, t] at the point that lies `arm` from where u is.
inline Single motion_moved(const float* arm, Single motion) {
  const float x = arm[0];
  const float y = arm[1];
  const float z = arm[2];
  const Single first = {z, x, y, 0, 0, 0, 0, 0};
  const Single second = {y, z, x, 0, 0, 0, 0, 0};
  return motion + (first * __builtin_shufflevector(motion, motion, 4, 5, 3, 6, 6, 6, 6, 7) -
                   second * __builtin_shufflevector(motion, motion, 5, 3, 4, 6, 6, 6, 6, 7));
}

inline Wide motion_moved(const double* arm, const Wide& motion) {
  const Double a = load_arm(arm);
  const Double t = __builtin_shufflevector(motion.low, motion.high, 3, 4, 5, 6);
  const Double shift =
      __builtin_shufflevector(t, t, 1, 2, 0, 3) * __builtin_shufflevector(a, a, 2, 0, 1, 3) -
      __builtin_shufflevector(t, t, 2, 0, 1, 3) * __builtin_shufflevector(a, a, 1, 2, 0, 3);
  return {motion.low + shift, motion.high};
}

}  // namespace

// NOLINTEND(google-build-namespaces,misc-definitions-in-headers)
}  // namespace holdfast::solver
