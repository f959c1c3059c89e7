// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace holdfast::agent {

/// One attempt at a verdict: the how-manieth, and the id of the module that has started it.
struct Round {
  std::uint16_t epoch = 0;  ///< 0: none yet.
  std::uint32_t starter = 0;

  friend constexpr bool operator==(const Round&, const Round&) = default;
};

/// 65,535 is followed by 1, as 0 stands for none.
constexpr std::uint16_t epoch_after(std::uint16_t epoch) {
  return static_cast<std::uint16_t>(epoch == 0xffffU ? 1 : epoch + 1);
}

/// Does `a` put an end to `b`? Epochs are serial numbers [RFC1982]: of two the one is newer that
/// comes less than 32,768 behind the other, counted in a circle. So rounds never run out, as long
/// as no two parts that are put together have lived through so many without each other. Where the
/// RFC leaves it open, 32,768 apart, the larger number is newer: both sides must think the same. Of
/// one epoch the larger starter is.
constexpr bool is_newer(const Round& a, const Round& b) {
  if (a.epoch == b.epoch) {
    return a.starter > b.starter;
  }
  if (a.epoch == 0 || b.epoch == 0) {
    return b.epoch == 0;
  }
  constexpr std::uint16_t kHalf = 0x8000;
  const auto ahead = static_cast<std::uint16_t>(a.epoch - b.epoch);
  return ahead == kHalf ? a.epoch > b.epoch : ahead < kHalf;
}

}  // namespace holdfast::agent
