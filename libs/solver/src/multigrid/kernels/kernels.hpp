// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "multigrid/kernels/seats.hpp"
#include "multigrid/kernels/split_numbers.hpp"
#include "multigrid/kernels/vectors.hpp"

/// The loops over nodes in which all time is spent. They are compiled for the machine that the
/// compiler aims at, for AVX2 and for AVX-512, from the same code without fused multiply-add, so
/// the bits are the same.
namespace holdfast::solver {

/// Longest beam, pitches; longer straight runs keep nodes in between.
inline constexpr int kBeamLengthMax = 32;

/// A level in compressed rows; equal blocks are stored once.
template <class Real>
struct ClusterView;

/// The beams of a finest level by node and direction: all one pitch long, or along the axes and as
/// long as each node's kind says.
struct StencilView {
  const std::int32_t* other = nullptr;  ///< [node * 2 * pair_count + direction]
  std::size_t pair_count = 0;           ///< Of opposite directions.
  const PairRow<float>* rows = nullptr;
  const PairRow<double>* rows_double = nullptr;
  // Along the axes, instead of these:
  const std::uint32_t* kind = nullptr;    ///< By node; null if every beam is one pitch long.
  const BeamLengths* lengths = nullptr;   ///< By kind.
  const BeamRow<float>* beams = nullptr;  ///< [direction * (kBeamLengthMax + 1) + length]
  const BeamRow<double>* beams_double = nullptr;
  const MiddleSpring* springs = nullptr;  ///< [axis * (kBeamLengthMax + 1) + length]; by kind only.

  bool is_along_axes() const { return beams != nullptr; }
};

/// A level with blocks of K.
template <>
struct ClusterView<float> {
  const std::int32_t* start = nullptr;
  const std::int32_t* other = nullptr;
  const std::uint32_t* type = nullptr;
  const Block<float>* inverse = nullptr;
  const std::uint32_t* block = nullptr;
  const Block<float>* blocks = nullptr;
  const Block<float>* diagonal = nullptr;
  const Block<double>* blocks_double = nullptr;  ///< These two of the finest level only.
  const Block<double>* diagonal_double = nullptr;
  StencilView stencil = {};  ///< Instead of blocks K_pq, if it has any neighbours.
};

/// Marks a spring, by its highest bit, as the one that the other end has.
inline constexpr std::uint32_t kFarEnd = 1U << 31U;

/// A level with springs. Both ends of a spring mean the one of the end that comes first, which is
/// that of the lower rank between two.
template <>
struct ClusterView<double> {
  const std::int32_t* start = nullptr;
  const std::int32_t* other = nullptr;
  const std::uint32_t* type = nullptr;
  const std::uint32_t* spring = nullptr;  ///< Index of it, and kFarEnd.
  const BodySpring* springs = nullptr;
  const Block<double>* ground = nullptr;  ///< Of the types from free_type_count on.
  std::size_t free_type_count = 0;
  StencilView stencil = {};  ///< Instead of springs, if it is along the axes.
};

/// What leads from a level to the next coarser one.
template <class Real>
struct TransferView {
  const SeatCode* seat = nullptr;
  const Offset<Real>* offset = nullptr;  ///< By their numbers.
  const std::int32_t* start = nullptr;   ///< Of each cluster's members, along the Morton curve.
  const std::int32_t* member = nullptr;

  /// The vector from the centre of its cluster to a node, mm.
  const Real* offset_of(std::size_t node) const { return offset[seat[node].place].data(); }
};

struct Range {
  std::size_t begin = 0;
  std::size_t end = 0;
};

/// Gauss-Seidel, in single precision.
struct Sweeps {
  /// z = K_pp^-1 r: relaxation from zero.
  void (*relax_first)(const std::uint32_t* type, const Block<float>* inverse, const Six<float>* r,
                      Six<float>* z, Range);
  /// z_p = K_pp^-1 (r_p - sum of K_pq z_q), nodes of one colour.
  void (*relax)(const ClusterView<float>&, const Six<float>* r, Six<float>* z, Range);
};

/// What leads from double precision to sweeps in single, and back.
struct Rounding {
  void (*round)(const Six<double>* r, Six<float>* rounded, Range);
  /// z = rough + the rigid motion of the cluster.
  void (*prolong)(const TransferView<double>&, const Six<double>* coarse, const Six<float>* rough,
                  Six<double>* z, Range);
  /// r - K z, rounded.
  void (*leave)(const ClusterView<double>&, const Six<double>* r, const Six<double>* z,
                Six<float>* rounded, Range);
  /// z += rough; returns r . z.
  double (*add)(const Six<float>* rough, const Six<double>* r, Six<double>* z, Range);
};

template <class Real>
struct Kernels {
  using Vector = Six<Real>;
  using Cluster = ClusterView<Real>;
  using Transfer = TransferView<Real>;

  /// Forces that a sweep's z left over, gathered at the clusters' centres; nodes from `settled` on
  /// have none.
  void (*restrict_to)(const Cluster&, const Transfer&, std::size_t settled, const Vector* r,
                      const Six<float>* z, Vector* coarse, Range clusters);
  /// z += the rigid motion of the cluster.
  void (*prolong)(const Transfer&, const Vector* coarse, Vector* z, Range);
  /// q = K z on a coarse level; returns z . q.
  double (*apply_cluster)(const Cluster&, const Vector* z, Vector* q, Range);
  /// a . b, summed in double precision.
  double (*dot_same)(const Vector* a, const Vector* b, Range);
  /// y = factor x + other y
  void (*combine)(Real factor, const Vector* x, Real other, Vector* y, Range);
  /// q = K p in double precision; returns p . q.
  double (*apply_finest)(const Cluster&, const Vector* p, double* q, Range);
  /// z . K z and p . K z, in double precision.
  std::array<double, 2> (*compare_finest)(const Cluster&, const Vector* z, const Vector* p, Range);
  /// x += step p, r -= step K p; returns p . K p.
  double (*advance_finest)(const Cluster&, double step, const Vector* p, double* x,
                           SplitView<Real> r, Range);
  /// x += step p, r -= step q
  void (*advance)(double step, const Vector* p, const double* q, double* x, SplitView<Real> r,
                  Range);
  /// q . z and r . z, in double precision.
  double (*dot)(const double* q, const Vector* z, Range);
  double (*dot_split)(SplitView<Real> r, const Vector* z, Range);
};

/// The kernels for this machine.
const Sweeps& sweeps();
const Rounding& rounding();
template <class Real>
const Kernels<Real>& kernels();

template <>
const Kernels<float>& kernels<float>();
template <>
const Kernels<double>& kernels<double>();

}  // namespace holdfast::solver
