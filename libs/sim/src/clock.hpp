// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "holdfast/agent/wire/link.hpp"

/// A module's own clock, in integers: local = global +- floor(global rate / 2^32).
namespace holdfast::sim {

using agent::Time;

class Clock {
 public:
  Clock() = default;

  /// The clock deviates by `rate` in parts of 2^32, at most a tenth of that.
  Clock(std::uint32_t rate, bool is_slow) : rate_(rate), is_slow_(is_slow) {}

  Time local(Time global) const {
    return is_slow_ ? global - deviation(global) : global + deviation(global);
  }

  /// The first global time at which the clock shows `local_time` or more.
  Time global(Time local_time) const;

 private:
  Time deviation(Time global) const {
    return (global >> 32U) * rate_ + (((global & 0xffffffffU) * rate_) >> 32U);
  }

  std::uint32_t rate_ = 0;
  bool is_slow_ = false;
};

inline Time Clock::global(Time local_time) const {
  if (rate_ == 0) {
    return local_time;
  }
  // A fixed point to start from; it contracts by the rate, so that a few steps suffice.
  Time guess = local_time;
  for (int i = 0; i < 8; ++i) {
    const Time change = deviation(guess);
    guess = is_slow_ ? local_time + change : local_time - change;
  }
  while (local(guess) < local_time) {
    ++guess;
  }
  while (guess > 0 && local(guess - 1) >= local_time) {
    --guess;
  }
  return guess;
}

}  // namespace holdfast::sim
