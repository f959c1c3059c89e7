// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>

#include "vectors.hpp"

/// The loops over nodes in which all time is spent. They are compiled twice, for the machine that
/// the compiler aims at and for AVX2, from the same code without fused multiply-add, so the bits
/// are the same.
namespace holdfast::solver {

/// Longest beam, pitches; longer straight runs keep nodes in between.
inline constexpr int kBeamLengthMax = 32;

/// A robot's nodes and beams as the kernels see them.
struct LatticeView {
  const Others* other = nullptr;
  const Kind* kind = nullptr;           ///< Null if every beam is one pitch long.
  const std::uint32_t* type = nullptr;  ///< Node -> diagonal, inverse
  const BeamRow* beams = nullptr;       ///< [direction * (kBeamLengthMax + 1) + length]
  const Block* diagonal = nullptr;      ///< K_pp
  const Block* inverse = nullptr;       ///< K_pp^-1
  const BeamRowDouble* beams_double = nullptr;
  const BlockDouble* diagonal_double = nullptr;
};

/// A coarse level: compressed rows of 6x6 blocks, equal blocks stored once.
struct ClusterView {
  const std::int32_t* start = nullptr;
  const std::int32_t* other = nullptr;
  const std::uint32_t* block = nullptr;
  const Block* blocks = nullptr;
  const std::uint32_t* type = nullptr;
  const Block* diagonal = nullptr;
  const Block* inverse = nullptr;
};

/// From a level to the next coarser one.
struct TransferView {
  const Seat* seat = nullptr;
  const std::int32_t* start = nullptr;  ///< Cluster -> its first member in `member`
  const std::int32_t* member = nullptr;
};

struct Range {
  std::size_t begin = 0;
  std::size_t end = 0;
};

struct Kernels {
  /// z = K_pp^-1 r: relaxation from zero.
  void (*relax_first)(const std::uint32_t* type, const Block* inverse, const Six* r, Six* z, Range);
  /// z_p = K_pp^-1 (r_p - sum of K_pq z_q): Gauss-Seidel on nodes of one colour.
  void (*relax_lattice)(const LatticeView&, const Six* r, Six* z, Range);
  void (*relax_cluster)(const ClusterView&, const Six* r, Six* z, Range);
  /// Forces left over, gathered at the clusters' centres; nodes from `settled` on have none.
  void (*restrict_lattice)(const LatticeView&, const TransferView&, std::size_t settled,
                           const Six* r, const Six* z, Six* coarse, Range clusters);
  void (*restrict_cluster)(const ClusterView&, const TransferView&, std::size_t settled,
                           const Six* r, const Six* z, Six* coarse, Range clusters);
  /// z += the rigid motion of the cluster.
  void (*prolong)(const TransferView&, const Six* coarse, Six* z, Range);
  /// q = K z on a coarse level; returns z . q.
  double (*apply_cluster)(const ClusterView&, const Six* z, Six* q, Range);
  /// a . b in single-precision vectors, summed in double precision.
  double (*dot_single)(const Six* a, const Six* b, Range);
  /// y = factor x + other y
  void (*combine)(float factor, const Six* x, float other, Six* y, Range);
  /// q = K p in double precision; returns p . q.
  double (*apply)(const LatticeView&, const Six* p, double* q, Range);
  /// x += step p, r -= step q, and r in single precision; returns the sum of the squared
  /// forces left, torques left out.
  double (*advance)(double step, const Six* p, const double* q, double* x, double* r, Six* r_single,
                    Range);
  /// r . z, r in double precision.
  double (*dot)(const double* r, const Six* z, Range);
};

/// Those for this machine.
const Kernels& kernels();

}  // namespace holdfast::solver
