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
    std::size_t count = 0;        ///< The modules beyond its core.
    GrownAdjoint::Triple work{};  ///< GrownAdjoint::work().

    double error(const GrownAdjoint::Triple& factors) const {
      return adjoint->error(factors, count);
    }
  };

  /// Watches these and no others, from the next begin() on; until then they may still grow.
  void take(const GrownAdjoints& adjoints);

  /// Whether a facet has been asked for since take().
  bool has_asked_for(std::size_t facet) const;

  /// The robot with these modules was solved.
  void begin(const std::vector<Element>& elements);

  /// A module was attached.
  void attach(std::size_t module) { attached_.push_back(module); }

  /// The robot that is there now has got better displacements.
  void improve();

  /// For displacements u: those of the solved robot, or the better ones, and of the modules that
  /// have been attached since. None if the facet is not watched, or the robot does not grow the way
  /// its adjoint has grown.
  std::optional<Answer> find(std::size_t facet, const std::vector<Vec>& u);

 private:
  struct Watched {
    std::shared_ptr<const GrownAdjoint> adjoint;
    bool is_asked_for = false;
    bool has_begun = false;       ///< Since the robot was solved.
    bool is_void = false;         ///< Until then.
    bool has_rest = false;        ///< Of the last displacements.
    std::size_t begin_count = 0;  ///< The modules beyond its core when the robot was solved,
    std::size_t attached = 0;     ///< and how many of attached_ there are in work.
    GrownAdjoint::Triple work{};
  };

  void begin(Watched& watched) const;
  bool goes_on(Watched& watched, std::size_t attached) const;
  void find_rest(const std::vector<Vec>& u);
  void pull(std::size_t module, base::Direction direction, std::size_t other,
            const std::vector<Vec>& u);

  const model::Robot* target_;
  model::LatticeBeam<double> beam_;
  LocalBalance there_;  ///< Who has the last displacements.
  std::vector<Watched> watched_;
  std::vector<Element> elements_;      ///< When the robot was solved.
  std::vector<std::size_t> attached_;  ///< Since then.
  std::size_t settled_count_ = 0;      ///< So many of these have the better displacements.
  std::vector<Vec> rest_;              ///< f - K u of the last displacements; empty: not yet asked.
};

}  // namespace holdfast::plan
