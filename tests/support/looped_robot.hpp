// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "holdfast/model/robot.hpp"

namespace holdfast::test {

struct LoopedRobot {
  std::string name;
  model::RobotSpec spec;
};

/// Twenty robots with more loops at a module than elimination over the tree can hold, or with
/// planned modules between others: blocks, walls, ladders, rings, frames. All of them are on a
/// floor.
std::vector<LoopedRobot> looped_robots();

}  // namespace holdfast::test
