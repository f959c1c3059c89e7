// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "numbers.hpp"

#include <charconv>
#include <cmath>

#include "text_input.hpp"

namespace holdfast::io {

template <class Number>
std::optional<Number> parse_number(std::string_view text) {
  text = trimmed(text);
  const char* const end = text.data() + text.size();
  Number number{};
  const auto [rest, fault] = std::from_chars(text.data(), end, number);
  if (fault != std::errc() || rest != end || !std::isfinite(static_cast<double>(number))) {
    return std::nullopt;
  }
  return number;
}

template <class Number>
std::optional<std::array<Number, 3>> parse_triple(std::string_view text) {
  std::array<Number, 3> triple{};
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t comma = i < 2 ? text.find(',') : text.size();
    const auto number = parse_number<Number>(text.substr(0, comma));
    if (comma == std::string_view::npos || !number) {
      return std::nullopt;
    }
    triple[i] = *number;
    text.remove_prefix(i < 2 ? comma + 1 : comma);
  }
  return triple;
}

template std::optional<std::int32_t> parse_number<std::int32_t>(std::string_view);
template std::optional<double> parse_number<double>(std::string_view);
template std::optional<std::array<std::int32_t, 3>> parse_triple<std::int32_t>(std::string_view);
template std::optional<std::array<double, 3>> parse_triple<double>(std::string_view);

}  // namespace holdfast::io
