// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "holdfast/model/robot.hpp"

namespace holdfast::solver {

/// The axis, that is half of a direction, along which each module of a part of a robot only passes
/// forces on, or -1; of copies what their ranks say. The solver makes straight runs of such modules
/// into one beam, for which each rank that has one of them needs copies of all and of both ends.
std::vector<std::int8_t> passage_axes(const model::Robot& robot);

}  // namespace holdfast::solver
