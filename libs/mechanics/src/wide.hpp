// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace holdfast::mechanics {

/// A number of 128 bits in two's complement, without the compiler's own type, which no module's
/// processor has.
struct Wide {
  std::uint64_t high = 0;
  std::uint64_t low = 0;
};

/// The product of all 64 bits, made of halves of 32.
static inline Wide product(std::int64_t a, std::int64_t b) {
  const auto size = [](std::int64_t value) {
    const auto bits = static_cast<std::uint64_t>(value);
    return value < 0 ? 0 - bits : bits;
  };
  constexpr std::uint64_t kHalf = 0xffffffffU;
  const std::uint64_t x = size(a);
  const std::uint64_t y = size(b);
  const std::uint64_t lowest = (x & kHalf) * (y & kHalf);
  const std::uint64_t left = (x >> 32U) * (y & kHalf) + (lowest >> 32U);
  const std::uint64_t right = (x & kHalf) * (y >> 32U) + (left & kHalf);
  Wide wide = {(x >> 32U) * (y >> 32U) + (left >> 32U) + (right >> 32U),
               (right << 32U) | (lowest & kHalf)};
  if ((a < 0) != (b < 0)) {
    wide.low = 0 - wide.low;
    wide.high = ~wide.high + (wide.low == 0 ? 1U : 0U);
  }
  return wide;
}

static inline Wide sum(const Wide& a, const Wide& b) {
  const std::uint64_t low = a.low + b.low;
  return {a.high + b.high + (low < a.low ? 1U : 0U), low};
}

static inline int sign(const Wide& wide) {
  return (wide.high >> 63U) != 0 ? -1 : (wide.high | wide.low) != 0 ? 1 : 0;
}

}  // namespace holdfast::mechanics
