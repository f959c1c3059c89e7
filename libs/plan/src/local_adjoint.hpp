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
/// the load q. Take z' that is in equilibrium on a patch of modules around the facet, all beyond
/// standing still, and y in equilibrium on the patch and a rim about it, as if nothing were beyond.
/// The forces of y balance q, and those of y - z', s, balance what z' leaves unbalanced at the
/// patch's rim: so |z - z'| <= |s| in the energy norm, and |s|^2 = q (y - z') is as little as such
/// forces have. For displacements u' of equations whose residual does not touch the patch,
/// q (u - u') = (z - z') K (u - u'): of the order of |s| |u - u'| instead of |z| |u - u'|
/// [Prager 1947].
struct LocalAdjoint {
  using Vec = base::Vec6<double>;

  /// Between two modules of the region.
  struct Beam {
    std::int16_t a = 0;
    std::int16_t b = 0;
    std::int16_t direction = 0;  ///< From a; even.
  };

  /// What does not depend on where the facet is.
  struct Forces {
    std::vector<Beam> beams;
    /// y - z', for fz and the torques mx and my of the facet, by module of the region.
    std::vector<std::array<Vec, 3>> moved;
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

  Region region_around(const model::Facet& facet,
                       const std::function<bool(std::size_t)>& is_there) const;
  LocalAdjoint::Forces solve(const model::Facet& facet, const Region& region) const;
  std::optional<solver::BlockLu> equations(const Region& region,
                                           const std::vector<std::int16_t>& row) const;
  std::optional<std::vector<std::vector<base::Vec6<double>>>> displacements(
      const model::Facet& facet, const Region& region, const std::vector<std::int16_t>& row) const;
  std::array<double, 9> products(const Region& region, const LocalAdjoint::Forces& forces) const;

  const model::Robot& target_;
  model::LatticeBeam<double> beam_;
  BeamBlocks blocks_;
  base::Vec6<double> stiffness_{};        ///< Of the springs in the middle.
  std::vector<std::size_t> first_facet_;  ///< By module.
  mutable std::mutex mutex_;
  /// By neighbourhood.
  mutable std::unordered_map<std::string, std::shared_ptr<const LocalAdjoint::Forces>> known_;
};

}  // namespace holdfast::plan
