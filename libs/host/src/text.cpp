// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "holdfast/host/text.hpp"

#include <fmt/format.h>

#include <cmath>

namespace holdfast::host {
namespace {

bool is_zero(std::string_view text) {
  return text.find_first_not_of("-0.") == std::string_view::npos;
}

std::string without_sign_of_zero(const std::string& text) {
  return is_zero(text) && text.starts_with('-') ? text.substr(1) : text;
}

}  // namespace

std::string noun(bool is_one, std::string_view one, std::string_view many) {
  return !is_one && many.empty() ? std::string(one) + 's' : std::string(is_one ? one : many);
}

std::string fixed(double number, int decimals) {
  return without_sign_of_zero(fmt::format("{:.{}f}", number, decimals));
}

std::string fixed_signed(double number, int decimals) {
  const std::string text = fixed(number, decimals);
  return number > 0 && !is_zero(text) ? "+" + text : text;
}

std::string significant(double number, int digits) {
  return without_sign_of_zero(fmt::format("{:.{}g}", number, digits));
}

std::string beside_one(double number, int decimals, double tie) {
  // What is not 1 differs in the seventeenth decimal at the latest.
  while (std::abs(number - 1) > tie && fixed(number, decimals) == fixed(1, decimals)) {
    ++decimals;
  }
  return fixed(number, decimals);
}

}  // namespace holdfast::host
