// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "numbers.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <string>
#include <version>

#include "text_input.hpp"

namespace holdfast::io {
namespace {

#ifdef __cpp_lib_to_chars
using std::from_chars;
#else
/// Reads a number where the library cannot: libc++ before 20 reads integers only. strtod rounds
/// alike, but takes more: signs, hexadecimals.
template <class Number>
std::from_chars_result from_chars(const char* begin, const char* end, Number& number) {
  if constexpr (std::is_integral_v<Number>) {
    return std::from_chars(begin, end, number);
  } else {
    const std::string text(begin, end);
    if (text.find_first_not_of("0123456789+-.eE") != std::string::npos || text.starts_with('+')) {
      return {begin, std::errc::invalid_argument};
    }
    char* rest = nullptr;
    number = std::strtod(text.c_str(), &rest);
    const bool is_number = rest != text.c_str();
    return {begin + (rest - text.c_str()), is_number ? std::errc() : std::errc::invalid_argument};
  }
}
#endif

}  // namespace

template <class Number>
std::optional<Number> parse_number(std::string_view text) {
  text = trimmed(text);
  const char* const end = text.data() + text.size();
  Number number{};
  const auto [rest, fault] = from_chars(text.data(), end, number);
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

std::optional<Color> parse_color(std::string_view text) {
  if (const auto triple = parse_triple<std::int32_t>(text)) {
    const auto [red, green, blue] = *triple;
    const bool is_good = std::ranges::all_of(*triple, [](auto n) { return n >= 0 && n <= 255; });
    return is_good ? std::optional(Color{red, green, blue}) : std::nullopt;
  }
  text = trimmed(text);
  const std::size_t head = text.starts_with('#') ? 1 : text.starts_with("0x") ? 2 : text.size();
  const std::string_view digits = text.substr(head);
  std::uint32_t value = 0;
  const auto [rest, fault] =
      std::from_chars(digits.data(), digits.data() + digits.size(), value, 16);
  if (digits.size() != 6 || fault != std::errc() || rest != digits.data() + digits.size()) {
    return std::nullopt;
  }
  return Color{static_cast<int>(value >> 16U), static_cast<int>(value >> 8U & 0xFFU),
               static_cast<int>(value & 0xFFU)};
}

std::optional<Color> nearest_color(std::string_view text) {
  const auto triple = parse_triple<double>(text);
  if (!triple) {
    return std::nullopt;
  }
  const auto part = [](double number) { return static_cast<int>(std::clamp(number, 0.0, 255.0)); };
  return Color{part((*triple)[0]), part((*triple)[1]), part((*triple)[2])};
}

template std::optional<std::int32_t> parse_number<std::int32_t>(std::string_view);
template std::optional<double> parse_number<double>(std::string_view);
template std::optional<std::array<std::int32_t, 3>> parse_triple<std::int32_t>(std::string_view);
template std::optional<std::array<double, 3>> parse_triple<double>(std::string_view);

}  // namespace holdfast::io
