// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
// The program around the agent, on a port that is a script: who is there, what is remembered.
#include "holdfast/module/module.hpp"

#include <gtest/gtest.h>

#include <vector>

#include "holdfast/module/configuration.hpp"

namespace holdfast::module {
namespace {

using Packet = std::vector<std::uint8_t>;

class ScriptedPort final : public Port {
 public:
  Time now() override { return time; }

  std::uint16_t random() override { return ++random_; }

  bool receive(Incoming& incoming) override {
    if (plans.empty()) {
      return false;
    }
    payload_ = plans.back();
    plans.pop_back();
    incoming = {.face = 2, .kind = FrameKind::kPlan, .payload = payload_};
    return true;
  }

  bool is_connected(int face) override { return ((connected >> face) & 1) != 0; }

  bool is_line_free(int) override { return true; }

  void send(int face, std::span<const std::uint8_t> packet) override {
    sent.emplace_back(packet.begin(), packet.end());
    sent_face = face;
  }

  void show(const agent::Colour& colour) override { lamp = colour; }

  void wait(Time until) override {
    time = until > time && until < time + 1000 ? until : time + 1000;
  }

  Time time = 0;
  int connected = 0;
  std::vector<Packet> plans;
  std::vector<Packet> sent;
  int sent_face = -1;
  agent::Colour lamp;

 private:
  std::uint16_t random_ = 0;
  Packet payload_;
};

/// One module on the ground, alone: it holds whatever its material.
Configuration lonely() {
  Configuration configuration;
  configuration.identity = {.id = 1, .is_fixed = true, .is_anchor = true, .cell = {0, 0, 0}};
  configuration.setup.section = {.elastic_modulus = 100,
                                 .length = 40,
                                 .area = 1600,
                                 .moment_x = 2e5,
                                 .moment_y = 2e5,
                                 .torsion = 2e5};
  configuration.setup.weight_n = 0.6;
  configuration.setup.strength_vertical_n = 10;
  configuration.setup.strength_lateral_n = 10;
  agent::prepare(configuration.setup);
  configuration.checksum = checksum_of(configuration);
  return configuration;
}

TEST(Configuration, is_valid_as_written_and_not_when_damaged) {
  Configuration configuration = lonely();
  EXPECT_TRUE(is_valid(configuration));
  configuration.setup.weight_n = 0.7;
  EXPECT_FALSE(is_valid(configuration));
  Configuration empty;
  empty.magic = 0xffffffff;
  EXPECT_FALSE(is_valid(empty));
}

TEST(Module, alone_and_fixed_is_safe_and_shows_blue) {
  const Configuration configuration = lonely();
  PlanMemory plans{};
  ScriptedPort port;
  Module module(configuration, plans, port);
  for (int i = 0; i < 100; ++i) {
    module.run_once();
  }
  EXPECT_EQ(module.status().verdict, agent::Verdict::kSafe);
  EXPECT_EQ(port.lamp.blue, agent::colour_of(agent::Verdict::kSafe, 0, true, true).blue);
  EXPECT_GT(port.lamp.blue, 0);
}

TEST(Module, greets_a_neighbour_each_time_it_comes) {
  const Configuration configuration = lonely();
  PlanMemory plans{};
  ScriptedPort port;
  Module module(configuration, plans, port);
  port.connected = 1 << 3;
  module.run_once();
  ASSERT_FALSE(port.sent.empty());
  EXPECT_EQ(port.sent_face, 3);
  const Packet first = port.sent.front();
  EXPECT_EQ(first[0] >> 6, static_cast<int>(agent::wire::PacketKind::kHello));
  port.connected = 0;
  module.run_once();
  port.sent.clear();
  port.connected = 1 << 3;
  module.run_once();
  ASSERT_FALSE(port.sent.empty());
  // Another number: another session.
  EXPECT_NE(port.sent.front(), first);
}

/// Only `undecided` is true of a robot with a module that no longer answers, and never `safe`.
TEST(Module, a_neighbour_that_is_gone_is_not_forgotten) {
  const Configuration configuration = lonely();
  PlanMemory plans{};
  ScriptedPort port;
  Module module(configuration, plans, port);
  port.connected = 1 << 0;
  module.run_once();
  port.connected = 0;
  for (int i = 0; i < 60'000; ++i) {
    module.run_once();
  }
  EXPECT_EQ(module.status().verdict, agent::Verdict::kUndecided);
  EXPECT_EQ(module.status().reason, agent::Reason::kNeighbourSilent);
}

TEST(Module, remembers_a_plan_over_a_reset) {
  const Configuration configuration = lonely();
  PlanMemory plans{};
  {
    ScriptedPort port;
    Module module(configuration, plans, port);
    // Far away from the robot: no verdict on such a robot is possible.
    port.plans = {{9, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0}};
    module.run_once();
    EXPECT_EQ(module.status().plan_count, 1U);
  }
  ScriptedPort port;
  Module module(configuration, plans, port);
  for (int i = 0; i < 100; ++i) {
    module.run_once();
  }
  EXPECT_EQ(module.status().plan_count, 1U);
  EXPECT_EQ(module.status().verdict, agent::Verdict::kUndecided);
  EXPECT_EQ(module.status().reason, agent::Reason::kPlannedDetached);
}

TEST(Module, starts_without_plans_when_its_memory_is_noise) {
  const Configuration configuration = lonely();
  PlanMemory plans{.magic = 1, .count = 77, .coordinates = {}, .checksum = 5};
  ScriptedPort port;
  const Module module(configuration, plans, port);
  EXPECT_EQ(module.status().plan_count, 0U);
}

}  // namespace
}  // namespace holdfast::module
