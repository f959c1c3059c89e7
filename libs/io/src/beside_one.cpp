// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "holdfast/io/beside_one.hpp"

#include <fmt/format.h>

#include <cmath>

#include "holdfast/verdict/assessment.hpp"

namespace holdfast::io {

std::string beside_one(double number, int decimals) {
  const std::string one = fmt::format("{:.{}f}", 1.0, decimals);
  std::string text = fmt::format("{:.{}f}", number, decimals);
  // Beyond the tie the tenth decimal differs at the latest.
  while (std::abs(number - 1) > verdict::kLoadRatioTie && text.starts_with(one) &&
         text.find_first_not_of("0.", 1) == std::string::npos) {
    text = fmt::format("{:.{}f}", number, ++decimals);
  }
  const bool is_zero = text.find_first_not_of("-0.") == std::string::npos;
  return is_zero && text.starts_with('-') ? text.substr(1) : text;
}

}  // namespace holdfast::io
