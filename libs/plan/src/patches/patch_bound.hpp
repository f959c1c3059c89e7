// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "bounds/loop_bound.hpp"
#include "holdfast/verdict/rigid_body.hpp"
#include "patches/patch_region.hpp"

namespace holdfast::plan {

/// Certifies that a robot stays safe if a module, a foot or a connection is lost, from what goes on
/// in a patch around it, without a solution of the whole.
///
/// The rest answers to a loss by displacements v, K' v = p, as of LoopBound. Two solutions of the
/// patch enclose v: displacements s that are zero outside, K' s = p on the patch; and forces t
/// within the patch that balance p, held by its feet or by one of its modules, the hub, at which
/// nothing is left but the relief of a lost module's weight, which a path of beams takes to the
/// ground. The exact change of forces lies on the sphere whose diameter joins s and t [Prager
/// 1947]: it is (s + t) / 2 but for |s - t| / 2 in the energy norm. The solver's error makes t
/// uncertain as of LoopBound.
class PatchBound {
 public:
  /// The limits and the robot, with its facets all stuck, are those of `loops`. Keeps references.
  PatchBound(const model::Robot& robot, const verdict::Assessment& solved, const LoopBound& loops,
             bool is_bonded);

  /// How many hops patches reach, one after the other until one suffices.
  static constexpr std::array kHops = {2, 3, 4};

  /// What no load ratio exceeds after a loss; none if the robot may be unsafe then.
  std::optional<double> without(const LostPart& part, int hops) const;

  /// A number that losses share whose patches are alike, which takes one factorization; none of
  /// losses that no patch knows.
  std::optional<std::size_t> pattern(const LostPart& part, int hops) const;

  /// How many patterns are cheap beside what else would have to be done for the robot, and how many
  /// losses have to share one.
  std::size_t pattern_count_max(int hops) const;
  static std::size_t sharing_min(int hops);

 private:
  using Vec = base::Vec6<double>;
  using Vecs = std::vector<Vec>;
  using Pulls = std::array<Vec, 6>;

  /// A unit of each force in the middle of a beam, as the loads at its ends that it balances.
  struct BeamPulls {
    Pulls first{};
    Pulls second{};
  };

  /// What depends on the pattern of a patch alone.
  struct Factors {
    std::optional<solver::BlockLu> closed;
    std::optional<solver::BlockLu> open;
    double units = 0;  ///< As of LoopBound; infinite if a unit cannot be balanced.
  };

  /// A loss in its patch.
  struct Case;
  struct Path;
  struct Change;

  std::optional<double> without(const LostPart& part, const Case& found) const;
  std::optional<Case> case_of(const LostPart& part, int hops, bool is_by_hub) const;
  bool is_beside_fixed(const LostPart& part) const;
  void add_pulls(const LostPart& part, Case& found) const;
  std::shared_ptr<const Factors> factors_of(const Case& found) const;
  std::shared_ptr<const Factors> factored(const Case& found) const;
  std::optional<Vecs> open_answer(const Case& found, const Factors& factors, Vecs loads) const;
  Vecs unbalanced(const Case& found, const Vecs& v, Vecs loads) const;
  bool is_balanced(const Case& found, const Vecs& v, const Vecs& loads) const;
  Change change_of(const Case& found, const Vecs& open, const Vecs& closed) const;
  void add_feet(const Case& found, const Vecs& open, const Vecs& closed, Change& change) const;
  std::optional<Path> path_of(const LostPart& part, std::size_t hub) const;
  void add_end(std::size_t module, const Vec& at_node, Path& path) const;
  double slack(const model::Facet& facet, const Vec& force) const;
  bool stays_over_polygon(const LostPart& part, double norm, double units) const;

  const model::Robot& robot_;
  const verdict::Assessment& solved_;
  const EnergyLimits& limits_;
  bool is_bonded_;
  model::LatticeBeam<double> beam_;
  BeamBlocks blocks_;
  Vec stiffness_{};
  std::vector<BeamPulls> pulls_;           ///< By direction, that of facets too.
  std::vector<std::size_t> first_facet_;   ///< By module.
  std::vector<std::int32_t> to_ground_;    ///< By module: the next one on its way to a foot.
  std::vector<std::int32_t> ground_hops_;  ///< By module; 0 where it is held.
  std::optional<verdict::ShrinkingRigidBody> shrinking_;
  std::array<double, 2> moved_{};  ///< The sum of mass times displacement, along x and y, kg mm.
  mutable std::mutex mutex_;
  mutable std::map<std::string, std::shared_ptr<const Factors>> known_;
  mutable std::size_t known_blocks_ = 0;
};

}  // namespace holdfast::plan
