// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "holdfast/base/check.hpp"

namespace holdfast::base {

/// SplitMix64 [Steele, Lea, Flood 2014]: small, seeded, the same numbers on every platform.
class Rng {
 public:
  explicit constexpr Rng(std::uint64_t seed) : state_(seed) {}

  constexpr std::uint64_t next() {
    state_ += 0x9e3779b97f4a7c15U;
    std::uint64_t mixed = state_;
    mixed = (mixed ^ (mixed >> 30U)) * 0xbf58476d1ce4e5b9U;
    mixed = (mixed ^ (mixed >> 27U)) * 0x94d049bb133111ebU;
    return mixed ^ (mixed >> 31U);
  }

  /// A number in [0, bound). The bias is below bound / 2^64.
  constexpr std::uint64_t below(std::uint64_t bound) {
    HOLDFAST_ASSERT(bound > 0);
    return next() % bound;
  }

 private:
  std::uint64_t state_;
};

}  // namespace holdfast::base
