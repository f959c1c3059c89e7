// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>

#include "holdfast/model/robot.hpp"

namespace holdfast::test {

/// A connected robot of 3 to 60 modules standing on z = 0, the same for a seed everywhere. The
/// seeds take turns at four ways of building: free growth, walls with doors and windows, beams and
/// arms that overhang, and feet with gaps under a common deck. Up to four planned modules.
model::RobotSpec random_robot(std::uint64_t seed);

/// Returns a random robot with `count_min` to `count_max` existing modules, built in two more ways:
/// spirals and ladders on a foot of 3 x 3. The first module of every fifth is fixed, as most large
/// and freely grown robots topple.
model::RobotSpec random_robot(std::uint64_t seed, std::size_t count_min, std::size_t count_max);

}  // namespace holdfast::test
