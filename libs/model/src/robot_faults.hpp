// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

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

/// The modules that are connected with each other, by ascending index; the largest piece first.
std::vector<std::vector<std::int32_t>> pieces_of(const Connections& connections,
                                                 std::size_t module_count);

/// Finds pieces of a robot that nothing holds, or that are planned only.
std::optional<std::string> find_loose_fault(const std::vector<std::vector<std::int32_t>>& pieces,
                                            std::span<const Module> modules);

/// Finds a fault in what holds the robot.
std::optional<std::string> find_support_fault(const Robot& robot, const RobotSpec& spec);

}  // namespace holdfast::model
