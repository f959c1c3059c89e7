// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "holdfast/model/robot.hpp"

namespace holdfast::solver {

/// A module, and the Morton key of its cell from the robot's lowest corner on: the bits of x, y and
/// z in turns, from the lowest.
struct KeyedModule {
  std::uint64_t key = 0;
  std::int32_t module = 0;
};

/// Modules along the Morton curve, which keeps neighbours near each other.
struct MortonOrder {
  std::vector<KeyedModule> modules;
  base::Cell low;           ///< The robot's lowest corner.
  std::int32_t extent = 0;  ///< Longest side of the box around them, pitches.
};

/// Sorts the modules that are not `is_gone`.
MortonOrder morton_order(const model::Robot& robot, const std::vector<std::uint8_t>& is_gone);

}  // namespace holdfast::solver
