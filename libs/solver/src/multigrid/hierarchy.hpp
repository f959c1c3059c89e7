// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "block_pool.hpp"
#include "holdfast/base/algebra.hpp"
#include "holdfast/model/material.hpp"
#include "holdfast/solver/block_lu.hpp"
#include "kernels.hpp"
#include "network.hpp"
#include "team.hpp"

/// The levels of the preconditioner: ever larger clusters of modules that move as rigid bodies.
///
/// A level is a set of nodes with springs between them. A spring S_pq acts at p on the difference of
/// the motion of p and that of q carried over to p as a rigid body:
///   K_pp = sum of S_pq + springs to the ground,   K_pq = -S_pq T(x_p - x_q),   T(a): u + t x a, t
/// On the finest level S_pq = K11 of the beam. The next level's nodes are the connected parts of
/// the robot within cells twice as wide; its springs are the sums of those between its members,
/// carried to the clusters' centres, times
///   length of the spring / (length + what lies behind it up to the centres),
/// because a cluster is not rigid in truth: what a rigid cluster leaves to the spring alone, the
/// modules behind it share. Without that factor every level is about twice as stiff as the one
/// below and the coarse corrections are too small [Braess 1995].
namespace holdfast::solver {

using Mat = base::Mat6<double>;

/// A spring to something that does not move: the ground, a fixed module.
struct Anchor {
  std::int32_t node = 0;
  std::uint8_t direction = 0;
  double length = 0;  ///< mm
  Mat stiffness;      ///< At the node.
};

struct Level {
  std::size_t node_count = 0;
  std::vector<std::size_t> colour_start;
  // Springs, compressed rows; the finest level keeps them in Network instead.
  std::vector<std::int32_t> start;
  std::vector<std::int32_t> other;
  std::vector<std::uint32_t> block;
  BlockPool blocks;
  // K_pp and its inverse.
  std::vector<std::uint32_t> type;
  std::vector<Block> diagonal;
  std::vector<Block> inverse;
  // To the next level; empty on the coarsest.
  std::vector<Seat> seat;
  std::vector<std::int32_t> member_start;
  std::vector<std::int32_t> member;
  // Vectors of the cycle, one node more than there are, which stays zero.
  std::vector<Six> r;
  std::vector<Six> z;

  ClusterView view() const;
  TransferView transfer() const;
};

struct HierarchyOptions {
  double correction = 1;  ///< Multiplies the factor above.
  std::size_t coarsest_count = 48;
};

class Hierarchy {
 public:
  Hierarchy(const Network& network, const model::Material& material, Team& team,
            const HierarchyOptions& options = {});

  std::vector<Level>& levels() { return levels_; }
  const LatticeView& lattice() const { return lattice_; }
  /// Factorized coarsest level.
  const BlockLu& coarsest() const { return *coarsest_; }
  std::size_t bytes() const;

 private:
  void make_lattice(const Network& network, const model::Material& material);

  std::vector<Level> levels_;
  LatticeView lattice_;
  std::vector<BeamRow> beams_;
  std::vector<BeamRowDouble> beams_double_;
  std::vector<BlockDouble> diagonal_double_;
  std::optional<BlockLu> coarsest_;
};

}  // namespace holdfast::solver
