// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include "holdfast/host/ranks.hpp"
#include "holdfast/model/robot.hpp"

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

/// How many of a robot's modules are this rank's own: all of them where it is in one piece.
inline std::size_t own_module_count(const Robot& robot, const RobotPart* part) {
  return part == nullptr ? robot.modules().size() : part->own_count;
}

/// How many modules the whole robot has, of all ranks.
inline std::size_t whole_module_count(const Robot& robot, const RobotPart* part) {
  return host::total(ranks_of(part), own_module_count(robot, part));
}

}  // namespace holdfast::model
