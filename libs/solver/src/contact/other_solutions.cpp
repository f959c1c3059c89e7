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
#include <limits>
#include <utility>
#include <vector>

#include "contact/regularised_contact.hpp"
#include "holdfast/solver/second_state.hpp"

namespace holdfast::solver {
namespace {

/// Where systems are iterated each costs a few iterations: no more than this are tried, lightest
/// first.
constexpr std::size_t kTriedMaxIterated = 8;

/// Forces of mirror images differ by the solver's error.
constexpr double kAlikeShare = 1e-3;

struct Doubt {
  std::size_t facet = 0;  ///< Of its rank.
  std::size_t rank = 0;
  double upright_n = 0;
  double sideways_n = 0;
};

bool is_alike(const Doubt& a, const Doubt& b) {
  const double margin = kAlikeShare * std::max(a.sideways_n, b.sideways_n);
  return std::abs(a.sideways_n - b.sideways_n) <= margin &&
         std::abs(a.upright_n - b.upright_n) <= margin;
}

/// The first of those that are alike.
std::vector<Doubt> unlike_ones(const std::vector<Doubt>& all) {
  std::vector<Doubt> unlike;
  for (const Doubt& doubt : all) {
    if (std::ranges::none_of(unlike, [&](const Doubt& other) { return is_alike(doubt, other); })) {
      unlike.push_back(doubt);
    }
  }
  return unlike;
}

/// Stands for a facet of another rank.
constexpr std::size_t kElsewhere = std::numeric_limits<std::size_t>::max();

}  // namespace

/// Facets, by index, that may have a second state; lightest for their sideways force first, and one
/// only of those that carry the same, as each other's mirror images do.
std::vector<std::size_t> RegularisedContact::doubtful_facets(const std::vector<Vec>& facets) const {
  const std::size_t here = base::at(ranks().rank());
  std::vector<Doubt> doubts;
  for (std::size_t i = 0; i < system().facets().size(); ++i) {
    const FacetState& facet = system().facets()[i];
    const Vec force = system().law().trial_force(facet, facets[i]);
    const Doubt doubt = {.facet = i,
                         .rank = here,
                         .upright_n = std::abs(force[2]),
                         .sideways_n = std::hypot(force[0], force[1])};
    const bool is_new =
        std::ranges::none_of(doubts, [&](const Doubt& other) { return is_alike(doubt, other); });
    if (may_have_second_state(facet.state, force) && is_new) {
      doubts.push_back(doubt);
    }
  }
  doubts = unlike_ones(host::gather<Doubt>(ranks(), doubts));
  std::ranges::sort(doubts, {},
                    [](const Doubt& doubt) { return doubt.upright_n / doubt.sideways_n; });
  std::vector<std::size_t> indices;
  for (const Doubt& doubt : doubts) {
    indices.push_back(doubt.rank == here ? doubt.facet : kElsewhere);
  }
  return indices;
}

std::vector<Solution> RegularisedContact::find_others(const Solution& settled) {
  std::vector<std::size_t> doubtful = doubtful_facets(at_facets(settled.displacement));
  if (!system().is_exact() && doubtful.size() > kTriedMaxIterated) {
    doubtful.resize(kTriedMaxIterated);
  }
  const std::vector<mechanics::ContactState> states = present_states();
  std::vector<std::vector<mechanics::ContactState>> known = {states};
  std::vector<Solution> others;
  for (const std::size_t facet : doubtful) {
    set_states(states);
    if (facet != kElsewhere) {
      system().set_facet(facet, {.pressed = !states[facet].pressed}, true);
    }
    Solution other;
    const bool is_found = goes_on_from(facet, other);
    const std::vector<mechanics::ContactState> found = present_states();
    const bool is_new = std::ranges::none_of(
        known, [&](const auto& one) { return host::all(ranks(), one == found); });
    if (is_found && is_new) {
      known.push_back(found);
      other.contact = found;
      others.push_back(std::move(other));
    }
  }
  set_states(states);
  return others;
}

void RegularisedContact::find_from_one_foot(const std::function<void(Solution)>& take) {
  const std::size_t count = system().facets().size();
  std::vector<std::vector<mechanics::ContactState>> known;
  const auto go_on_from = [&](std::size_t facet, const mechanics::ContactState& state) {
    std::vector<mechanics::ContactState> states(count, {.pressed = false});
    states[facet] = state;
    set_states(states);
    loosen();
    Solution solution;
    if (run() == Outcome::kSettled && complete(solution) &&
        std::ranges::find(known, present_states()) == known.end()) {
      known.push_back(present_states());
      take(std::move(solution));
    }
  };
  for (std::size_t facet = 0; facet < count; ++facet) {
    for (int code = 0; code < mechanics::ContactState::kCodeCount; ++code) {
      const auto state = mechanics::ContactState::from_code(code);
      if (state.pressed) {
        go_on_from(facet, state);
      }
    }
  }
}

void RegularisedContact::try_all_states(const std::function<void(Solution)>& take) {
  std::vector<int> codes(system().facets().size(), 0);
  const auto next = [&codes] {
    for (int& code : codes) {
      if (++code < mechanics::ContactState::kCodeCount) {
        return true;
      }
      code = 0;
    }
    return false;
  };
  do {
    std::vector<mechanics::ContactState> states;
    for (const int code : codes) {
      states.push_back(mechanics::ContactState::from_code(code));
    }
    set_states(states);
    Solution solution;
    if (solve() == Outcome::kSettled && next_states() == states && complete(solution)) {
      take(std::move(solution));
    }
  } while (next());
}

/// Newton's method with a facet put into another state. Returns whether it settles without the
/// facet going back at once.
bool RegularisedContact::goes_on_from(std::size_t facet, Solution& other) {
  const bool is_here = facet != kElsewhere;
  const bool was_pressed = is_here && system().facets()[facet].state.pressed;
  loosen();
  if (solve_for_states() != Outcome::kSettled) {
    return false;
  }
  const bool stays = !is_here || next_states()[facet].pressed == was_pressed;
  return host::all(ranks(), stays) && run() == Outcome::kSettled && complete(other);
}

}  // namespace holdfast::solver
