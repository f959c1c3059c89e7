// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "holdfast/base/algebra.hpp"
#include "holdfast/model/robot.hpp"
#include "holdfast/solver/block_pattern.hpp"
#include "holdfast/solver/lanes.hpp"
#include "holdfast/solver/linear_system.hpp"
#include "holdfast/solver/options.hpp"

/// What loads on single modules do to a robot, for who asks very often: K of the robot with all its
/// facets stuck, factorized once. That K is symmetric. What differs from it (facets in other
/// states, more beams) is a change of low rank, for which K^-1 between a few modules suffices.
namespace holdfast::solver {

class BlockLu;
class DirectSystem;
class SelectedInverse;

/// Between which modules K^-1 will be asked for.
struct InfluenceQuestions {
  std::span<const std::size_t> modules = {};  ///< Themselves, and those of them that are connected.
  std::span<const Edge> pairs = {};           ///< Any others of them.
  bool is_any_connected = true;  ///< False: only of `pairs` are two modules asked about.
  int thread_count = 1;
};

/// Blocks of the inverse of a robot's stiffness, between modules that were asked about.
class InverseStiffness {
 public:
  InverseStiffness(std::unique_ptr<const BlockLu> factors, const DirectSystem& system,
                   const InfluenceQuestions& questions);
  ~InverseStiffness();

  /// The displacements of the first for unit loads on the second, by column, where these are the
  /// same, connected, or a pair that was asked about. Zero for a fixed module.
  base::Mat6<double> between(std::size_t first, std::size_t second) const;

 private:
  std::unique_ptr<const BlockLu> own_;  ///< None: those of the system.
  const DirectSystem& system_;
  std::unique_ptr<const SelectedInverse> inverse_;  ///< None: all are in `pairs_`.
  std::map<std::pair<std::int32_t, std::int32_t>, base::Mat6<double>> pairs_;  ///< By nodes.
};

/// Keeps a reference to the robot. Its const members may be called by several threads at once.
class Influence {
 public:
  using Vec = base::Vec6<double>;

  /// None if the factorization needs more memory, or fills in more, than the options allow, or
  /// double precision does not suffice for the robot.
  static std::unique_ptr<Influence> make(const model::Robot& robot,
                                         const EquilibriumOptions& options);
  ~Influence();

  /// The facets, all stuck, and what the paper's law makes of them.
  std::span<const FacetState> facets() const;
  const FacetLaw<double>& law() const;
  const model::LatticeBeam<double>& beam() const;

  /// Displacements by module under the robot's own loads, refined.
  const std::vector<Vec>& displacement() const { return displacement_; }

  /// The same before refinement: as far off as what solve() gives.
  const std::vector<Vec>& rough_displacement() const { return rough_; }

  /// What the factorization took, in products of two blocks, and what a solution takes.
  std::size_t factor_product_count() const;
  double solution_product_count() const;

  /// Finds K^-1 between modules: inverse() after that.
  void find_inverse(const InfluenceQuestions& questions);

  /// K^-1 between the modules that were asked about.
  const InverseStiffness& inverse() const { return *inverse_; }

  /// The same of K with every connection's stiffness times a factor of its own; none if that is
  /// singular.
  std::unique_ptr<const InverseStiffness> inverse_of(std::span<const double> connection_factors,
                                                     const InfluenceQuestions& questions) const;

  /// Slots that solve() takes: slot(module) for every module, and one more.
  std::size_t slot_count() const;

  /// Where a module stands among the slots. Fixed modules share the last one.
  std::size_t slot(std::size_t module) const { return slots_[module]; }

  /// From loads to displacements, in place; what stands in the last slot is not looked at.
  void solve(std::span<LaneBlock> by_slot) const;

  /// The same in parts: the first gives f' K^-1 f for loads f, the others find the displacements
  /// in these slots, or in all that are left. `is_found` is empty at first; what the slots have
  /// that were not asked for is void.
  LaneNumbers begin_solution(std::span<LaneBlock> by_slot) const;
  void find_solution(std::span<LaneBlock> by_slot, std::span<const std::size_t> slots,
                     std::vector<std::uint8_t>& is_found) const;
  void end_solution(std::span<LaneBlock> by_slot, std::vector<std::uint8_t>& is_found) const;

 private:
  Influence();

  std::unique_ptr<DirectSystem> system_;
  std::unique_ptr<const InverseStiffness> inverse_;
  std::vector<std::size_t> slots_;
  std::vector<Vec> displacement_;
  std::vector<Vec> rough_;
};

}  // namespace holdfast::solver
