// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "holdfast/host/ranks.hpp"
#include "multigrid/kernels/kernels.hpp"

namespace holdfast::solver {

/// Blocks K_pq by edge and K_pp by type; equal ones are stored once.
struct Blocks {
  std::vector<std::uint32_t> block;
  std::vector<Block<float>> blocks;
  std::vector<Block<float>> diagonal;  ///< In single precision only.
};

/// What couples the nodes of a level.
template <class Real>
struct Couplings;

/// What the finest level has in double precision, too, as the product with K is made in that.
template <>
struct Couplings<float> {
  Blocks blocks;
  std::vector<Block<double>> blocks_double;
  std::vector<Block<double>> diagonal_double;
};

/// Springs by edge, and what holds the types from free_type_count on; blocks for the sweeps.
template <>
struct Couplings<double> {
  Blocks blocks;
  std::vector<std::uint32_t> spring;
  std::vector<BodySpring> springs;
  std::vector<Block<double>> ground;
  std::size_t free_type_count = 0;
};

/// The finest level's beams, as StencilView has them.
struct Stencil {
  const std::int32_t* other = nullptr;  ///< The network's; null if there is no stencil.
  std::size_t pair_count = 0;
  std::vector<PairRow<float>> rows = {};
  std::vector<PairRow<double>> rows_double = {};
  bool has_long_beams = false;
  const std::uint32_t* kind = nullptr;   ///< The network's.
  const BeamLengths* lengths = nullptr;  ///< The network's.
  std::vector<BeamRow<float>> beams = {};
  std::vector<BeamRow<double>> beams_double = {};
  std::vector<MiddleSpring> springs = {};

  bool is_along_axes() const { return !beams.empty(); }

  /// What the kernels see; those for springs look at the lengths of short beams, too, as missing
  /// ones have none.
  StencilView view(bool has_kinds) const {
    return {.other = other,
            .pair_count = pair_count,
            .rows = rows.data(),
            .rows_double = rows_double.data(),
            .kind = has_kinds ? kind : nullptr,
            .lengths = lengths,
            .beams = is_along_axes() ? beams.data() : nullptr,
            .beams_double = beams_double.data(),
            .springs = springs.data()};
  }
};

/// How a level that all ranks have whole, and compute alike, is connected with the one below, of
/// which each has a part.
struct Gathering {
  std::vector<std::int32_t> node;  ///< Of all ranks' clusters, in the order of the ranks.
  std::size_t first = 0;           ///< This rank's first cluster among all.
  std::size_t own_count = 0;       ///< How many it has.

  bool is_empty() const { return node.empty(); }
};

/// One level of the preconditioner.
template <class Real>
struct Level {
  std::size_t node_count = 0;   ///< Of a part of a robot this rank's own.
  std::size_t place_count = 0;  ///< With the copies of other ranks', which come after them.
  /// Keeps these up to date.
  std::unique_ptr<host::Halo> halo = std::make_unique<host::NoCopies>();
  /// The halos of one colour each; empty if there are none.
  std::vector<std::unique_ptr<host::Halo>> halo_of_colour;
  Gathering gathering;  ///< If all ranks have all of this level.
  std::vector<std::size_t> colour_start;
  // Compressed rows.
  std::vector<std::int32_t> start;
  std::vector<std::int32_t> other;
  Couplings<Real> couplings;
  Stencil stencil;
  std::vector<std::uint32_t> type;    ///< Node -> K_pp
  std::vector<Block<float>> inverse;  ///< K_pp^-1
  // To the next level; empty on the coarsest.
  Seats<Real> seat;
  std::vector<std::int32_t> member_start;  ///< By cluster, along the Morton curve.
  std::vector<std::int32_t> member;
  std::vector<Six<Real>> part;  ///< Of a gathered level: this rank's part of r, then of z.
  // Vectors of the cycle, whose memory is that of CycleVectors. Those of the finest level have one
  // node more than there are places, which stays zero.
  std::span<Six<Real>> r;
  std::span<Six<Real>> z;
  std::span<Six<Real>> first;        ///< First direction of the inner iteration, coarse levels.
  std::span<Six<Real>> first_image;  ///< K times it.

  // What the sweeps see of r and z, in double precision, where r and z are not that themselves.
  std::span<Six<float>> rough_r;
  std::span<Six<float>> rough_z;

  ClusterView<Real> view() const;

  /// What the sweeps need.
  ClusterView<float> block_view() const {
    return {.start = start.data(),
            .other = other.data(),
            .type = type.data(),
            .inverse = inverse.data(),
            .block = couplings.blocks.block.data(),
            .blocks = couplings.blocks.blocks.data(),
            .diagonal = couplings.blocks.diagonal.data(),
            .stencil = stencil.view(stencil.has_long_beams)};
  }

  TransferView<Real> transfer() const {
    return {.seat = seat.codes(),
            .offset = seat.offsets(),
            .start = member_start.data(),
            .member = member.data()};
  }
};

template <>
inline ClusterView<float> Level<float>::view() const {
  ClusterView<float> view = block_view();
  view.blocks_double = couplings.blocks_double.data();
  view.diagonal_double = couplings.diagonal_double.data();
  return view;
}

template <>
inline ClusterView<double> Level<double>::view() const {
  return {.start = start.data(),
          .other = other.data(),
          .type = type.data(),
          .spring = couplings.spring.data(),
          .springs = couplings.springs.data(),
          .ground = couplings.ground.data(),
          .free_type_count = couplings.free_type_count,
          .stencil = stencil.view(true)};
}

}  // namespace holdfast::solver
