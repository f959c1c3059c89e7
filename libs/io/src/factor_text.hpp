// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <fmt/format.h>

#include <string>

#include "holdfast/io/beside_one.hpp"

namespace holdfast::io {

/// A factor of all loads, with four digits behind the point; a small one with three digits.
inline std::string factor_text(double factor) {
  return factor < 0.01 ? fmt::format("{:.3g}", factor) : beside_one(factor, 4);
}

}  // namespace holdfast::io
