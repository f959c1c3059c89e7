// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
//
// Further solutions of the regularised law.
//
// A pressed facet is held sideways whatever it carries, an open one is let go. So a facet that
// hardly presses and is pulled sideways may be lifted by that pull, or by its end: pressed it stays
// pressed, opened it stays open. In standing_robot(0) to (899), where every foot was put into every
// other state and Newton's method went on from there, all further solutions were of that kind: a
// foot that tilts and is pulled sideways by more than it presses, or an open one whose spring is
// sheared by more than its gap. So only these are tried, one at a time.
#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "regularised_contact.hpp"

namespace holdfast::solver {
namespace {

/// Sideways force by pressure, or by the pull of the gap, from which on a facet is tried. The least
/// that had another solution was 1.7.
constexpr double kSlipRatio = 1;

/// Where systems are iterated each costs a few iterations: no more than this are tried, lightest
/// first.
constexpr std::size_t kTriedMaxIterated = 8;

/// Forces of mirror images differ by the solver's error.
constexpr double kAlikeShare = 1e-3;

struct Doubt {
  std::size_t facet = 0;
  double upright_n = 0;
  double sideways_n = 0;
};

bool is_alike(const Doubt& a, const Doubt& b) {
  const double margin = kAlikeShare * std::max(a.sideways_n, b.sideways_n);
  return std::abs(a.sideways_n - b.sideways_n) <= margin &&
         std::abs(a.upright_n - b.upright_n) <= margin;
}

}  // namespace

/// Facets, by index, that may have a second state; lightest for their sideways force first, and one
/// only of those that bear the same, as each other's mirror images do.
std::vector<std::size_t> RegularisedContact::doubtful_facets(const Solution& settled) const {
  std::vector<Doubt> doubts;
  for (std::size_t i = 0; i < system().facets().size(); ++i) {
    const FacetState& facet = system().facets()[i];
    const bool is_stuck = facet.state == mechanics::ContactState{};
    const Vec force = system().law().trial_force(facet, settled.displacement[facet.module]);
    const Doubt doubt = {
        .facet = i, .upright_n = std::abs(force[2]), .sideways_n = std::hypot(force[0], force[1])};
    const bool is_new =
        std::ranges::none_of(doubts, [&](const Doubt& other) { return is_alike(doubt, other); });
    if (!is_stuck && doubt.sideways_n > kSlipRatio * doubt.upright_n && is_new) {
      doubts.push_back(doubt);
    }
  }
  std::ranges::sort(doubts, {},
                    [](const Doubt& doubt) { return doubt.upright_n / doubt.sideways_n; });
  std::vector<std::size_t> indices;
  for (const Doubt& doubt : doubts) {
    indices.push_back(doubt.facet);
  }
  return indices;
}

std::vector<Solution> RegularisedContact::find_others(const Solution& settled) {
  std::vector<std::size_t> doubtful = doubtful_facets(settled);
  if (!system().is_exact() && doubtful.size() > kTriedMaxIterated) {
    doubtful.resize(kTriedMaxIterated);
  }
  const std::vector<mechanics::ContactState> states = present_states();
  std::vector<std::vector<mechanics::ContactState>> known = {states};
  std::vector<Solution> others;
  for (const std::size_t facet : doubtful) {
    set_states(states);
    system().set_facet(facet, {.pressed = !states[facet].pressed}, true);
    Solution other;
    const bool is_found = goes_on_from(facet, other);
    const std::vector<mechanics::ContactState> found = present_states();
    if (is_found && std::ranges::find(known, found) == known.end()) {
      known.push_back(found);
      others.push_back(std::move(other));
    }
  }
  set_states(states);
  return others;
}

/// Newton's method with a facet put into another state. Returns whether it settles without the
/// facet going back at once.
bool RegularisedContact::goes_on_from(std::size_t facet, Solution& other) {
  const bool was_pressed = system().facets()[facet].state.pressed;
  loosen();
  return solve_for_states(other) == Outcome::kSettled &&
         states_at(other.displacement)[facet].pressed == was_pressed &&
         run(other) == Outcome::kSettled && system().refine(other);
}

}  // namespace holdfast::solver
