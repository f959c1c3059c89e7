// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <cstdint>
#include <vector>

#include "holdfast/sim/simulation.hpp"

/// Small robots, and a sink that remembers every packet.
namespace holdfast::sim {

inline model::Robot make_robot(const model::RobotSpec& spec) {
  auto robot = model::Robot::create(spec);
  EXPECT_TRUE(robot) << (robot ? "" : robot.error().message);
  return std::move(robot).value();
}

/// A cube on the ground; module 0 is its corner at the origin.
inline model::RobotSpec cube(std::int32_t size) {
  model::RobotSpec spec;
  for (std::int32_t i = 0; i < size * size * size; ++i) {
    spec.existing.push_back({i % size, i / size % size, i / size / size});
  }
  return spec;
}

/// A post of two modules on a foot of two, with an arm of `length` planned modules.
inline model::RobotSpec arm(std::int32_t length) {
  model::RobotSpec spec{.existing = {{0, 0, 0}, {1, 0, 0}, {0, 0, 1}}};
  for (std::int32_t i = 0; i < length; ++i) {
    spec.planned.push_back({1 + i, 0, 1});
  }
  return spec;
}

inline SimulationResult simulate(const model::Robot& robot, const SimulationOptions& options) {
  Simulation simulation(robot, options);
  simulation.run();
  return simulation.result();
}

struct SeenPacket {
  Time time = 0;
  Time line_time = 0;
  std::uint64_t number = 0;
  std::int32_t from = 0;
  int face = 0;
  std::vector<std::uint8_t> bytes = {};
};

class PacketLog : public TraceSink {
 public:
  void packet_sent(const PacketTrace& packet, Time line_time) override {
    sent.push_back(seen(packet, line_time));
  }

  void packet_delivered(const PacketTrace& packet) override {
    delivered.push_back(seen(packet, 0));
  }

  void packet_lost(const PacketTrace& packet) override { lost.push_back(seen(packet, 0)); }

  std::vector<SeenPacket> sent;
  std::vector<SeenPacket> delivered;
  std::vector<SeenPacket> lost;

 private:
  static SeenPacket seen(const PacketTrace& packet, Time line_time) {
    return {.time = packet.time,
            .line_time = line_time,
            .number = packet.number,
            .from = packet.from,
            .face = base::index(packet.face),
            .bytes = {packet.bytes.begin(), packet.bytes.end()}};
  }
};

}  // namespace holdfast::sim
