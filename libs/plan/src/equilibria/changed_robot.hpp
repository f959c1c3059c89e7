// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <functional>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "equilibria/new_modules.hpp"
#include "equilibria/solved_core.hpp"
#include "holdfast/mechanics/ground_contact.hpp"

namespace holdfast::plan {

/// Contact states by facet.
using ContactStates = std::vector<mechanics::ContactState>;

/// Follows the path of a check, Newton's method over contact states: `next(states)` solves for
/// states and returns those that the solution prescribes, none if these are not certain. Returns
/// the states that prescribe themselves; none if the path comes back to where it was, or is longer
/// than `step_max`.
template <class Next>
std::optional<ContactStates> settled_states(ContactStates states, std::size_t step_max,
                                            const Next& next) {
  std::vector<ContactStates> seen;
  for (std::size_t step = 0; step < step_max; ++step) {
    std::optional<ContactStates> prescribed = next(states);
    if (!prescribed || *prescribed == states) {
      return prescribed;
    }
    if (std::ranges::find(seen, *prescribed) != seen.end()) {
      return std::nullopt;
    }
    seen.push_back(*prescribed);
    states = *std::move(prescribed);
  }
  return std::nullopt;
}

/// The state that a law prescribes for a trial force on a facet; none if the last digits of the
/// force could change it. `scale_n`: how large all loads are together.
std::optional<mechanics::ContactState> certain_state(const solver::FacetLaw<double>& law,
                                                     const solver::FacetState& facet,
                                                     const base::Vec6<double>& trial,
                                                     double scale_n);

/// The share by which a force that decides may be off.
inline constexpr double kForceShare = 1e-6;

/// What a robot has besides its core, or lacks.
struct Change {
  std::vector<PointLoad> loads = {};               ///< On modules of the core.
  std::vector<base::Vec6<double>> new_loads = {};  ///< By new module.
  std::vector<Link> links = {};                    ///< From modules of the core to new ones.
  std::vector<model::Connection> beams = {};       ///< Between new modules.
  /// Facets of new modules, all of them stuck; `module` is a place among the new ones.
  std::vector<solver::FacetState> facets = {};
  std::vector<model::Connection> lost_beams = {};  ///< Of the core.
  std::vector<std::size_t> lost_facets = {};       ///< Of the core; their states are void.
  /// Sees to it that the core knows its answers to loads on these of its modules; false if it
  /// cannot. Empty: it knows them.
  std::function<bool(std::span<const std::size_t>)> find_answers = {};
};

/// A changed robot in equilibrium, its facets in given states.
struct Changed {
  ContactStates states = {};  ///< Of the core's facets, then of those of new modules.
  /// The core moves by its own loads and these as it does in the changed robot.
  std::vector<PointLoad> loads = {};
  std::vector<base::Vec6<double>> trials = {};  ///< By facet, the trial force.
  NewModules new_modules = {};
  std::size_t yielding_count = 0;  ///< Components of facets' forces that the core's have not.
};

/// A robot that differs little from one that was solved, its *core*: other loads, new modules,
/// facets in other contact states, beams and facets that are lost. All of that are forces on few of
/// the core's modules, each of which follows from how far these move, and the core answers to them,
///   x = c - D u,   u = u_0 + G x,
/// a small dense system. Along a component of a facet in state s instead of s_0 the force x is
/// -(corrector(s) - corrector(s_0)) times the trial force, corrector(s) of a lost facet being 0;
/// links to new modules as NewModules says. A lost beam's force is put on its ends against itself.
/// Contact states are sought by Newton's method from all stuck, as a check does, or another
/// solution may be found than the check's. Keeps references; const members may be called by several
/// threads if those of the core may.
class ChangedRobot {
 public:
  /// `scale_n`: how large all loads are together.
  ChangedRobot(const SolvedCore& core, const Change& change, double scale_n)
      : core_(core), change_(change), scale_n_(scale_n) {}

  /// Solves with facets in these states, whatever states that prescribes. No states: those of the
  /// core, and of new modules all stuck; what facets do is then not looked at. None if the core
  /// does not know some answer.
  std::optional<Changed> solve(const ContactStates& states) const;

  /// Solves in the states that prescribe themselves where a check's path ends; none if it does not
  /// end, or not for certain there.
  std::optional<Changed> settle() const;

  /// Whether the law may have other solutions beside one that was settled. If a facet that may have
  /// a second state comes back at once when it is put there, it has not.
  bool may_have_others(const Changed& settled) const;

  /// A facet of the core or, behind these, of a new module.
  const solver::FacetState& facet(std::size_t index) const {
    const std::size_t count = core_.facets().size();
    return index < count ? core_.facets()[index] : change_.facets[index - count];
  }

 private:
  class System;

  bool is_lost(std::size_t facet) const {
    return std::ranges::find(change_.lost_facets, facet) != change_.lost_facets.end();
  }

  std::optional<ContactStates> prescribed(const Changed& changed) const;
  base::Vec6<double> displacement(std::size_t module, const std::vector<PointLoad>& loads) const;
  std::vector<base::Vec6<double>> trial_forces(const Changed& changed) const;

  const SolvedCore& core_;
  const Change& change_;
  double scale_n_;
};

}  // namespace holdfast::plan
