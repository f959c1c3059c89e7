// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "multigrid/kernels/lanes.hpp"

/// What forces a displacement leaves unbalanced, in single precision, from the blocks of K: the
/// least arithmetic. Its rounding errors are 6e-8 of K_pp z_p, at every node others.
namespace holdfast::solver {
// NOLINTBEGIN(google-build-namespaces,misc-definitions-in-headers): a copy per instruction set.
namespace {

template <int kAxis>
inline Single axis_sum(const AxesView<float>& level, const Six<float>* z, std::size_t p) {
  const std::int32_t* const other = level.stencil.other + 6 * p;
  const Single plus = load(z[other[2 * kAxis]]);
  const Single minus = load(z[other[2 * kAxis + 1]]);
  constexpr int kRow = kBeamLengthMax + 1;
  if (level.stencil.kind == nullptr) {
    const BeamRow<float>& beam = level.stencil.beams[2 * kAxis * kRow + 1];
    return load(beam.direct) * (plus + minus) + load(beam.crossed) * swap<kAxis>(plus - minus);
  }
  const BeamLengths& length = level.stencil.lengths[level.stencil.kind[p]];
  const BeamRow<float>& up = level.stencil.beams[2 * kAxis * kRow + length[2 * kAxis]];
  const BeamRow<float>& down = level.stencil.beams[(2 * kAxis + 1) * kRow + length[2 * kAxis + 1]];
  return load(up.direct) * plus + load(up.crossed) * swap<kAxis>(plus) +
         (load(down.direct) * minus + load(down.crossed) * swap<kAxis>(minus));
}

/// Sum of K_pq z_q.
inline Single neighbour_sum(const AxesView<float>& level, const Six<float>* z, std::size_t p) {
  return axis_sum<0>(level, z, p) + axis_sum<1>(level, z, p) + axis_sum<2>(level, z, p);
}

inline Single stencil_sum(const StencilView& stencil, const Six<float>* z, std::size_t p) {
  Single sum = {};
  const std::int32_t* other = stencil.other + 2 * stencil.pair_count * p;
  for (std::size_t k = 0; k < stencil.pair_count; ++k) {
    sum += pair_product(stencil.rows[k], load(z[other[2 * k]]), load(z[other[2 * k + 1]]));
  }
  return sum;
}

inline Single neighbour_sum(const ClusterView<float>& level, const Six<float>* z, std::size_t p) {
  if (level.stencil.other != nullptr) {
    return stencil_sum(level.stencil, z, p);
  }
  Single sum = {};
  for (std::int32_t e = level.start[p]; e < level.start[p + 1]; ++e) {
    sum += multiply(level.blocks[level.block[e]], z[level.other[e]]);
  }
  return sum;
}

/// Asks the memory for what a node's forces take, nodes before its turn: along the Morton curve no
/// processor foresees where the neighbours lie. Those along the axes come in time by themselves.
template <class View, class Real>
inline void foresee(const View&, const Six<Real>*, std::size_t) {}

[[gnu::always_inline]] inline void foresee(const ClusterView<float>& level, const Six<float>* z,
                                           std::size_t p) {
  if (level.stencil.other != nullptr) {
    const std::size_t count = 2 * level.stencil.pair_count;
    for (std::size_t d = 0; d < count; ++d) {
      __builtin_prefetch(&z[level.stencil.other[count * p + d]]);
    }
    return;
  }
  for (std::int32_t e = level.start[p]; e < level.start[p + 1]; ++e) {
    const char* const block = reinterpret_cast<const char*>(&level.blocks[level.block[e]]);
    __builtin_prefetch(&z[level.other[e]]);
    __builtin_prefetch(block);
    __builtin_prefetch(block + 64);
    __builtin_prefetch(block + 128);
  }
}

/// (r - K z)_p
template <class View>
inline Single unbalanced(const View& level, const Six<float>* r, const Six<float>* z,
                         std::size_t p) {
  const Single own = multiply(level.diagonal[level.type[p]], z[p]);
  return load(r[p]) - own - neighbour_sum(level, z, p);
}

/// z_p for which node p is balanced.
template <class View>
inline Single balanced(const View& level, const Six<float>* r, const Six<float>* z, std::size_t p) {
  return multiply(level.inverse[level.type[p]], load(r[p]) - neighbour_sum(level, z, p));
}

/// (K z)_p
inline Single product(const ClusterView<float>& level, const Six<float>* z, std::size_t p) {
  return multiply(level.diagonal[level.type[p]], z[p]) + neighbour_sum(level, z, p);
}

/// What the two neighbours on an axis contribute.
template <int kAxis>
inline Wide wide_axis_sum(const AxesView<float>& level, const Six<float>* p, std::size_t node) {
  constexpr int kRow = kBeamLengthMax + 1;
  const std::int32_t* const other = level.stencil.other + 6 * node;
  const Wide plus = load_wide(p[other[2 * kAxis]]);
  const Wide minus = load_wide(p[other[2 * kAxis + 1]]);
  if (level.stencil.kind == nullptr) {
    const BeamRow<double>& beam = level.stencil.beams_double[2 * kAxis * kRow + 1];
    return load(beam.direct) * (plus + minus) + load(beam.crossed) * swap<kAxis>(plus - minus);
  }
  const BeamLengths& length = level.stencil.lengths[level.stencil.kind[node]];
  const BeamRow<double>& up = level.stencil.beams_double[2 * kAxis * kRow + length[2 * kAxis]];
  const BeamRow<double>& down =
      level.stencil.beams_double[(2 * kAxis + 1) * kRow + length[2 * kAxis + 1]];
  return load(up.direct) * plus + load(up.crossed) * swap<kAxis>(plus) +
         (load(down.direct) * minus + load(down.crossed) * swap<kAxis>(minus));
}

/// (K p)_node of the finest level, in double precision.
[[gnu::always_inline]] inline Wide wide_product(const AxesView<float>& level, const Six<float>* p,
                                                std::size_t node) {
  Wide sum = wide_axis_sum<0>(level, p, node) + wide_axis_sum<1>(level, p, node) +
             wide_axis_sum<2>(level, p, node);
  const Block<double>& diagonal = level.diagonal_double[level.type[node]];
  for (int k = 0; k < 6; ++k) {
    const auto factor = static_cast<double>(p[node].v[k]);
    const Double factors = {factor, factor, factor, factor};
    sum.low += load_double(diagonal.column(k)) * factors;
    sum.high += load_high(diagonal.column(k) + 4) * factors;
  }
  return sum;
}

/// (K p)_node of a finest level in compressed rows, in double precision.
[[gnu::always_inline]] inline Wide wide_product(const ClusterView<float>& level,
                                                const Six<float>* p, std::size_t node) {
  Wide sum = multiply(level.diagonal_double[level.type[node]], load_wide(p[node]));
  if (level.stencil.other != nullptr) {
    const std::int32_t* other = level.stencil.other + 2 * level.stencil.pair_count * node;
    for (std::size_t k = 0; k < level.stencil.pair_count; ++k) {
      sum += pair_product(level.stencil.rows_double[k], load_wide(p[other[2 * k]]),
                          load_wide(p[other[2 * k + 1]]));
    }
    return sum;
  }
  for (std::int32_t e = level.start[node]; e < level.start[node + 1]; ++e) {
    sum += multiply(level.blocks_double[level.block[e]], load_wide(p[level.other[e]]));
  }
  return sum;
}

}  // namespace

// NOLINTEND(google-build-namespaces,misc-definitions-in-headers)
}  // namespace holdfast::solver
