// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
// The program around the agent, on a port that is a script: who is there, what is remembered.
#include "holdfast/module/module.hpp"

#include <gtest/gtest.h>

#include <cstring>
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
  Module module(configuration.setup, configuration.identity, plans, port);
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
  Module module(configuration.setup, configuration.identity, plans, port);
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
  Module module(configuration.setup, configuration.identity, plans, port);
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
    Module module(configuration.setup, configuration.identity, plans, port);
    // Far away from the robot: no verdict on such a robot is possible.
    port.plans = {{9, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0}};
    module.run_once();
    EXPECT_EQ(module.status().plan_count, 1U);
  }
  ScriptedPort port;
  Module module(configuration.setup, configuration.identity, plans, port);
  for (int i = 0; i < 100; ++i) {
    module.run_once();
  }
  EXPECT_EQ(module.status().plan_count, 1U);
  EXPECT_EQ(module.status().verdict, agent::Verdict::kUndecided);
  EXPECT_EQ(module.status().reason, agent::Reason::kPlannedDetached);
}

Packet frame_of(const base::Cell& cell, bool is_withdrawal = false) {
  Packet payload;
  for (const std::int32_t value : {cell.x, cell.y, cell.z}) {
    for (unsigned shift = 0; shift < 32; shift += 8) {
      payload.push_back(static_cast<std::uint8_t>(static_cast<std::uint32_t>(value) >> shift));
    }
  }
  if (is_withdrawal) {
    payload.push_back(1);
  }
  return payload;
}

/// Hands the plans in, last one first, and runs until the verdict; a start with this memory.
Status started(PlanMemory& plans, const std::vector<Packet>& told) {
  const Configuration configuration = lonely();
  ScriptedPort port;
  Module module(configuration.setup, configuration.identity, plans, port);
  port.plans = told;
  for (int i = 0; i < 100; ++i) {
    module.run_once();
  }
  return module.status();
}

PlanMemory::Copy& latest(PlanMemory& plans) {
  return plans.copies[plans.copies[0].number < plans.copies[1].number ? 1 : 0];
}

/// The plan is for the module's own cell: the module planned there is there.
TEST(Module, forgets_a_plan_that_is_fulfilled_and_a_reset_does_not_bring_it_back) {
  PlanMemory plans{};
  Status status = started(plans, {frame_of({0, 0, 0})});
  EXPECT_EQ(status.plan_count, 0U);
  EXPECT_EQ(status.verdict, agent::Verdict::kSafe);
  status = started(plans, {});
  EXPECT_EQ(status.plan_count, 0U);
  EXPECT_EQ(status.verdict, agent::Verdict::kSafe);
}

TEST(Module, forgets_a_plan_that_is_withdrawn_and_a_reset_does_not_bring_it_back) {
  PlanMemory plans{};
  EXPECT_EQ(started(plans, {frame_of({9, 0, 0})}).reason, agent::Reason::kPlannedDetached);
  EXPECT_EQ(started(plans, {frame_of({8, 0, 0}, true)}).plan_count, 1U);
  const Status status = started(plans, {frame_of({9, 0, 0}, true)});
  EXPECT_EQ(status.plan_count, 0U);
  EXPECT_EQ(status.verdict, agent::Verdict::kSafe);
  EXPECT_EQ(started(plans, {}).verdict, agent::Verdict::kSafe);
}

TEST(Module, remembers_over_a_reset_that_it_was_told_too_much_until_all_is_withdrawn) {
  PlanMemory plans{};
  std::vector<Packet> many;
  for (int i = 0; i <= agent::kAnnouncedMax; ++i) {
    many.push_back(frame_of({0, 0, 1 + i}));
  }
  EXPECT_EQ(started(plans, many).reason, agent::Reason::kPlannedTooMany);
  EXPECT_EQ(started(plans, {}).reason, agent::Reason::kPlannedTooMany);
  EXPECT_EQ(started(plans, {frame_of(agent::kEveryCell, true)}).verdict, agent::Verdict::kSafe);
  EXPECT_EQ(started(plans, {}).plan_count, 0U);
}

/// A withdrawal that no round has carried yet is kept as well: a neighbour is silent meanwhile.
TEST(Module, remembers_a_withdrawal_over_a_reset) {
  const Configuration configuration = lonely();
  PlanMemory plans{};
  {
    ScriptedPort port;
    Module module(configuration.setup, configuration.identity, plans, port);
    port.connected = 1;
    port.plans = {frame_of({9, 0, 0}, true)};
    module.run_once();
  }
  const auto& told = plans.copies[1].told;
  ASSERT_EQ(told.count(), 1);
  EXPECT_EQ(told.told(0), agent::Told::kWithdrawal);
  EXPECT_EQ(started(plans, {}).plan_count, 0U);
  EXPECT_EQ(latest(plans).told, agent::Announcements());  // Carried now, and forgotten.
}

/// A reset in the midst of writing: one copy is damaged, the other one is what was before.
TEST(Module, keeps_the_plans_before_when_a_reset_spoils_the_writing) {
  PlanMemory plans{};
  started(plans, {frame_of({9, 0, 0})});
  const PlanMemory whole = plans;
  latest(plans).told.plan({8, 0, 0});
  // Known already, then new: the copy before has the plan, too.
  EXPECT_EQ(started(plans, {}).plan_count, 1U);
  for (std::size_t i = 0; i < plans.copies.size(); ++i) {
    PlanMemory half = whole;
    half.copies[i].checksum ^= 1U;
    EXPECT_EQ(started(half, {}).plan_count, 1U);
  }
}

TEST(Module, takes_no_frame_of_another_form) {
  PlanMemory plans{};
  Packet odd = frame_of({9, 0, 0}, true);
  odd.back() = 2;
  Packet longer = frame_of({9, 0, 0}, true);
  longer.push_back(1);
  EXPECT_EQ(started(plans, {odd, longer, {1, 2, 3}, {}}).verdict, agent::Verdict::kSafe);
}

TEST(Module, starts_without_plans_when_its_memory_is_noise) {
  const Configuration configuration = lonely();
  PlanMemory plans{};
  std::memset(static_cast<void*>(&plans), 0xa5, sizeof(plans));
  ScriptedPort port;
  const Module module(configuration.setup, configuration.identity, plans, port);
  EXPECT_EQ(module.status().plan_count, 0U);
}

}  // namespace
}  // namespace holdfast::module
