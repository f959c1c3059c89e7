// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "holdfast/model/material.hpp"
#include "holdfast/solver/block_lu.hpp"
#include "multigrid/coarsening/coarsening.hpp"
#include "multigrid/coarsening/ground_springs.hpp"
#include "multigrid/coarsening/level.hpp"
#include "multigrid/hierarchy/cycle_vectors.hpp"

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

template <class Real>
class Hierarchy {
 public:
  /// Keeps references to the network, the material and the table of what facets are. Nodes that are
  /// `alone` join no cluster. Of a whole robot takes the network's order and keys away.
  Hierarchy(ReducedNetwork& network, const model::Material& material, Team& team,
            const GroundTable& ground, std::span<const std::int32_t> alone);

  /// Takes over changed contact: the same levels, held in another way.
  void update_contact();

  std::vector<Level<Real>>& levels() { return levels_; }

  /// Takes the memory of all vectors that a cycle needs, unless they have it.
  void take_vectors() { vectors_.take(levels_); }

  /// Gives back the memory of all vectors but the finest level's r.
  void drop_vectors() { vectors_.drop(levels_); }

  /// Gives back the memory of all levels.
  void drop_levels() {
    levels_.clear();
    vectors_ = {};
  }

  /// Who shares a level, each with a part.
  host::Ranks& ranks(std::size_t depth) const {
    return depth < gathered_depth_ ? network_.ranks.get() : host::single_rank();
  }

  /// Gives copies on a level what their originals have.
  template <class Item>
  void update_copies(std::size_t depth, std::span<Item> items) {
    levels_[depth].halo->update(items.data(), sizeof(Item));
  }

  /// Gives copies of one colour what their originals have.
  template <class Item>
  void update_copies(std::size_t depth, std::size_t colour, std::span<Item> items) {
    if (!levels_[depth].halo_of_colour.empty()) {
      levels_[depth].halo_of_colour[colour]->update(items.data(), sizeof(Item));
    }
  }

  /// q = K p on the finest level, in double precision; returns p . q.
  double apply(const Six<Real>* p, double* q, const Range& range) const {
    return kernels<Real>().apply_finest(levels_.front().view(), p, q, range);
  }

  /// z . K z and p . K z there.
  std::array<double, 2> compare(const Six<Real>* z, const Six<Real>* p, const Range& range) const {
    return kernels<Real>().compare_finest(levels_.front().view(), z, p, range);
  }

  /// x += step p, r -= step K p there; returns p . K p.
  double advance(double step, const Six<Real>* p, double* x, SplitView<Real> r,
                 const Range& range) const {
    return kernels<Real>().advance_finest(levels_.front().view(), step, p, x, r, range);
  }

  /// Whether there are more levels than the finest, and clusters did not stop growing early.
  bool has_coarsest() const { return coarsest_.has_value(); }

  /// Whether a level was found that is a chain of thousands of clusters.
  bool is_too_slender() const { return is_too_slender_; }

  /// Whether, in the facets' present states, a node or a cluster is held by nothing.
  bool is_singular() const { return is_singular_; }

  /// Factorized coarsest level.
  const BlockLu& coarsest() const { return *coarsest_; }

 private:
  struct HeldNode {
    std::size_t node = 0;
    std::size_t spring_sum = 0;  ///< Index of its K_pp without ground springs.
  };

  /// K_pp of a node that has ground springs.
  struct HeldSum {
    Mat ground;  ///< What they add to it.
    Mat all;
  };

  /// Nodes of a coarse level that have ground springs. Their blocks come after those of all others.
  struct Held {
    std::size_t free_type_count = 0;
    std::vector<HeldNode> nodes;
    std::vector<Mat> spring_sums;
    std::vector<Mat> sums;  ///< Their K_pp; of the coarsest level alone.
  };

  bool is_finest(const Level<Real>& level) const { return &level == levels_.data(); }

  void fill_graph(Team& team, ReducedNetwork& network, SpringGraph& graph) const;
  void place_nodes(Team& team, ReducedNetwork& network, SpringGraph& graph) const;
  void connect(Team& team, SpringGraph& graph) const;
  void share(const SpringGraph& graph, Level<Real>& level) const;
  void gather(SpringGraph& graph, std::vector<GroundSpring>& springs,
              std::vector<std::size_t>& colour_start);
  template <class Springs>
  void add_level(const SpringGraph& graph, const Springs& springs,
                 const std::vector<std::size_t>& colour_start);
  void couple(const SpringGraph& graph, Level<Real>& level) const;
  void clear_ground(Level<Real>& level, std::size_t free_type_count) const;
  void add_grounded_type(Level<Real>& level, const HeldSum& sum) const;
  void add_type(Level<Real>& level, const Mat& sum) const;
  void set_types(const SpringGraph& graph, Level<Real>& level) const;
  template <class Springs>
  Held held_nodes(const SpringGraph& graph, const Springs& springs) const;
  template <class Springs>
  void set_ground_springs(std::size_t depth, const Springs& springs);
  void try_to_factor(const SpringGraph& graph);
  bool factor_coarsest();

  const ReducedNetwork& network_;
  const model::Material& material_;
  const GroundTable& ground_;
  std::size_t alone_count_ = 0;  ///< Of all ranks.
  /// Levels are whole at all ranks from here on.
  std::size_t gathered_depth_ = std::numeric_limits<std::size_t>::max();
  std::vector<Level<Real>> levels_;
  CycleVectors<Real> vectors_;
  std::vector<Held> held_;  ///< By level.
  std::optional<BlockLu> coarsest_;
  bool is_too_slender_ = false;
  bool is_singular_ = false;
};

// In hierarchy_single.cpp and hierarchy_double.cpp.
template <>
void Hierarchy<float>::couple(const SpringGraph& graph, Level<float>& level) const;
template <>
void Hierarchy<float>::clear_ground(Level<float>& level, std::size_t free_type_count) const;
template <>
void Hierarchy<float>::add_grounded_type(Level<float>& level, const HeldSum& sum) const;
template <>
void Hierarchy<float>::add_type(Level<float>& level, const Mat& sum) const;
template <>
void Hierarchy<double>::add_type(Level<double>& level, const Mat& sum) const;
template <>
void Hierarchy<double>::couple(const SpringGraph& graph, Level<double>& level) const;
template <>
void Hierarchy<double>::clear_ground(Level<double>& level, std::size_t free_type_count) const;
template <>
void Hierarchy<double>::add_grounded_type(Level<double>& level, const HeldSum& sum) const;

}  // namespace holdfast::solver
