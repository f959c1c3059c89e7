// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include "holdfast/host/ranks.hpp"

namespace holdfast::model {

/// What of a robot one of several processes has: a Robot made by Robot::create_part(), whose first
/// modules are its own, and whose others are copies of those neighbours that other ranks own.
struct RobotPart {
  host::Ranks* ranks = nullptr;
  std::size_t own_count = 0;       ///< Modules.
  std::vector<host::Copy> copies;  ///< Of modules: all from own_count on.
};

/// Those that a part is shared with; none where the robot is in one piece.
inline host::Ranks* ranks_of(const RobotPart* part) {
  return part == nullptr ? nullptr : part->ranks;
}

}  // namespace holdfast::model
