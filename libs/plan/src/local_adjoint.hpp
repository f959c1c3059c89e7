// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <unordered_map>
#include <vector>

#include "beam_blocks.hpp"
#include "holdfast/model/lattice_beam.hpp"
#include "holdfast/model/robot.hpp"
#include "holdfast/solver/block_lu.hpp"

namespace holdfast::plan {

/// What is known of a facet from the modules near it: how little its force changes where something
/// changes far away.
///
/// Let q u be a component of the facet's force for displacements u, and z the displacements under
/// the load q. Take z' that is in equilibrium on a patch of modules around the facet, and zero
/// beyond. What it leaves unbalanced at the patch's rim is carried to supports there by forces s,
/// so that |z - z'| <= |s| in the energy norm. For displacements u' of equations whose residual
/// does not touch the patch, q (u - u') = (z - z') K (u - u'): of the order of |s| |u - u'| instead
/// of |z| |u - u'| [Prager 1947].
struct LocalAdjoint {
  using Vec = base::Vec6<double>;

  /// What each module of the region hands on: to its neighbour in a direction, or to its first
  /// facet if that is none. For fz and the torques mx and my of the facet: the force in the middle,
  /// each component over the root of its stiffness.
  struct Way {
    int down = -1;
    std::array<Vec, 3> force{};
  };

  /// What does not depend on where the facet is.
  struct Forces {
    std::vector<Way> ways;         ///< By module of the region.
    std::array<double, 9> gram{};  ///< <s_i, s_k>, by rows.

    /// |s| for the combination of fz and torques with these factors.
    double norm(const std::array<double, 3>& factors) const;
  };

  std::vector<std::size_t> patch;        ///< Modules where z' is not zero.
  std::vector<std::size_t> region;       ///< Those and the rim: s is nowhere else.
  std::shared_ptr<const Forces> forces;  ///< Shared by all facets with such a neighbourhood.
};

/// Finds them, each kind of neighbourhood once. May be shared by threads.
class LocalAdjoints {
 public:
  /// Keeps a reference to the robot, of which any connected part may be asked for.
  explicit LocalAdjoints(const model::Robot& target);

  /// Of a facet of a part of the target; `is_there` by module.
  LocalAdjoint find(const model::Facet& facet,
                    const std::function<bool(std::size_t)>& is_there) const;

 private:
  struct Region;

  /// The region's modules, nearest to a support first, and in which direction it lies.
  struct Ways {
    std::vector<std::size_t> order;
    std::vector<int> down;
  };

  Region region_around(const model::Facet& facet,
                       const std::function<bool(std::size_t)>& is_there) const;
  LocalAdjoint::Forces solve(const model::Facet& facet, const Region& region) const;
  std::optional<solver::BlockLu> patch_equations(const Region& region) const;
  std::optional<std::vector<std::vector<base::Vec6<double>>>> balance_patch(
      const model::Facet& facet, const Region& region) const;
  std::vector<base::Vec6<double>> residual(const Region& region,
                                           const std::vector<base::Vec6<double>>& z) const;
  Ways ways_to_supports(const Region& region) const;
  std::vector<base::Vec6<double>> carry(const Region& region, const Ways& ways,
                                        std::vector<base::Vec6<double>> loads) const;

  const model::Robot& target_;
  model::LatticeBeam<double> beam_;
  BeamBlocks blocks_;
  base::Vec6<double> stiffness_{};          ///< Of the springs in the middle.
  std::vector<base::Vec6<double>> places_;  ///< Nodes, mm; the last three are 0.
  std::vector<std::size_t> first_facet_;    ///< By module.
  mutable std::mutex mutex_;
  /// By neighbourhood.
  mutable std::unordered_map<std::string, std::shared_ptr<const LocalAdjoint::Forces>> known_;
};

}  // namespace holdfast::plan
