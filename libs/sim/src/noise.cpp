// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "noise.hpp"

#include <array>

namespace holdfast::sim {

Noise::Noise(const LinkModel& model)
    : loss_(model.loss),
      duplication_(model.duplication),
      reordering_(model.reordering),
      corruption_(model.corruption),
      jitter_(model.jitter),
      reordering_delay_(model.reordering_delay) {}

void flip_bits(std::span<std::uint8_t> packet, base::Rng& rng) {
  std::array<std::uint64_t, 3> flipped{};
  const std::uint64_t count = 1 + rng.below(flipped.size());
  for (std::uint64_t i = 0; i < count;) {
    const std::uint64_t bit = rng.below(packet.size() * 8);
    bool is_new = true;
    for (std::uint64_t k = 0; k < i; ++k) {
      is_new = is_new && flipped[k] != bit;
    }
    if (is_new) {
      flipped[i++] = bit;
      packet[bit / 8] = static_cast<std::uint8_t>(packet[bit / 8] ^ (1U << (bit % 8)));
    }
  }
}

}  // namespace holdfast::sim
