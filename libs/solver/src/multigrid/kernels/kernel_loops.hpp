// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>

#include "multigrid/kernels/block_forces.hpp"
#include "multigrid/kernels/precise_forces.hpp"

// Included once per instruction set, in a namespace of its own.
namespace holdfast::solver {
// NOLINTBEGIN(google-build-namespaces,misc-definitions-in-headers): a copy per instruction set.
namespace {

inline void relax_first(const std::uint32_t* type, const Block<float>* inverse, const Six<float>* r,
                        Six<float>* z, Range range) {
  for (std::size_t p = range.begin; p < range.end; ++p) {
    store(z[p], multiply(inverse[type[p]], load(r[p])));
  }
}

/// Memory is asked for so many nodes before it is needed: with 4 a sweep over a ball of a million
/// face-centred modules takes 1.3 times as long, with none 2.8 times. Where clusters go through all
/// colours at once half as many of each are better.
constexpr std::size_t kAhead = 16;
constexpr std::size_t kAheadByColour = 8;

inline void relax(const ClusterView<float>& cluster, const Six<float>* r, Six<float>* z,
                  Range range) {
  with_shape(cluster, [&](const auto& level) {
    for (std::size_t p = range.begin; p < range.end; ++p) {
      foresee(level, z, std::min(p + kAhead, range.end - 1));
      store(z[p], balanced(level, r, z, p));
    }
  });
}

template <class Real>
void restrict_to(const ClusterView<Real>& cluster, const TransferView<Real>& transfer,
                 std::size_t settled, const Six<Real>* r, const Six<float>* z, Six<Real>* coarse,
                 Range clusters) {
  with_shape(cluster, [&](const auto& level) {
    for (std::size_t k = clusters.begin; k < clusters.end; ++k) {
      decltype(load(r[0])) sum = {};
      for (std::int32_t i = transfer.start[k]; i < transfer.start[k + 1]; ++i) {
        const auto p = static_cast<std::size_t>(transfer.member[i]);
        if (p < settled) {
          const std::size_t next = std::min(p + kAheadByColour, settled - 1);
          foresee(level, z, next);
          __builtin_prefetch(&z[next]);
          __builtin_prefetch(&r[next]);
          __builtin_prefetch(&transfer.seat[next]);
          sum += force_moved(transfer.offset_of(p), unbalanced(level, r, z, p));
        }
      }
      store(coarse[transfer.seat[transfer.member[transfer.start[k]]].cluster], sum);
    }
  });
}

template <class Real>
void prolong(const TransferView<Real>& transfer, const Six<Real>* coarse, Six<Real>* z,
             Range range) {
  for (std::size_t p = range.begin; p < range.end; ++p) {
    const auto motion = load(coarse[transfer.seat[p].cluster]);
    store(z[p], load(z[p]) + motion_moved(transfer.offset_of(p), motion));
  }
}

inline void round(const Six<double>* r, Six<float>* rounded, Range range) {
  for (std::size_t p = range.begin; p < range.end; ++p) {
    const Wide value = load(r[p]);
    store_rounded(rounded[p], value.low, value.high);
  }
}

inline void prolong_rough(const TransferView<double>& transfer, const Six<double>* coarse,
                          const Six<float>* rough, Six<double>* z, Range range) {
  for (std::size_t p = range.begin; p < range.end; ++p) {
    const auto motion = load(coarse[transfer.seat[p].cluster]);
    store(z[p], load_wide(rough[p]) + motion_moved(transfer.offset_of(p), motion));
  }
}

inline void leave(const ClusterView<double>& cluster, const Six<double>* r, const Six<double>* z,
                  Six<float>* rounded, Range range) {
  with_shape(cluster, [&](const auto& level) {
    for (std::size_t p = range.begin; p < range.end; ++p) {
      const Wide left = unbalanced(level, r, z, p);
      store_rounded(rounded[p], left.low, left.high);
    }
  });
}

inline double sum_of(Double dots) { return (dots[0] + dots[1]) + (dots[2] + dots[3]); }

inline double add(const Six<float>* rough, const Six<double>* r, Six<double>* z, Range range) {
  Double dots = {};
  for (std::size_t p = range.begin; p < range.end; ++p) {
    const Wide sum = load(z[p]) + load_wide(rough[p]);
    const Wide force = load(r[p]);
    store(z[p], sum);
    dots += sum.low * force.low + sum.high * force.high;
  }
  return sum_of(dots);
}

template <class Real>
double apply(const ClusterView<Real>& cluster, const Six<Real>* p, double* q, Range range) {
  return with_shape(cluster, [&](const auto& level) {
    Double dots = {};
    for (std::size_t node = range.begin; node < range.end; ++node) {
      foresee(level, p, std::min(node + kAhead, range.end - 1));
      const auto u = load(p[node]);
      const Wide sum = wide_product(level, p, node);
      std::memcpy(q + 6 * node, &sum.low, 32);
      std::memcpy(q + 6 * node + 4, &sum.high, 16);
      dots += low(u) * sum.low + high(u) * sum.high;
    }
    return sum_of(dots);
  });
}

template <class Real>
std::array<double, 2> compare(const ClusterView<Real>& cluster, const Six<Real>* z,
                              const Six<Real>* p, Range range) {
  return with_shape(cluster, [&](const auto& level) {
    Double own = {};
    Double other = {};
    for (std::size_t node = range.begin; node < range.end; ++node) {
      foresee(level, z, std::min(node + kAhead, range.end - 1));
      const auto u = load(z[node]);
      const auto v = load(p[node]);
      const Wide sum = wide_product(level, z, node);
      own += low(u) * sum.low + high(u) * sum.high;
      other += low(v) * sum.low + high(v) * sum.high;
    }
    return std::array{sum_of(own), sum_of(other)};
  });
}

template <class Real>
double advance_by_product(const ClusterView<Real>& cluster, double step, const Six<Real>* p,
                          double* x, SplitView<Real> r, Range range) {
  return with_shape(cluster, [&](const auto& level) {
    const Double factor = {step, step, step, step};
    Double dots = {};
    for (std::size_t node = range.begin; node < range.end; ++node) {
      foresee(level, p, std::min(node + kAhead, range.end - 1));
      const auto u = load(p[node]);
      const Wide sum = wide_product(level, p, node);
      dots += low(u) * sum.low + high(u) * sum.high;
      const std::size_t i = 6 * node;
      const Wide left = load(r, node);
      const Double x_low = load_double(x + i) + factor * low(u);
      const Double x_high = load_high(x + i + 4) + factor * high(u);
      std::memcpy(x + i, &x_low, 32);
      std::memcpy(x + i + 4, &x_high, 16);
      store(r, node, Wide{left.low - factor * sum.low, left.high - factor * sum.high});
    }
    return sum_of(dots);
  });
}

template <class Real>
void advance(double step, const Six<Real>* p, const double* q, double* x, SplitView<Real> r,
             Range range) {
  const Double factor = {step, step, step, step};
  for (std::size_t node = range.begin; node < range.end; ++node) {
    const auto u = load(p[node]);
    const std::size_t i = 6 * node;
    const Wide left = load(r, node);
    const Double x_low = load_double(x + i) + factor * low(u);
    const Double x_high = load_high(x + i + 4) + factor * high(u);
    std::memcpy(x + i, &x_low, 32);
    std::memcpy(x + i + 4, &x_high, 16);
    store(r, node,
          Wide{left.low - factor * load_double(q + i), left.high - factor * load_high(q + i + 4)});
  }
}

template <class Real>
double dot(const double* r, const Six<Real>* z, Range range) {
  Double dots = {};
  for (std::size_t node = range.begin; node < range.end; ++node) {
    const auto u = load(z[node]);
    dots += load_double(r + 6 * node) * low(u) + load_high(r + 6 * node + 4) * high(u);
  }
  return sum_of(dots);
}

template <class Real>
double dot_split(SplitView<Real> r, const Six<Real>* z, Range range) {
  Double dots = {};
  for (std::size_t node = range.begin; node < range.end; ++node) {
    const auto u = load(z[node]);
    const Wide value = load(r, node);
    dots += value.low * low(u) + value.high * high(u);
  }
  return sum_of(dots);
}

template <class Real>
double dot_same(const Six<Real>* a, const Six<Real>* b, Range range) {
  Double dots = {};
  for (std::size_t node = range.begin; node < range.end; ++node) {
    const auto u = load(a[node]);
    const auto v = load(b[node]);
    dots += low(u) * low(v) + high(u) * high(v);
  }
  return sum_of(dots);
}

template <class Real>
double apply_cluster(const ClusterView<Real>& level, const Six<Real>* z, Six<Real>* q,
                     Range range) {
  Double dots = {};
  for (std::size_t p = range.begin; p < range.end; ++p) {
    foresee(level, z, std::min(p + kAhead, range.end - 1));
    const auto u = load(z[p]);
    const auto v = product(level, z, p);
    store(q[p], v);
    dots += low(u) * low(v) + high(u) * high(v);
  }
  return sum_of(dots);
}

template <class Real>
void combine(Real factor, const Six<Real>* x, Real other, Six<Real>* y, Range range) {
  for (std::size_t node = range.begin; node < range.end; ++node) {
    store(y[node], factor * load(x[node]) + other * load(y[node]));
  }
}

constexpr Sweeps kSweeps = {.relax_first = relax_first, .relax = relax};

constexpr Rounding kRounding = {
    .round = round, .prolong = prolong_rough, .leave = leave, .add = add};

template <class Real>
constexpr Kernels<Real> kAll = {.restrict_to = restrict_to<Real>,
                                .prolong = prolong<Real>,
                                .apply_cluster = apply_cluster<Real>,
                                .dot_same = dot_same<Real>,
                                .combine = combine<Real>,
                                .apply_finest = apply<Real>,
                                .compare_finest = compare<Real>,
                                .advance_finest = advance_by_product<Real>,
                                .advance = advance<Real>,
                                .dot = dot<Real>,
                                .dot_split = dot_split<Real>};

}  // namespace

// NOLINTEND(google-build-namespaces,misc-definitions-in-headers)
}  // namespace holdfast::solver
