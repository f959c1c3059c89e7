// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "contact/contact_iteration.hpp"

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

/// What a journal keeps of a facet: its state's code, and whether it is held sideways.
constexpr int kHeld = 16;

std::uint8_t journal_number(const FacetState& facet) {
  return static_cast<std::uint8_t>(facet.state.code() + (facet.is_held ? kHeld : 0));
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

Outcome ContactIteration::solve() { return outcome_of(system_.solve(tolerance_)); }

Outcome ContactIteration::solve_for_states() {
  Outcome outcome = solve();
  while (outcome == Outcome::kSettled && tolerance_ > kFinestTolerance && !are_states_certain()) {
    tolerance_ = std::max(kPathFactor * tolerance_, kFinestTolerance);
    outcome = solve();
  }
  return outcome;
}

/// Whether every facet's state is that of the exact solution.
bool ContactIteration::are_states_certain() {
  const std::vector<double> errors = system_.facet_errors();
  const std::vector<Vec> displacement =
      errors.empty() ? std::vector<Vec>() : system_.facet_displacement();
  bool is_certain = true;
  for (std::size_t i = 0; is_certain && i < errors.size(); ++i) {
    const FacetState& facet = system_.facets()[i];
    Vec more = system_.law().trial_force(facet, displacement[i]);
    Vec less = more;
    more[2] -= errors[i];
    less[2] += errors[i];
    is_certain = system_.law().state_for(facet, more) == system_.law().state_for(facet, less);
  }
  return host::all(ranks(), is_certain);
}

std::vector<ContactState> ContactIteration::present_states() const {
  std::vector<ContactState> states;
  states.reserve(system_.facets().size());
  for (const FacetState& facet : system_.facets()) {
    states.push_back(facet.state);
  }
  return states;
}

std::vector<ContactState> ContactIteration::states_at(const std::vector<Vec>& facets) const {
  std::vector<ContactState> states;
  states.reserve(facets.size());
  for (std::size_t i = 0; i < facets.size(); ++i) {
    states.push_back(system_.law().state_at(system_.facets()[i], facets[i]));
  }
  return states;
}

std::vector<base::Vec6<double>> ContactIteration::at_facets(
    const std::vector<Vec>& displacement) const {
  std::vector<Vec> by_facet;
  by_facet.reserve(system_.facets().size());
  for (const FacetState& facet : system_.facets()) {
    by_facet.push_back(displacement[facet.module]);
  }
  return by_facet;
}

bool ContactIteration::complete(Solution& solution) {
  if (!system_.refine(solution)) {
    return false;
  }
  system_.hand_over(solution, LinearSystem::Further::kMore);
  return true;
}

bool ContactIteration::set_states(const std::vector<ContactState>& states) {
  bool is_changed = false;
  for (std::size_t i = 0; i < states.size(); ++i) {
    is_changed = system_.set_facet(i, states[i], system_.facets()[i].is_held) || is_changed;
  }
  is_changed = host::any(ranks(), is_changed);
  if (is_changed && has_journal_) {
    tell_journal();
  }
  return is_changed;
}

void ContactIteration::go_on(const ContactOptions& contact) {
  if (options_.journal == nullptr) {
    return;
  }
  const std::vector<std::uint8_t> numbers = options_.journal->begin(contact.law, contact.gamma);
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    system_.set_facet(i, ContactState::from_code(numbers[i] % kHeld), numbers[i] >= kHeld);
  }
  has_journal_ = true;
}

void ContactIteration::tell_journal() const {
  std::vector<std::uint8_t> numbers;
  for (const FacetState& facet : system_.facets()) {
    numbers.push_back(journal_number(facet));
  }
  options_.journal->keep(numbers);
}

BondedContact::BondedContact(LinearSystem& system, const EquilibriumOptions& options)
    : ContactIteration(system, options) {
  is_tight_now();
}

Outcome BondedContact::run() { return solve(); }

}  // namespace holdfast::solver
