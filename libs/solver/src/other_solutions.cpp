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

#include "holdfast/solver/equilibrium.hpp"
#include "multigrid/multigrid.hpp"

namespace holdfast::solver {
namespace {

/// Sideways force by pressure, or by the pull of the gap, from which on a facet is tried. The least
/// that had another solution was 1.7.
constexpr double kSlipRatio = 1;

/// With multigrid each costs a few iterations: no more than this are tried, lightest first.
constexpr std::size_t kTriedMaxMultigrid = 8;

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
std::vector<std::size_t> EquilibriumSolver::doubtful_facets(const Equilibrium& settled) const {
  std::vector<Doubt> doubts;
  for (std::size_t i = 0; i < facets_.size(); ++i) {
    const mechanics::ContactState& state = facets_[i].state;
    const bool is_stuck = state.pressed && state.tilt_x == 0 && state.tilt_y == 0;
    const Vec force = mechanics::trial_force(ground_, settled.displacement[facets_[i].module]);
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

void EquilibriumSolver::seek_others(Equilibrium& settled) {
  if (settled.outcome != Outcome::kSettled || settled.law != mechanics::ContactLaw::kRegularised ||
      options_.is_bonded) {
    return;
  }
  std::vector<std::size_t> doubtful = doubtful_facets(settled);
  if (doubtful.empty()) {
    return;
  }
  const std::vector<mechanics::ContactState> states = present_states();
  if (multigrid_ && doubtful.size() > kTriedMaxMultigrid) {
    doubtful.resize(kTriedMaxMultigrid);
  }
  std::vector<std::vector<mechanics::ContactState>> known = {states};
  for (const std::size_t facet : doubtful) {
    set_states(states);
    set_facet(facets_[facet], {.pressed = !states[facet].pressed}, true);
    Equilibrium other;
    const bool is_found = goes_on_from(facet, other);
    settled.steps += other.steps;
    const std::vector<mechanics::ContactState> found = present_states();
    if (is_found && std::ranges::find(known, found) == known.end()) {
      known.push_back(found);
      settled.others.push_back({.displacement = std::move(other.displacement),
                                .displacement_low = std::move(other.displacement_low),
                                .alternative = std::move(other.alternative)});
    }
  }
  set_states(states);
}

/// Newton's method with a facet put into another state. Returns whether it settles without the
/// facet going back at once.
bool EquilibriumSolver::goes_on_from(std::size_t facet, Equilibrium& other) {
  const bool was_pressed = facets_[facet].state.pressed;
  tolerance_ = loose_tolerance();
  return solve_for_states(other) && states_at(other.displacement)[facet].pressed == was_pressed &&
         iterate_regularised(other) == Outcome::kSettled &&
         (multigrid_ ? finish_multigrid(other) : finish_direct(other));
}

}  // namespace holdfast::solver
