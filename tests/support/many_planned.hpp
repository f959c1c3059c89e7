// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>

#include "holdfast/model/robot.hpp"

namespace holdfast::test {

/// random_robot(seed) with 6 to `planned_max` planned modules in place of its own, the same for a
/// seed everywhere. The seeds take turns at three ways of planning: anywhere, one pile on one
/// another, and where most modules are touched, between several of them. Every second robot's first
/// module is fixed, as many topple under so many.
model::RobotSpec many_planned_robot(std::uint64_t seed, std::size_t planned_max = 30);

}  // namespace holdfast::test
