// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "equilibria/changed_robot.hpp"
#include "equilibria/site.hpp"
#include "holdfast/model/robot.hpp"

namespace holdfast::plan {

/// What the facets of a grown robot say besides the loads.
struct Footing {
  bool is_certain = true;  ///< False: a check has to say what becomes of it.
  bool is_slipping = false;
};

/// A grown robot in equilibrium with its contact states.
struct Grown {
  std::vector<PointLoad> loads = {};  ///< As of Changed.
  NewModules new_modules = {};
  std::size_t yielding_count = 0;  ///< As of Changed.
  Footing footing = {};
  bool is_settled = false;  ///< By the path; else all facets were taken to be stuck.
};

/// A robot with a new module at one site after another, as a ChangedRobot of the robot without.
/// Keeps references; const members may be called by several threads.
class GrownContact {
 public:
  using Vec = base::Vec6<double>;

  /// `core` is the robot, all its facets stuck.
  GrownContact(const model::Robot& robot, const model::Touch& floor, const SolvedCore& core,
               bool is_bonded);

  /// The loads while all facets are stuck.
  std::optional<Grown> stuck(const Site& site) const;

  /// What facets that move with the modules' `displacement(module)` and the new one say, but for
  /// `lost` ones; certain only if all of them are stuck.
  template <class Displacement>
  Footing footing_if_stuck(const Site& site, const Vec& new_module,
                           const Displacement& displacement,
                           std::span<const std::size_t> lost = {}) const;

  /// The loads in the contact states where the path ends; none if it does not end, or not for
  /// certain as that of a check. A site without links: the robot without a new module. `core`
  /// answers to loads on facets as well.
  std::optional<Grown> settle(const Site& site, const SolvedCore& core) const;

 private:
  bool sticks_by_far(const Vec& trial) const;
  void look_at_own(const Site& site, const Vec& new_module, Footing& footing) const;
  void look_if_stuck(const solver::FacetState& facet, std::optional<double> friction,
                     const Vec& trial, Footing& footing) const;
  void look_at(const solver::FacetState& facet, std::optional<double> friction, const Vec& trial,
               Footing& footing) const;
  bool is_on_flat_floor(const Site& site) const;
  Footing footing_of(const Site& site, const ChangedRobot& grown, const Changed& settled) const;
  solver::FacetState own_facet() const;
  Change change_at(const Site& site) const;

  const model::Robot& robot_;
  const SolvedCore& core_;
  bool is_bonded_ = false;
  bool is_flat_ = true;  ///< But for the facets of new modules.
  bool is_held_ = false;
  model::Touch floor_;
  Vec load_{};          ///< Of the new module.
  double scale_n_ = 0;  ///< All loads together.
};

template <class Displacement>
Footing GrownContact::footing_if_stuck(const Site& site, const Vec& new_module,
                                       const Displacement& displacement,
                                       std::span<const std::size_t> lost) const {
  Footing footing = {};
  const auto facets = core_.facets();
  for (std::size_t i = 0; !is_bonded_ && i < facets.size(); ++i) {
    if (std::ranges::find(lost, i) != lost.end()) {
      continue;
    }
    look_if_stuck(facets[i], robot_.facets()[i].touch.friction,
                  core_.law().trial_force(facets[i], displacement(facets[i].module)), footing);
  }
  look_at_own(site, new_module, footing);
  return footing;
}

}  // namespace holdfast::plan
