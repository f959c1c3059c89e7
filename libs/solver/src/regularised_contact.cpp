// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "regularised_contact.hpp"

#include <cstdint>
#include <set>

namespace holdfast::solver {
namespace {

using mechanics::ContactState;

/// States in a form that can be compared and remembered.
std::vector<std::int8_t> codes_of(const std::vector<ContactState>& states) {
  std::vector<std::int8_t> codes;
  codes.reserve(states.size());
  for (const ContactState& state : states) {
    codes.push_back(static_cast<std::int8_t>(state.code()));
  }
  return codes;
}

}  // namespace

RegularisedContact::RegularisedContact(LinearSystem& system, const EquilibriumOptions& options)
    : ContactIteration(system, options) {}

Outcome RegularisedContact::run(Solution& solution) {
  std::set<std::vector<std::int8_t>> seen;
  for (int step = 0; step < step_count_max(); ++step) {
    const Outcome outcome = solve_for_states(solution);
    if (outcome != Outcome::kSettled) {
      return outcome;
    }
    const std::vector<ContactState> states = states_at(solution.displacement);
    if (!set_states(states)) {
      if (is_tight_now()) {
        return Outcome::kSettled;
      }
      continue;
    }
    if (!seen.insert(codes_of(states)).second) {
      return Outcome::kNotSettled;
    }
    loosen();
  }
  return Outcome::kNotSettled;
}

}  // namespace holdfast::solver
