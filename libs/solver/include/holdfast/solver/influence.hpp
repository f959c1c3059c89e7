// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <span>
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

class DirectSystem;
class SelectedInverse;

/// Keeps a reference to the robot. Its const members may be called by several threads at once.
class Influence {
 public:
  using Vec = base::Vec6<double>;

  /// Factorizes a robot whose facets stick; none if that needs more memory, or fills in more, than
  /// the options allow, or double precision does not suffice for the robot.
  static std::unique_ptr<Influence> make(const model::Robot& robot,
                                         const EquilibriumOptions& options);
  ~Influence();

  /// The facets, all stuck, and what the paper's law makes of them.
  std::span<const FacetState> facets() const;
  const FacetLaw<double>& law() const;
  const model::LatticeBeam<double>& beam() const;

  /// Displacements by module under the robot's own loads, refined.
  const std::vector<Vec>& displacement() const { return displacement_; }

  /// The displacements before refinement: as far off as what solve() gives.
  const std::vector<Vec>& rough_displacement() const { return rough_; }

  /// Finds K^-1 of each of these modules and between each of these pairs of modules: between()
  /// after that.
  void find_inverse(std::span<const std::size_t> modules, std::span<const Edge> pairs,
                    int thread_count);

  /// The displacements of the first module for unit loads on the second, by column, where
  /// find_inverse() was asked for these. Zero for a fixed module.
  base::Mat6<double> between(std::size_t first, std::size_t second) const;

  /// Slots that solve() takes: slot(module) for every module, and one more.
  std::size_t slot_count() const;

  /// The slot of a module. Fixed modules share the last one.
  std::size_t slot(std::size_t module) const { return slots_[module]; }

  /// Turns loads into displacements in place; what stands in the last slot is not looked at.
  void solve(std::span<LaneBlock> by_slot) const;

 private:
  Influence();

  std::unique_ptr<DirectSystem> system_;
  std::unique_ptr<const SelectedInverse> inverse_;
  std::vector<std::size_t> slots_;
  std::vector<Vec> displacement_;
  std::vector<Vec> rough_;
};

}  // namespace holdfast::solver
