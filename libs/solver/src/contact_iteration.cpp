// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "contact_iteration.hpp"

#include <algorithm>
#include <utility>

namespace holdfast::solver {
namespace {

using mechanics::ContactState;

/// The error allowed while contact states are sought, as a share of the first. The regularised law
/// may have several answers, and the one meant is that of Newton's path: where a facet is so near
/// to another state that the error could decide, that step goes on, a factor at a time, down to the
/// finest.
constexpr double kLooseTolerance = 1e-3;
constexpr double kPathFactor = 0.1;
constexpr double kFinestTolerance = 1e-9;

/// The solution that is compared with the last one is so much farther from convergence.
constexpr double kAlternativeFactor = 10;

/// The error allowed once states hold still.
double tight_tolerance(const EquilibriumOptions& options) {
  return kAlternativeFactor * options.tolerance;
}

Outcome outcome_of(LinearOutcome linear) {
  switch (linear) {
    case LinearOutcome::kSolved:
      return Outcome::kSettled;
    case LinearOutcome::kSingular:
      return Outcome::kSingular;
    case LinearOutcome::kTooSlow:
      break;
  }
  return Outcome::kTooSlow;
}

}  // namespace

ContactIteration::ContactIteration(LinearSystem& system, const EquilibriumOptions& options)
    : system_(system), options_(options) {
  loosen();
}

void ContactIteration::loosen() {
  tolerance_ = std::max(tight_tolerance(options_), kLooseTolerance);
}

bool ContactIteration::is_tight_now() {
  const double tight = tight_tolerance(options_);
  return system_.is_exact() || std::exchange(tolerance_, std::min(tolerance_, tight)) <= tight;
}

Outcome ContactIteration::solve(Solution& solution) {
  const LinearOutcome outcome = system_.solve(tolerance_);
  if (outcome == LinearOutcome::kSolved) {
    solution.displacement = system_.displacement();
  }
  return outcome_of(outcome);
}

Outcome ContactIteration::solve_for_states(Solution& solution) {
  Outcome outcome = solve(solution);
  while (outcome == Outcome::kSettled && tolerance_ > kFinestTolerance &&
         !are_states_certain(solution.displacement)) {
    tolerance_ = std::max(kPathFactor * tolerance_, kFinestTolerance);
    outcome = solve(solution);
  }
  return outcome;
}

/// Whether every facet's state is that of the exact solution.
bool ContactIteration::are_states_certain(const std::vector<Vec>& displacement) const {
  const std::vector<double> errors = system_.facet_errors();
  for (std::size_t i = 0; i < errors.size(); ++i) {
    const FacetState& facet = system_.facets()[i];
    Vec more = system_.law().trial_force(facet, displacement[facet.module]);
    Vec less = more;
    more[2] -= errors[i];
    less[2] += errors[i];
    if (system_.law().state_for(facet, more) != system_.law().state_for(facet, less)) {
      return false;
    }
  }
  return true;
}

std::vector<ContactState> ContactIteration::present_states() const {
  std::vector<ContactState> states;
  states.reserve(system_.facets().size());
  for (const FacetState& facet : system_.facets()) {
    states.push_back(facet.state);
  }
  return states;
}

std::vector<ContactState> ContactIteration::states_at(const std::vector<Vec>& displacement) const {
  std::vector<ContactState> states;
  states.reserve(system_.facets().size());
  for (const FacetState& facet : system_.facets()) {
    states.push_back(system_.law().state_at(facet, displacement[facet.module]));
  }
  return states;
}

bool ContactIteration::set_states(const std::vector<ContactState>& states) {
  bool is_changed = false;
  for (std::size_t i = 0; i < states.size(); ++i) {
    is_changed = system_.set_facet(i, states[i], system_.facets()[i].is_held) || is_changed;
  }
  return is_changed;
}

BondedContact::BondedContact(LinearSystem& system, const EquilibriumOptions& options)
    : ContactIteration(system, options) {
  is_tight_now();
}

Outcome BondedContact::run(Solution& solution) { return solve(solution); }

}  // namespace holdfast::solver
