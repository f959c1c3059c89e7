// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <bit>
#include <cstdint>

namespace holdfast::agent {

/// The bit of a face or a planned index in a mask.
constexpr std::uint8_t bit(int i) {
  return static_cast<std::uint8_t>(1U << static_cast<unsigned>(i));
}

/// The leading 24 binary digits of a number, which single precision holds exactly. By its bits and
/// not by a conversion to float and back, which g++ 12 loses when it vectorises straight code; what
/// converts elsewhere relies on it being compiled without (holdfast_same_bits in
/// cmake/Rooms.cmake). (Where double is binary32, as on an AVR, all digits are leading ones.)
template <class Real>
constexpr Real leading_part(Real value) {
  if constexpr (sizeof(Real) == sizeof(std::uint32_t)) {
    return value;
  } else {
    return std::bit_cast<Real>(std::bit_cast<std::uint64_t>(value) & ~std::uint64_t{0x1fffffff});
  }
}

}  // namespace holdfast::agent
