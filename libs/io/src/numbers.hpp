// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string_view>

namespace holdfast::io {

/// Integers from `lowest` to `highest`.
struct IntegerRange {
  std::int32_t lowest = 0;
  std::int32_t highest = 0;

  bool contains(double value) const { return value >= lowest && value <= highest; }
};

/// The finite number that a text is, white space around it aside; none if there is anything else.
/// Number is std::int32_t or double.
template <class Number>
std::optional<Number> parse_number(std::string_view text);

/// Three numbers separated by commas.
template <class Number>
std::optional<std::array<Number, 3>> parse_triple(std::string_view text);

}  // namespace holdfast::io
