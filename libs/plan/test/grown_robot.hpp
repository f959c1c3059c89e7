// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>

#include "holdfast/base/lattice.hpp"
#include "holdfast/base/rng.hpp"
#include "holdfast/model/robot.hpp"

namespace holdfast::plan::test {

/// A robot without a floor that has grown at random from a fixed module to so many.
inline model::RobotSpec grown_robot(const base::Lattice& lattice, std::size_t count,
                                    base::Rng& rng) {
  model::RobotSpec spec{.support_z = std::nullopt};
  spec.lattice = lattice;
  spec.fixed = {{0, 0, 0}};
  spec.existing = spec.fixed;
  while (spec.existing.size() < count) {
    const base::Cell& beside = spec.existing[rng.below(spec.existing.size())];
    const auto direction = static_cast<base::Direction>(
        rng.below(static_cast<std::uint64_t>(lattice.direction_count)));
    const base::Cell next = base::neighbour(lattice, beside, direction);
    if (std::ranges::find(spec.existing, next) == spec.existing.end()) {
      spec.existing.push_back(next);
    }
  }
  return spec;
}

}  // namespace holdfast::plan::test
