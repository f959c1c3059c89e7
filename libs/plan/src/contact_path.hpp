// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <optional>
#include <utility>
#include <vector>

#include "holdfast/mechanics/ground_contact.hpp"

namespace holdfast::plan {

/// By facet.
using ContactStates = std::vector<mechanics::ContactState>;

/// Follows the path of a check, Newton's method over contact states: `next(states)` solves for
/// states and returns those that the solution prescribes, none if it cannot be told. Returns the
/// states that prescribe themselves; none if the path comes back to where it was, or is longer than
/// `step_max`.
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

}  // namespace holdfast::plan
