// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>

#include "holdfast/base/rng.hpp"
#include "holdfast/sim/link_model.hpp"

/// Draws what happens to packets on the way from the sender's own generator.
namespace holdfast::sim {

/// An event of some probability, decided in integers: the same on every platform.
class Chance {
 public:
  /// The event has this probability, in [0, 1].
  explicit Chance(double probability)
      : threshold_(static_cast<std::uint64_t>(probability * kScale)) {}

  bool is_possible() const { return threshold_ != 0; }

  /// Draws only if the event is possible.
  bool happens(base::Rng& rng) const { return threshold_ != 0 && (rng.next() >> 11U) < threshold_; }

 private:
  /// 2^53: multiplying by it is exact.
  static constexpr double kScale = 9007199254740992.0;

  std::uint64_t threshold_;
};

/// The noise of a link model.
class Noise {
 public:
  explicit Noise(const LinkModel& model);

  bool is_lost(base::Rng& rng) const { return loss_.happens(rng); }

  bool is_doubled(base::Rng& rng) const { return duplication_.happens(rng); }

  bool is_held_back(base::Rng& rng) const { return reordering_.happens(rng); }

  bool is_corrupted(base::Rng& rng) const { return corruption_.happens(rng); }

  /// A random time from 0 to the model's jitter.
  Time jitter(base::Rng& rng) const { return jitter_ == 0 ? 0 : rng.below(jitter_ + 1); }

  /// A random time from 1 to the model's reordering delay.
  Time delay(base::Rng& rng) const { return 1 + rng.below(reordering_delay_); }

 private:
  Chance loss_;
  Chance duplication_;
  Chance reordering_;
  Chance corruption_;
  Time jitter_;
  Time reordering_delay_;
};

/// Flips 1 to 3 different bits.
void flip_bits(std::span<std::uint8_t> packet, base::Rng& rng);

}  // namespace holdfast::sim
