// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "holdfast/instrument.hpp"
#include "partner.hpp"

namespace holdfast::instrument {

/// One case while it runs: the first thing that is not as expected is kept.
class Check {
 public:
  using Bytes = by_hand::Bytes;

  explicit Check(Partner& neighbour) : partner(neighbour) {}

  /// Is this so? Both are shown if not.
  bool expect(bool is_so, const std::string& expected, const std::string& found);

  bool expect_bytes(const Bytes& expected, const std::optional<Bytes>& found);

  /// The module says these messages next.
  bool expect_messages(const Bytes& expected);

  /// What was just said has had no effect: the module says nothing but what it said before.
  bool expect_silence(const std::optional<Bytes>& found);

  /// What the case is about is not in this module, and why.
  void absent(const std::string& why);

  bool is_passed() const { return result_.outcome == ConformanceCase::Outcome::kPassed; }

  bool is_absent() const { return result_.outcome == ConformanceCase::Outcome::kAbsent; }

  const ConformanceCase& result() const { return result_; }

  Partner& partner;

 private:
  ConformanceCase result_;
};

struct Case {
  const char* section;
  const char* name;
  void (*run)(Check&);
};

std::span<const Case> line_cases();
std::span<const Case> link_cases();
std::span<const Case> round_cases();

}  // namespace holdfast::instrument
