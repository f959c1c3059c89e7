// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "holdfast/model/robot.hpp"

namespace holdfast::test {

/// A connected robot of 3 to 410 modules, four in five of them more than 128, on a few feet on
/// z = 0, the same for a seed everywhere: towers on plates, decks on legs, tables, free growth, all
/// with growth on top, so that feet tilt, lift and hardly press. Up to nine planned modules.
model::RobotSpec standing_robot(std::uint64_t seed);

/// Ways in which a robot can be turned about the vertical and mirrored: the symmetries of a square.
inline constexpr int kTurnCount = 8;

/// The cell mirrored in x if `turn` is 4 or more, then turned by `turn` quarters.
base::Cell turned(base::Cell cell, int turn);

/// The robot turned, its modules listed in another order for each `order`; 0 is the robot's own.
model::RobotSpec turned(model::RobotSpec spec, int turn, std::uint64_t order = 0);

}  // namespace holdfast::test
