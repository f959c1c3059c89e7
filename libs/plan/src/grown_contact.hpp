// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <span>
#include <vector>

#include "facet_influence.hpp"
#include "holdfast/model/robot.hpp"
#include "holdfast/solver/influence.hpp"
#include "new_node.hpp"
#include "site.hpp"

namespace holdfast::plan {

/// What the robot without the new module has to bear so that it moves as the grown one does.
struct PointLoad {
  std::size_t module = 0;
  base::Vec6<double> load{};
};

/// What the facets of a grown robot say besides the loads.
struct Footing {
  bool is_certain = true;  ///< False: a check has to say what becomes of it.
  bool is_slipping = false;
};

/// A grown robot in equilibrium with its contact states.
struct Grown {
  std::vector<PointLoad> loads;
  NewNode node;  ///< With its facet in the state found.
  Footing footing;
  bool is_settled = false;  ///< By the path; else all facets were taken to be stuck.
};

/// The half of K^-1 of modules that were asked for.
using ReachCache = std::map<std::size_t, solver::Influence::Reach>;

/// Follows, for one site after another, the path of the check over contact states: from all facets
/// stuck to those that the solution prescribes, until nothing changes. Every step is a small system
/// in what the hosts of the new module and the facets that are not stuck feel. Keeps references;
/// const members may be called by several threads.
class GrownContact {
 public:
  using Vec = base::Vec6<double>;

  GrownContact(const model::Robot& robot, const model::Touch& floor,
               const solver::Influence& influence, bool is_bonded);

  /// The loads while all facets are stuck.
  std::optional<Grown> stuck(const Site& site, ReachCache& reaches) const;

  /// What facets that move with the modules' `displacement(module)` and the new one say; certain
  /// only if all of them are stuck.
  template <class Displacement>
  Footing footing_if_stuck(const Site& site, const Vec& new_module,
                           const Displacement& displacement) const;

  /// The loads in the contact states where the path ends; none if it does not end, or not for
  /// certain as that of a check.
  std::optional<Grown> settle(const Site& site, ReachCache& reaches,
                              const FacetInfluence& facets) const;

 private:
  using States = std::vector<mechanics::ContactState>;

  /// Equilibrium for given states: t of every host, forces on yielding rows, w of every facet.
  struct Step {
    std::vector<Vec> host_loads;
    std::vector<Vec> motions;  ///< w by facet; of the new module's own behind the others.
    std::vector<PointLoad> facet_loads;
  };

  class System;

  std::optional<Step> solve(const Site& site, const NewNode& node, ReachCache& reaches,
                            const FacetInfluence* facets, const States& states) const;
  std::optional<mechanics::ContactState> certain_state(const solver::FacetState& facet,
                                                       const Vec& trial) const;
  std::optional<States> next_states(const Step& step) const;
  void look_at(const solver::FacetState& facet, std::optional<double> friction, const Vec& trial,
               Footing& footing) const;
  Footing footing_of(const States& states, const Step& step) const;
  bool may_have_others(const Site& site, const States& states, const Step& step,
                       ReachCache& reaches, const FacetInfluence& facets) const;
  solver::FacetState own_facet(const mechanics::ContactState& state) const;
  Vec own_motion(const Vec& u) const;
  NewNode make_node(const Site& site, const mechanics::ContactState& own) const;
  Grown grown(const Site& site, NewNode node, Step step, const Footing& footing) const;

  const model::Robot& robot_;
  const solver::Influence& influence_;
  bool is_bonded_ = false;
  bool is_on_flat_floor_ = true;
  bool is_held_ = false;
  model::Touch floor_;
  Vec load_{};          ///< Of the new module.
  double scale_n_ = 0;  ///< All loads together.
};

template <class Displacement>
Footing GrownContact::footing_if_stuck(const Site& site, const Vec& new_module,
                                       const Displacement& displacement) const {
  Footing footing;
  const auto look = [&](const solver::FacetState& facet, std::optional<double> friction,
                        const Vec& u) {
    const Vec trial = influence_.law().trial_force(facet, u);
    footing.is_certain =
        footing.is_certain && certain_state(facet, trial) == mechanics::ContactState{};
    look_at(facet, friction, trial, footing);
  };
  for (std::size_t i = 0; !is_bonded_ && i < influence_.facets().size(); ++i) {
    const solver::FacetState& facet = influence_.facets()[i];
    look(facet, robot_.facets()[i].touch.friction, displacement(facet.module));
  }
  if (!is_bonded_ && site.is_on_floor) {
    look(own_facet({}), floor_.friction, new_module);
  }
  return footing;
}

}  // namespace holdfast::plan
