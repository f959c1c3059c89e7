// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "holdfast/base/result.hpp"
#include "holdfast/model/robot.hpp"

/// Robots for simulators of rigid bodies.
namespace holdfast::io {

/// The formats of robots as links and joints: that of ROS, and that of Gazebo.
enum class RobotDescription : std::uint8_t { kUrdf, kSdf };

/// Writes a robot as one rigid body of links: each module, planned ones included, is a link with
/// its mass, its inertia as a solid body of even density, and its shape; fixed joints along a tree
/// of the connections hold them together, and a fixed module to the world. Lengths are in m, masses
/// in kg; the frame is the global one, with its origin in the node of the cell (0,0,0). An error if
/// connections do not join all modules, as such a robot is no tree.
base::Result<std::string> write_robot_description(const model::Robot& robot, std::string_view name,
                                                  RobotDescription format);

/// Says what such a file leaves out of a robot; empty if nothing.
std::vector<std::string> lost_in_robot_description(const model::Robot& robot);

}  // namespace holdfast::io
