// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstring>

#include "kernels.hpp"

// Included once per instruction set, in a namespace of its own.
namespace holdfast::solver {
namespace {

using Single = float __attribute__((vector_size(32)));
using Quad = float __attribute__((vector_size(16)));
using Double = double __attribute__((vector_size(32)));
using Pair = double __attribute__((vector_size(16)));

inline Single load(const Six& six) {
  Single value;
  std::memcpy(&value, six.v, sizeof value);
  return value;
}

inline Single load(const float* lanes) {
  Single value;
  std::memcpy(&value, lanes, sizeof value);
  return value;
}

inline void store(Six& six, Single value) { std::memcpy(six.v, &value, sizeof value); }

inline Double load_double(const double* lanes) {
  Double value;
  std::memcpy(&value, lanes, sizeof value);
  return value;
}

template <int kLane>
inline Single broadcast(Single a) {
  return __builtin_shufflevector(a, a, kLane, kLane, kLane, kLane, kLane, kLane, kLane, kLane);
}

/// Which displacement bends with which: the axis keeps its own pair, the others cross.
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

inline Single multiply(const Block& block, Single x) {
  const Single a =
      load(block.column[0]) * broadcast<0>(x) + load(block.column[1]) * broadcast<1>(x);
  const Single b =
      load(block.column[2]) * broadcast<2>(x) + load(block.column[3]) * broadcast<3>(x);
  const Single c =
      load(block.column[4]) * broadcast<4>(x) + load(block.column[5]) * broadcast<5>(x);
  return a + b + c;
}

template <int kAxis>
inline Single axis_sum(const LatticeView& level, const Six* z, std::size_t p) {
  const Others& other = level.other[p];
  const Single plus = load(z[other[2 * kAxis]]);
  const Single minus = load(z[other[2 * kAxis + 1]]);
  constexpr int kRow = kBeamLengthMax + 1;
  if (level.kind == nullptr) {
    const BeamRow& beam = level.beams[2 * kAxis * kRow + 1];
    return load(beam.direct) * (plus + minus) + load(beam.crossed) * swap<kAxis>(plus - minus);
  }
  const BeamRow& up = level.beams[2 * kAxis * kRow + level.kind[p][2 * kAxis]];
  const BeamRow& down = level.beams[(2 * kAxis + 1) * kRow + level.kind[p][2 * kAxis + 1]];
  return load(up.direct) * plus + load(up.crossed) * swap<kAxis>(plus) +
         (load(down.direct) * minus + load(down.crossed) * swap<kAxis>(minus));
}

/// Sum of K_pq z_q.
inline Single neighbour_sum(const LatticeView& level, const Six* z, std::size_t p) {
  return axis_sum<0>(level, z, p) + axis_sum<1>(level, z, p) + axis_sum<2>(level, z, p);
}

inline Single neighbour_sum(const ClusterView& level, const Six* z, std::size_t p) {
  Single sum = {};
  for (std::int32_t e = level.start[p]; e < level.start[p + 1]; ++e) {
    sum += multiply(level.blocks[level.block[e]], load(z[level.other[e]]));
  }
  return sum;
}

void relax_first(const std::uint32_t* type, const Block* inverse, const Six* r, Six* z,
                 Range range) {
  for (std::size_t p = range.begin; p < range.end; ++p) {
    store(z[p], multiply(inverse[type[p]], load(r[p])));
  }
}

template <class View>
void relax(const View& level, const Six* r, Six* z, Range range) {
  for (std::size_t p = range.begin; p < range.end; ++p) {
    store(z[p], multiply(level.inverse[level.type[p]], load(r[p]) - neighbour_sum(level, z, p)));
  }
}

/// [f, m] at the node is [f, m + offset x f] at the centre.
inline Single to_centre(const Seat& seat, Single force) {
  const float x = seat.offset[0];
  const float y = seat.offset[1];
  const float z = seat.offset[2];
  const Single first = {0, 0, 0, y, z, x, 0, 0};
  const Single second = {0, 0, 0, z, x, y, 0, 0};
  return force + (first * __builtin_shufflevector(force, force, 6, 6, 6, 2, 0, 1, 6, 7) -
                  second * __builtin_shufflevector(force, force, 6, 6, 6, 1, 2, 0, 6, 7));
}

/// [u, t] of the centre is [u + t x offset, t] at the node.
inline Single to_node(const Seat& seat, Single motion) {
  const float x = seat.offset[0];
  const float y = seat.offset[1];
  const float z = seat.offset[2];
  const Single first = {z, x, y, 0, 0, 0, 0, 0};
  const Single second = {y, z, x, 0, 0, 0, 0, 0};
  return motion + (first * __builtin_shufflevector(motion, motion, 4, 5, 3, 6, 6, 6, 6, 7) -
                   second * __builtin_shufflevector(motion, motion, 5, 3, 4, 6, 6, 6, 6, 7));
}

template <class View>
void restrict_to(const View& level, const TransferView& transfer, std::size_t settled, const Six* r,
                 const Six* z, Six* coarse, Range clusters) {
  for (std::size_t c = clusters.begin; c < clusters.end; ++c) {
    Single sum = {};
    for (std::int32_t i = transfer.start[c]; i < transfer.start[c + 1]; ++i) {
      const auto p = static_cast<std::size_t>(transfer.member[i]);
      if (p < settled) {
        const Single own = multiply(level.diagonal[level.type[p]], load(z[p]));
        sum += to_centre(transfer.seat[p], load(r[p]) - own - neighbour_sum(level, z, p));
      }
    }
    store(coarse[c], sum);
  }
}

void prolong(const TransferView& transfer, const Six* coarse, Six* z, Range range) {
  for (std::size_t p = range.begin; p < range.end; ++p) {
    const Seat& seat = transfer.seat[p];
    store(z[p], load(z[p]) + to_node(seat, load(coarse[seat.cluster])));
  }
}

inline Double low(Single a) {
  return __builtin_convertvector(__builtin_shufflevector(a, a, 0, 1, 2, 3), Double);
}

inline Double high(Single a) {
  return __builtin_convertvector(__builtin_shufflevector(a, a, 4, 5, 6, 7), Double);
}

struct Wide {
  Double low;
  Double high;
};

template <int kAxis>
inline void add_axis(const LatticeView& level, const Six* p, std::size_t node, Wide& sum) {
  constexpr int kRow = kBeamLengthMax + 1;
  for (int sign = 0; sign < 2; ++sign) {
    const auto direction = static_cast<std::size_t>(2 * kAxis + sign);
    const Single u = load(p[level.other[node][direction]]);
    const Single crossed = swap<kAxis>(u);
    const std::size_t length = level.kind == nullptr ? 1 : level.kind[node][direction];
    const BeamRowDouble& beam = level.beams_double[direction * kRow + length];
    sum.low += load_double(beam.direct) * low(u) + load_double(beam.crossed) * low(crossed);
    sum.high +=
        load_double(beam.direct + 4) * high(u) + load_double(beam.crossed + 4) * high(crossed);
  }
}

double apply(const LatticeView& level, const Six* p, double* q, Range range) {
  Double dots = {};
  for (std::size_t node = range.begin; node < range.end; ++node) {
    const Single u = load(p[node]);
    Wide sum = {};
    add_axis<0>(level, p, node, sum);
    add_axis<1>(level, p, node, sum);
    add_axis<2>(level, p, node, sum);
    const BlockDouble& diagonal = level.diagonal_double[level.type[node]];
    for (int k = 0; k < 6; ++k) {
      const double factor = static_cast<double>(p[node].v[k]);
      const Double factors = {factor, factor, factor, factor};
      sum.low += load_double(diagonal.column[k]) * factors;
      sum.high += load_double(diagonal.column[k] + 4) * factors;
    }
    std::memcpy(q + 6 * node, &sum.low, 32);
    std::memcpy(q + 6 * node + 4, &sum.high, 16);
    dots += low(u) * sum.low + high(u) * sum.high;
  }
  return (dots[0] + dots[1]) + (dots[2] + dots[3]);
}

inline Double load_high(const double* lanes) {
  Pair pair;
  std::memcpy(&pair, lanes, sizeof pair);
  return Double{pair[0], pair[1], 0, 0};
}

double advance(double step, const Six* p, const double* q, double* x, double* r, Six* r_single,
               Range range) {
  const Double factor = {step, step, step, step};
  Double dots = {};
  for (std::size_t node = range.begin; node < range.end; ++node) {
    const Single u = load(p[node]);
    const std::size_t i = 6 * node;
    const Double x_low = load_double(x + i) + factor * low(u);
    const Double x_high = load_high(x + i + 4) + factor * high(u);
    const Double r_low = load_double(r + i) - factor * load_double(q + i);
    const Double r_high = load_high(r + i + 4) - factor * load_high(q + i + 4);
    std::memcpy(x + i, &x_low, 32);
    std::memcpy(x + i + 4, &x_high, 16);
    std::memcpy(r + i, &r_low, 32);
    std::memcpy(r + i + 4, &r_high, 16);
    const Quad single_low = __builtin_convertvector(r_low, Quad);
    const Quad single_high = __builtin_convertvector(r_high, Quad);
    std::memcpy(r_single[node].v, &single_low, 16);
    std::memcpy(r_single[node].v + 4, &single_high, 16);
    dots += r_low * r_low;
  }
  return dots[0] + dots[1] + dots[2];
}

double dot(const double* r, const Six* z, Range range) {
  Double dots = {};
  for (std::size_t node = range.begin; node < range.end; ++node) {
    const Single u = load(z[node]);
    dots += load_double(r + 6 * node) * low(u) + load_high(r + 6 * node + 4) * high(u);
  }
  return (dots[0] + dots[1]) + (dots[2] + dots[3]);
}

inline double sum_of(Double dots) { return (dots[0] + dots[1]) + (dots[2] + dots[3]); }

double dot_single(const Six* a, const Six* b, Range range) {
  Double dots = {};
  for (std::size_t node = range.begin; node < range.end; ++node) {
    const Single u = load(a[node]);
    const Single v = load(b[node]);
    dots += low(u) * low(v) + high(u) * high(v);
  }
  return sum_of(dots);
}

double apply_cluster(const ClusterView& level, const Six* z, Six* q, Range range) {
  Double dots = {};
  for (std::size_t p = range.begin; p < range.end; ++p) {
    const Single u = load(z[p]);
    const Single v = multiply(level.diagonal[level.type[p]], u) + neighbour_sum(level, z, p);
    store(q[p], v);
    dots += low(u) * low(v) + high(u) * high(v);
  }
  return sum_of(dots);
}

void combine(float factor, const Six* x, float other, Six* y, Range range) {
  for (std::size_t node = range.begin; node < range.end; ++node) {
    store(y[node], factor * load(x[node]) + other * load(y[node]));
  }
}

constexpr Kernels kAll = {.relax_first = relax_first,
                          .relax_lattice = relax<LatticeView>,
                          .relax_cluster = relax<ClusterView>,
                          .restrict_lattice = restrict_to<LatticeView>,
                          .restrict_cluster = restrict_to<ClusterView>,
                          .prolong = prolong,
                          .apply_cluster = apply_cluster,
                          .dot_single = dot_single,
                          .combine = combine,
                          .apply = apply,
                          .advance = advance,
                          .dot = dot};

}  // namespace
}  // namespace holdfast::solver
