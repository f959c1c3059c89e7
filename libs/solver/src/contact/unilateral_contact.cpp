// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "contact/unilateral_contact.hpp"

#include <algorithm>
#include <utility>

#include "factorization/beam_forces.hpp"
#include "holdfast/solver/largest.hpp"

namespace holdfast::solver {
namespace {

using base::Vec6;

/// Halvings of the bracket in the line search, to the resolution of double.
constexpr int kLineStepMax = 60;

/// Where a facet is at the border of two states both have the same displacements, but for this
/// share of the largest, and rounding goes from one to the other. Most that settle have by half of
/// the steps that are allowed.
constexpr double kTieShare = 1e-11;

bool is_open_but_held(const FacetState& facet) { return !facet.state.pressed && facet.is_held; }

}  // namespace

UnilateralContact::UnilateralContact(LinearSystem& system, const EquilibriumOptions& options)
    : ContactIteration(system, options), was_released_(system.facets().size()) {}

Outcome UnilateralContact::run() {
  Outcome outcome = minimise();
  while (outcome == Outcome::kSettled && update_held()) {
    outcome = minimise();
  }
  return outcome;
}

/// Newton's method with an exact line search on the convex energy, for the present held facets.
Outcome UnilateralContact::minimise() {
  current_.clear();
  for (int step = 0; step < step_count_max(); ++step) {
    const Outcome outcome = solve();
    if (outcome != Outcome::kSettled) {
      return outcome;
    }
    if (!set_states(next_states())) {
      if (is_tight_now()) {
        current_ = std::vector<Vec>();
        return Outcome::kSettled;
      }
      continue;
    }
    std::vector<Vec> next = system().displacement();
    if (!current_.empty()) {
      const std::vector<Vec> direction = sum(std::move(next), -1, current_);
      if (step >= step_count_max() / 2 && is_nothing(direction)) {
        current_ = std::vector<Vec>();
        return solve();
      }
      const double length = search_line(current_, direction);
      next = sum(std::move(current_), length, direction);
      set_states(states_at(at_facets(next)));
    }
    current_ = std::move(next);
  }
  return Outcome::kNotSettled;
}

/// Whether a change of the present displacements is no more than rounding.
bool UnilateralContact::is_nothing(const std::vector<Vec>& direction) const {
  const double change = host::max(ranks(), largest(direction));
  return change <= kTieShare * host::max(ranks(), largest(current_));
}

/// Where the energy along a line is least: the root of its slope, which never decreases.
double UnilateralContact::search_line(const std::vector<Vec>& from,
                                      const std::vector<Vec>& direction) const {
  const model::Robot& robot = system().robot();
  double slope = dot_all(beam_forces(robot, system().beam(), from), direction);
  for (std::size_t i = 0; i < own_count(); ++i) {  // A fixed module does not move.
    slope -= base::dot(system().loads()[i], direction[i]);
  }
  const double curvature = dot_all(beam_forces(robot, system().beam(), direction), direction);
  const auto slope_at = [&](double length) {
    double slope_here = slope + length * curvature;
    for (FacetState facet : system().facets()) {
      const Vec u = sum(from[facet.module], length, direction[facet.module]);
      facet.state = system().law().state_at(facet, u);
      slope_here += base::dot(system().law().force(facet, u), direction[facet.module]);
    }
    return host::sum(ranks(), slope_here);
  };
  if (slope_at(1) <= 0) {
    return 1;
  }
  double low = 0;
  double high = 1;
  for (int i = 0; i < kLineStepMax && low < high; ++i) {
    const double middle = (low + high) / 2;
    (slope_at(middle) <= 0 ? low : high) = middle;
  }
  return high;
}

/// Releases open facets, holds pressed ones. Returns whether anything changed; a facet changes at
/// most twice, so this says no in the end.
bool UnilateralContact::update_held() {
  bool is_changed = false;
  for (std::size_t i = 0; i < system().facets().size(); ++i) {
    const FacetState& facet = system().facets()[i];
    const bool is_held = facet.state.pressed || (facet.is_held && was_released_[i]);
    was_released_[i] = was_released_[i] || !is_held;
    is_changed = system().set_facet(i, facet.state, is_held) || is_changed;
  }
  return host::any(ranks(), is_changed);
}

int UnilateralContact::open_but_held_count() const {
  const auto count = std::ranges::count_if(system().facets(), is_open_but_held);
  return static_cast<int>(host::total(ranks(), static_cast<std::size_t>(count)));
}

std::optional<Solution> UnilateralContact::with_free_facets(const std::vector<Vec>& displacement) {
  for (std::size_t i = 0; i < system().facets().size(); ++i) {
    const FacetState& facet = system().facets()[i];
    system().set_facet(i, facet.state, facet.is_held && facet.state.pressed);
  }
  set_states(states_at(at_facets(displacement)));
  Solution free;
  return minimise() == Outcome::kSettled && complete(free) ? std::optional(std::move(free))
                                                           : std::nullopt;
}

}  // namespace holdfast::solver
