// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace holdfast::agent {

/// The bit of a face or a planned index in a mask.
constexpr std::uint8_t bit(int i) {
  return static_cast<std::uint8_t>(1U << static_cast<unsigned>(i));
}

}  // namespace holdfast::agent
