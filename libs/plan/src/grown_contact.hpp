// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "contact_path.hpp"
#include "facet_influence.hpp"
#include "holdfast/model/robot.hpp"
#include "holdfast/solver/influence.hpp"
#include "new_node.hpp"
#include "site.hpp"

namespace holdfast::plan {

/// A load on one module.
struct PointLoad {
  std::size_t module = 0;
  base::Vec6<double> load{};
};

/// What the facets of a grown robot say besides the loads.
struct Footing {
  bool is_certain = true;  ///< False: a check has to say what becomes of it.
  bool is_slipping = false;
};

/// A grown robot in equilibrium with its contact states: what the robot without the new module has
/// to bear so that it moves as the grown one does.
struct Grown {
  std::vector<PointLoad> host_loads = {};  ///< By link.
  /// By facet, in its own frame, what differs from the force of one that sticks. Empty if all do.
  std::vector<base::Vec6<double>> facet_forces = {};
  const NewNode* node = nullptr;  ///< With its facet in the state found.
  Footing footing = {};
  bool is_settled = false;  ///< By the path; else all facets were taken to be stuck.
};

/// Follows, for one site after another, the path of the check over contact states: from all facets
/// stuck to those that the solution prescribes, until nothing changes. Every step is a small system
/// in what the hosts of the new module and the facets that are not stuck feel. Keeps references;
/// const members may be called by several threads.
class GrownContact {
 public:
  using Vec = base::Vec6<double>;

  /// For new modules at these sites.
  GrownContact(const model::Robot& robot, const model::Touch& floor,
               const solver::Influence& influence, bool is_bonded, std::span<const Site> sites);

  /// The loads while all facets are stuck.
  std::optional<Grown> stuck(const Site& site) const;

  /// What facets that move with the modules' `displacement(module)` and the new one say; certain
  /// only if all of them are stuck.
  template <class Displacement>
  Footing footing_if_stuck(const Site& site, const Vec& new_module,
                           const Displacement& displacement) const;

  /// The loads in the contact states where the path ends; none if it does not end, or not for
  /// certain as that of a check. A site without links: the robot without a new module.
  std::optional<Grown> settle(const Site& site, const FacetInfluence& facets) const;

 private:
  using States = ContactStates;

  /// Equilibrium for given states: t of every host, forces on yielding rows, w of every facet.
  struct Step {
    std::vector<Vec> host_loads;
    std::vector<Vec> motions;  ///< w by facet; of the new module's own behind the others.
    std::vector<Vec> facet_forces;
  };

  class System;

  std::optional<Step> solve(const Site& site, const NewNode& node, const FacetInfluence* facets,
                            const States& states) const;
  std::optional<mechanics::ContactState> certain_state(const solver::FacetState& facet,
                                                       const Vec& trial) const;
  bool sticks_by_far(const Vec& trial) const;
  std::optional<States> next_states(const Step& step) const;
  void look_at_own(const Site& site, const Vec& new_module, Footing& footing) const;
  void look_if_stuck(const solver::FacetState& facet, std::optional<double> friction,
                     const Vec& trial, Footing& footing) const;
  void look_at(const solver::FacetState& facet, std::optional<double> friction, const Vec& trial,
               Footing& footing) const;
  bool is_on_flat_floor(const Site& site) const;
  Footing footing_of(const Site& site, const States& states, const Step& step) const;
  bool may_have_others(const Site& site, const States& states, const Step& step,
                       const FacetInfluence& facets) const;
  solver::FacetState own_facet(const mechanics::ContactState& state) const;
  Vec own_motion(const Vec& u) const;
  const NewNode& node(const Site& site, const mechanics::ContactState& own) const;
  Grown grown(const Site& site, const NewNode& node, Step step, const Footing& footing) const;

  const model::Robot& robot_;
  const solver::Influence& influence_;
  bool is_bonded_ = false;
  bool is_flat_ = true;  ///< But for the facets of new modules.
  bool is_held_ = false;
  model::Touch floor_;
  Vec load_{};          ///< Of the new module.
  double scale_n_ = 0;  ///< All loads together.
  /// By directions of the links and the code of the own facet's state, -1 without one.
  std::map<std::pair<std::vector<base::Direction>, int>, NewNode> nodes_;
};

template <class Displacement>
Footing GrownContact::footing_if_stuck(const Site& site, const Vec& new_module,
                                       const Displacement& displacement) const {
  Footing footing = {};
  const auto facets = influence_.facets();
  for (std::size_t i = 0; !is_bonded_ && i < facets.size(); ++i) {
    look_if_stuck(facets[i], robot_.facets()[i].touch.friction,
                  influence_.law().trial_force(facets[i], displacement(facets[i].module)), footing);
  }
  look_at_own(site, new_module, footing);
  return footing;
}

}  // namespace holdfast::plan
