// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "holdfast/io/beside_one.hpp"

#include <algorithm>

#include "holdfast/host/text.hpp"
#include "holdfast/verdict/assessment.hpp"

namespace holdfast::io {

std::string beside_one(double number, int decimals) {
  return host::beside_one(number, decimals, verdict::kLoadRatioTie);
}

std::string percentage(double share, int decimals) {
  std::string text = beside_one(share, decimals + 2);
  const std::size_t point = text.find('.');
  text = text.substr(0, point) + text.substr(point + 1, 2) +
         (point + 3 < text.size() ? "." + text.substr(point + 3) : "");
  const std::size_t sign = text.front() == '-' ? 1 : 0;
  const std::size_t first = std::min(text.find_first_not_of('0', sign), text.size());
  const std::size_t whole = std::min(text.find('.'), text.size());
  text.erase(sign, std::min(first, whole - 1) - sign);
  return text;
}

}  // namespace holdfast::io
