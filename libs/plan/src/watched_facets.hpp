// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <vector>

#include "grown_adjoint.hpp"
#include "holdfast/model/lattice_beam.hpp"
#include "holdfast/model/robot.hpp"
#include "holdfast/plan/element_set.hpp"
#include "local_balance.hpp"

namespace holdfast::plan {

/// Facets of a growing robot whose adjoints are known, and what these say of displacements, which
/// is found when it is asked for, as few of them are at a time.
class WatchedFacets {
 public:
  using Vec = base::Vec6<double>;

  /// Keeps a reference to the robot, all modules of which are there in the end.
  explicit WatchedFacets(const model::Robot& target);

  /// What an adjoint says of a facet.
  struct Answer {
    const GrownAdjoint* adjoint = nullptr;
    std::size_t count = 0;  ///< The modules beyond its core, of which the first so many
    std::size_t still = 0;  ///< were there when the robot was solved.
    double moved = 0;       ///< As of improve().
    bool is_fine = false;   ///< What that does to the force is known, but for what is left out.
    GrownAdjoint::Triple force{};  ///< fz, mx and my.

    /// How far a combination of these is off, at most, where the displacements are so far off.
    double error(const GrownAdjoint::Triple& factors, double energy_error) const {
      const double by_motion =
          is_fine ? adjoint->error_of_moved(factors) : adjoint->error(factors, still);
      return adjoint->error(factors, count) * energy_error + by_motion * moved;
    }
  };

  /// Watches these and no others, from the next begin() on; until then they may still grow.
  void take(const GrownAdjoints& adjoints);

  /// Whether a facet has been asked for since take().
  bool has_asked_for(std::size_t facet) const;

  /// The robot with these modules was solved, with these displacements, by module of the target.
  void begin(const std::vector<Element>& elements, const std::vector<Vec>& u);

  /// A module was attached.
  void attach(std::size_t module) { attached_.push_back(module); }

  /// The robot that is there now has got better displacements: modules that were there when it was
  /// solved have moved so far since, in the energy norm.
  void improve(double moved);

  /// For displacements u: those of the solved robot, or the better ones, and of the modules that
  /// have been attached since. None if the facet is not watched, or the robot does not grow the way
  /// its adjoint has grown.
  std::optional<Answer> find(std::size_t facet, const std::vector<Vec>& u);

  /// After find(), for the same u: the same nearer, by a sum over modules beyond the core. None if
  /// find() has none, or nothing has moved, so that it is the same.
  std::optional<Answer> find_finer(std::size_t facet, const std::vector<Vec>& u);

 private:
  struct Watched {
    std::shared_ptr<const GrownAdjoint> adjoint;
    bool is_asked_for = false;
    bool has_begun = false;        ///< Since the robot was solved.
    bool is_void = false;          ///< Until then.
    bool is_settled = false;       ///< `force` is by the last displacements.
    std::size_t begin_count = 0;   ///< The modules beyond its core when the robot was solved,
    std::size_t attached = 0;      ///< and how many of attached_ there are in `force`.
    GrownAdjoint::Triple first{};  ///< The force when the robot was solved.
    GrownAdjoint::Triple force{};
    /// Beyond find(), for the last displacements.
    std::optional<GrownAdjoint::Triple> finer = {};
  };

  Watched* find_watched(std::size_t facet);
  Answer answer(const Watched& watched) const;
  void begin(Watched& watched);
  bool goes_on(Watched& watched, std::size_t attached) const;
  void find_rest();
  void pull(std::size_t module, base::Direction direction, std::size_t other);

  const model::Robot* target_;
  model::LatticeBeam<double> beam_;
  LocalBalance there_;  ///< When the robot was solved.
  std::vector<Watched> watched_;
  std::vector<Element> elements_;      ///< When the robot was solved,
  std::vector<Vec> u_;                 ///< its displacements,
  std::vector<Vec> rest_;              ///< and f - K u; empty: not yet asked for.
  double moved_ = 0;                   ///< As of improve().
  std::vector<std::size_t> attached_;  ///< Since then.
  std::size_t settled_count_ = 0;      ///< So many of these have the better displacements.
};

}  // namespace holdfast::plan
