// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "frame_reference.hpp"
#include "holdfast/base/rng.hpp"

namespace holdfast::test {

/// A connected frame of printed bars: the first three of `node_count` nodes are grounded, each
/// other one is held by a bar from an earlier one; then `more` bars join random nodes. In the order
/// of their numbers every bar touches what is there.
inline Frame random_frame(std::uint64_t seed, std::int32_t node_count, int more) {
  base::Rng rng(seed);
  const auto coordinate = [&] { return static_cast<double>(rng.below(100'000)) / 1000; };
  const auto node_below = [&](std::int32_t bound) {
    return static_cast<std::int32_t>(rng.below(static_cast<std::uint64_t>(bound)));
  };
  Frame frame = {.elastic_modulus_mpa = 3500,
                 .shear_modulus_mpa = 2400,
                 .radius_mm = 1.5,
                 .weight_n_per_mm3 = 12.2582e-6};
  for (std::int32_t node = 0; node < node_count; ++node) {
    frame.is_grounded.push_back(node < 3);
    const double x = coordinate();
    const double y = coordinate();
    frame.places_mm.emplace_back(x, y, node < 3 ? 0.0 : 10 + coordinate());
    if (node >= 3) {
      frame.bars.push_back({node_below(node), node});
    }
  }
  for (int i = 0; i < more; ++i) {
    const std::int32_t a = node_below(node_count);
    const std::int32_t b = node_below(node_count);
    if (a != b) {
      frame.bars.push_back({a, b});
    }
  }
  return frame;
}

}  // namespace holdfast::test
