// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string_view>

#include "holdfast/io/element.hpp"

namespace holdfast::io {

/// The least positive number and the largest mass that model::Robot allows. Products with numbers
/// beyond them leave the range of double.
inline constexpr double kPositiveMin = 1e-12;
inline constexpr double kPositiveMax = 1e12;

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

/// Reads three numbers separated by commas.
template <class Number>
std::optional<std::array<Number, 3>> parse_triple(std::string_view text);

/// The colour that "r,g,b", "#rrggbb" or "0xrrggbb" is.
std::optional<Color> parse_color(std::string_view text);

/// The colour that stands for three numbers that are none: their whole parts, in the range of
/// colours.
std::optional<Color> nearest_color(std::string_view text);

inline constexpr std::string_view kColorsAllowed =
    "expected three integers from 0 to 255, such as 1,2,3, or #010203";

}  // namespace holdfast::io
