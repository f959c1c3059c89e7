// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "regularised_contact.hpp"

#include <cstdint>
#include <cstring>
#include <set>
#include <utility>

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

/// Something short that stands for all ranks' states; equal by chance once in 2^64.
std::vector<std::int8_t> codes_of_all(host::Ranks& ranks, const std::vector<std::int8_t>& codes) {
  std::uint64_t hash = 0x243f6a8885a308d3U;
  for (const std::int8_t code : codes) {
    hash = (hash ^ static_cast<std::uint8_t>(code)) * 0x9e3779b97f4a7c15U;
    hash ^= hash >> 32U;
  }
  std::vector<std::int8_t> mine(sizeof hash);
  std::memcpy(mine.data(), &hash, sizeof hash);
  return host::gather<std::int8_t>(ranks, mine);
}

}  // namespace

RegularisedContact::RegularisedContact(LinearSystem& system, const EquilibriumOptions& options)
    : ContactIteration(system, options) {}

Outcome RegularisedContact::run() {
  std::set<std::vector<std::int8_t>> seen;
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
    std::vector<std::int8_t> codes = codes_of(states);
    if (ranks() != nullptr) {
      codes = codes_of_all(*ranks(), codes);
    }
    if (!seen.insert(std::move(codes)).second) {
      return Outcome::kNotSettled;
    }
    loosen();
  }
  return Outcome::kNotSettled;
}

}  // namespace holdfast::solver
