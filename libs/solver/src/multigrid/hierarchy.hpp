// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <unordered_map>
#include <vector>

#include "anchors.hpp"
#include "coarsening.hpp"
#include "holdfast/model/material.hpp"
#include "holdfast/solver/block_lu.hpp"
#include "level.hpp"

/// The levels of the preconditioner: ever larger clusters of modules that move as rigid bodies.
///
/// A level is a set of nodes with springs between them (springs.hpp). On the finest level the
/// spring of a beam is its K11. The next level's nodes are the connected parts of the robot within
/// cells twice as wide; its springs are the sums of those between its members, carried to the
/// clusters' centres and lengthened to reach from centre to centre. That is because a cluster is
/// not rigid in truth: what rigid clusters would leave to the springs between them alone, the
/// modules behind share. Without it every level is about twice as stiff as the one below, and its
/// corrections are too small [Braess 1995].
namespace holdfast::solver {

class Hierarchy {
 public:
  /// Keeps references to the network and the material.
  Hierarchy(const Network& network, const model::Material& material, Team& team,
            GroundStiffness ground);

  /// Takes over changed contact: the same levels, held in another way.
  void update_contact();

  std::vector<Level>& levels() { return levels_; }

  const LatticeView& lattice() const { return lattice_; }

  /// False if the finest level is the only one, or clusters stopped growing early.
  bool has_coarsest() const { return coarsest_.has_value(); }

  /// Factorized coarsest level.
  const BlockLu& coarsest() const { return *coarsest_; }

 private:
  struct HeldNode {
    std::size_t node = 0;
    Mat spring_sum;  ///< K_pp without anchors.
    Mat sum = {};    ///< With them.
  };

  /// Nodes of a coarse level that have anchors. Their blocks come after those of all others.
  struct Held {
    std::size_t free_type_count = 0;
    std::vector<HeldNode> nodes;
  };

  void make_lattice();
  void point_at_lattice();
  void set_type(std::size_t node);
  void fill_stage(Team& team, Stage& stage) const;
  Mat diagonal(const Kind& kind) const;
  void add_level(const Stage& stage, std::vector<std::size_t> colour_start);
  Held held_nodes(const Stage& stage, const std::vector<Anchor>& anchors) const;
  void set_anchors(std::size_t depth, const std::vector<Anchor>& anchors);
  void try_to_factor(const Stage& stage);
  bool factor_coarsest();

  const Network& network_;
  const model::Material& material_;
  GroundStiffness ground_;
  std::unordered_map<std::uint64_t, std::uint32_t> type_of_kind_;
  std::vector<Level> levels_;
  std::vector<Held> held_;  ///< By level, from the second on.
  LatticeView lattice_;
  std::vector<BeamRow> beams_;
  std::vector<BeamRowDouble> beams_double_;
  std::vector<BlockDouble> diagonal_double_;
  std::optional<BlockLu> coarsest_;
};

}  // namespace holdfast::solver
