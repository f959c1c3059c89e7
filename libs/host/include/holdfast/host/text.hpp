// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <concepts>
#include <string>
#include <string_view>

/// Counts and numbers as people read them.
namespace holdfast::host {

/// The noun for one or for several; `many` is the plural if that is not `one` with an s.
std::string noun(bool is_one, std::string_view one, std::string_view many = {});

/// Writes "1 step", "2 steps"; with a plural of its own "1 foot", "2 feet".
template <std::integral Count>
std::string counted(Count count, std::string_view one, std::string_view many = {}) {
  return std::to_string(count) + ' ' + noun(count == 1, one, many);
}

/// A number with so many decimals; a zero has no sign.
std::string fixed(double number, int decimals);

/// Writes as fixed() does, with a plus sign before numbers greater than zero.
std::string fixed_signed(double number, int decimals);

/// A number with so many significant digits at most; a zero has no sign.
std::string significant(double number, int digits);

/// A number with so many decimals, or with more if it would else read as 1 though it is not: what
/// holds must not read as what breaks. What lies within `tie` of 1 counts as 1. A zero has no sign.
std::string beside_one(double number, int decimals, double tie);

}  // namespace holdfast::host
