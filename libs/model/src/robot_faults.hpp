// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <string>

#include "holdfast/model/robot.hpp"

/// Finds what can be wrong with a robot. Each function returns the first fault that it finds: what
/// was found, where, and what is allowed.
namespace holdfast::model {

/// Finds a fault in the numbers and coordinates of a spec.
std::optional<std::string> find_number_fault(const RobotSpec& spec);

/// Finds existing modules that are not connected with each other, then planned ones that are not
/// connected with them.
std::optional<std::string> find_connection_fault(const Connections& connections,
                                                 std::span<const Module> modules,
                                                 std::size_t existing_count);

/// Finds a fault in what holds the robot.
std::optional<std::string> find_support_fault(const Robot& robot, const RobotSpec& spec);

}  // namespace holdfast::model
