// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <vector>

#include "holdfast/sim/simulation.hpp"
#include "noise.hpp"
#include "port.hpp"
#include "world/environment_map.hpp"

namespace holdfast::sim {

/// The modules of a simulated robot, and what they have in common.
struct Modules {
  Modules(const model::Robot& the_robot, SimulationOptions the_options);

  static std::size_t at(std::int32_t module) { return static_cast<std::size_t>(module); }

  std::int32_t count() const { return static_cast<std::int32_t>(agents.size()); }

  /// The neighbour's index, or -1 if there is none or it is only planned.
  std::int32_t neighbour(std::int32_t module, base::Direction face) const {
    const std::int32_t other =
        robot.neighbours()[at(module)][static_cast<std::size_t>(base::index(face))];
    return other < count() ? other : model::Robot::kNoNeighbour;
  }

  Lines& lines(std::int32_t module, int face) {
    return face < base::kDirectionCount ? ports[at(module)].lines : more_lines[at(module)];
  }

  /// A new agent at the place of a module.
  void begin_anew(std::int32_t module);

  const model::Robot& robot;
  SimulationOptions options;
  agent::Setup setup;
  Noise noise;
  bool is_noisy;
  std::array<Time, agent::wire::kPacketBytesMax + 1> line_times{};  ///< By packet size.
  std::vector<agent::Agent> agents;
  LentStore lent;
  std::vector<Port> ports;
  std::vector<Lines> more_lines;  ///< Of faces that cubes do not have.
};

}  // namespace holdfast::sim
