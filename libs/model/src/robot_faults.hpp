// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <string>

#include "holdfast/model/robot.hpp"

/// What can be wrong with a robot. Each function returns the first fault that it finds: what was
/// found, where, and what is allowed.
namespace holdfast::model {

/// In numbers and coordinates, of anything that a spec has.
std::optional<std::string> find_number_fault(const RobotSpec& spec);

/// In what hangs together: existing modules among each other, then planned ones with them.
std::optional<std::string> find_connection_fault(const Connections& connections,
                                                 std::span<const Module> modules,
                                                 std::size_t existing_count);

/// In what holds the robot.
std::optional<std::string> find_support_fault(const Robot& robot, const RobotSpec& spec);

}  // namespace holdfast::model
