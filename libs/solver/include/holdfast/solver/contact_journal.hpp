// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "holdfast/mechanics/ground_contact.hpp"

namespace holdfast::solver {

/// Keeps the contact states that searches have come to, so that a run that is ended can go on from
/// there. The searches of a run are counted from its beginning; all ranks call the same.
class ContactJournal {
 public:
  ContactJournal() = default;
  ContactJournal(const ContactJournal&) = delete;
  ContactJournal& operator=(const ContactJournal&) = delete;
  virtual ~ContactJournal() = default;

  /// A search begins. Returns a number for each facet of this rank, as keep() was given them when
  /// an earlier run was in the same search; none if it was not. `gamma` is the weak spring's share.
  virtual std::vector<std::uint8_t> begin(mechanics::ContactLaw law, double gamma) = 0;

  /// The search has come to these states, facet by facet.
  virtual void keep(std::span<const std::uint8_t> states) = 0;
};

}  // namespace holdfast::solver
