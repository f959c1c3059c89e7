// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "holdfast/limit/limit_load.hpp"
#include "holdfast/model/robot.hpp"

namespace holdfast::io {

/// Writes what the page shows of a limit load as JSON: the factor (null: none is too large), the
/// connections that give way and the velocities of the modules; null if none was found.
std::string collapse_json(const model::Robot& robot, const limit::LimitLoad& load);

}  // namespace holdfast::io
