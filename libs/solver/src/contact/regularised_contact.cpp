// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "contact/regularised_contact.hpp"

#include <cstdint>
#include <set>
#include <span>
#include <vector>

namespace holdfast::solver {
namespace {

using mechanics::ContactState;

/// Something short that stands for all ranks' states; equal by chance once in 2^64.
std::vector<std::uint64_t> hashes_of(host::Ranks& ranks, const std::vector<ContactState>& states) {
  std::uint64_t hash = 0x243f6a8885a308d3U;
  for (const ContactState& state : states) {
    hash = (hash ^ static_cast<std::uint8_t>(state.code())) * 0x9e3779b97f4a7c15U;
    hash ^= hash >> 32U;
  }
  return host::gather(ranks, std::span<const std::uint64_t>(&hash, 1));
}

}  // namespace

RegularisedContact::RegularisedContact(LinearSystem& system, const EquilibriumOptions& options)
    : ContactIteration(system, options) {}

Outcome RegularisedContact::run() {
  std::set<std::vector<std::uint64_t>> seen;
  for (int step = 0; step < step_count_max(); ++step) {
    const Outcome outcome = solve_for_states();
    if (outcome != Outcome::kSettled) {
      return outcome;
    }
    const std::vector<ContactState> states = next_states();
    if (!set_states(states)) {
      if (is_tight_now()) {
        return Outcome::kSettled;
      }
      continue;
    }
    if (!seen.insert(hashes_of(ranks(), states)).second) {
      return Outcome::kNotSettled;
    }
    loosen();
  }
  return Outcome::kNotSettled;
}

}  // namespace holdfast::solver
