// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
// Faults happen to whom and when they should, and no verdict is given that ignores them.
#include "holdfast/sim/fault.hpp"

#include <gtest/gtest.h>

#include "robots.hpp"

namespace holdfast::sim {
namespace {

using Kind = Fault::Kind;

/// All living modules know a verdict, and it is this one.
void expect_verdict(const Simulation& simulation, agent::Verdict verdict) {
  EXPECT_TRUE(simulation.result().is_quiet);
  for (std::int32_t i = 0; i < simulation.agent_count(); ++i) {
    if (simulation.is_alive(i)) {
      EXPECT_EQ(simulation.agent(i).answer().verdict, verdict) << "module " << i;
    }
  }
}

TEST(Fault, of_a_silent_module_makes_the_verdict_undecided) {
  const model::Robot robot = make_robot(cube(3));
  for (const Time at : {Time{0}, Time{30}, Time{100}}) {
    PacketLog log;
    Simulation simulation(
        robot, {.faults = {{.kind = Kind::kKill, .at = at, .module = 13}}, .trace = &log});
    simulation.run();
    EXPECT_FALSE(simulation.is_alive(13));
    EXPECT_TRUE(simulation.is_alive(12));
    expect_verdict(simulation, agent::Verdict::kUndecided);
    EXPECT_EQ(simulation.result().answer.reason, agent::Reason::kNeighbourSilent);
    EXPECT_FALSE(log.lost.empty());
    for (const SeenPacket& packet : log.sent) {
      EXPECT_TRUE(packet.from != 13 || packet.time <= at);
    }
  }
}

TEST(Fault, of_a_cut_link_drops_both_ways) {
  // The middle module of the cube loses its link to +x; both ends still have five others.
  const model::Robot robot = make_robot(cube(3));
  PacketLog log;
  Simulation simulation(
      robot,
      {.faults = {{.kind = Kind::kCut, .at = 50, .module = 13, .face = base::Direction::kPlusX}},
       .trace = &log});
  simulation.run();
  expect_verdict(simulation, agent::Verdict::kUndecided);
  for (const SeenPacket& packet : log.delivered) {
    const bool is_cut =
        (packet.from == 13 && packet.face == 0) || (packet.from == 14 && packet.face == 1);
    EXPECT_FALSE(is_cut && packet.time >= 50) << packet.time;
  }
}

TEST(Fault, of_a_module_taken_off_leads_to_the_verdict_without_it) {
  // The arm breaks off nothing when its last existing module is gone.
  model::RobotSpec spec = cube(2);
  spec.existing.push_back({2, 0, 1});
  const model::Robot robot = make_robot(spec);
  for (const Time at : {Time{0}, Time{40}, Time{100'000}}) {
    Simulation simulation(robot, {.faults = {{.kind = Kind::kDetach, .at = at, .module = 8}}});
    simulation.run();
    EXPECT_FALSE(simulation.is_alive(8));
    expect_verdict(simulation, agent::Verdict::kSafe);
    EXPECT_TRUE(simulation.result().all_agree);
    EXPECT_EQ(simulation.result().effort.module_count, 8U);
  }
}

TEST(Fault, of_a_module_put_on_leads_to_the_verdict_with_it) {
  model::RobotSpec spec = cube(2);
  spec.existing.push_back({2, 0, 1});
  const model::Robot robot = make_robot(spec);
  for (const Time at : {Time{0}, Time{40}, Time{100'000}}) {
    Simulation simulation(robot, {.faults = {{.kind = Kind::kAttach, .at = at, .module = 8}}});
    simulation.run();
    EXPECT_TRUE(simulation.is_alive(8));
    expect_verdict(simulation, agent::Verdict::kSafe);
    EXPECT_TRUE(simulation.result().all_agree);
    EXPECT_EQ(simulation.result().effort.module_count, 9U);
    EXPECT_TRUE(simulation.agent(8).has_cell());
    EXPECT_EQ(simulation.agent(8).cell(), (base::Cell{2, 0, 1}));
  }
}

/// The new module closes a ring, so two neighbours welcome it; what one of them says of plans and
/// of how it moves may be sent again, and arrive when the module has long had its place below the
/// other.
TEST(Fault, of_a_module_put_on_between_two_is_survived_by_lossy_links) {
  for (const std::vector<base::Cell>& planned :
       {std::vector<base::Cell>{}, {{2, 0, 0}, {2, 0, 1}}}) {
    const model::Robot robot =
        make_robot({.existing = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}, .planned = planned});
    LinkModel link = blinky_blocks_v1();
    link.loss = 0.15;
    for (std::uint64_t seed = 1; seed <= 24; ++seed) {
      Simulation simulation(robot,
                            {.link = link,
                             .seed = seed,
                             .faults = {{.kind = Kind::kAttach, .at = 100'000'000, .module = 3}}});
      simulation.run();
      SCOPED_TRACE(::testing::Message() << "seed " << seed << ", planned " << planned.size());
      expect_verdict(simulation, agent::Verdict::kSafe);
      for (std::int32_t i = 0; i < simulation.agent_count(); ++i) {
        EXPECT_EQ(simulation.agent(i).refused_count(), 0) << "module " << i;
      }
    }
  }
}

TEST(Fault, list_may_take_a_module_off_and_put_it_on_again) {
  const model::Robot robot = make_robot(cube(2));
  for (const Time gap : {Time{1}, Time{20}, Time{2000}}) {
    const SimulationOptions options{.faults = {{.kind = Kind::kDetach, .at = 60, .module = 7},
                                               {.kind = Kind::kAttach, .at = 60 + gap, .module = 7},
                                               {.kind = Kind::kKill, .at = 10'000, .module = 3},
                                               {.kind = Kind::kDetach, .at = 20'000, .module = 3},
                                               {.kind = Kind::kAttach, .at = 30'000, .module = 3}}};
    Simulation simulation(robot, options);
    simulation.run();
    expect_verdict(simulation, agent::Verdict::kSafe);
    EXPECT_TRUE(simulation.is_alive(3));
    EXPECT_EQ(simulation.result().effort.module_count, 8U) << "gap " << gap;
  }
}

/// The modules are not told, and long after the link is lost only its two ends can notice that it
/// carries.
TEST(Fault, of_a_link_ends_when_it_carries_again) {
  model::RobotSpec spec = cube(2);
  spec.existing.push_back({2, 0, 1});
  const model::Robot robot = make_robot(spec);
  for (const Time gap : {Time{1}, Time{300}, Time{100'000}}) {
    Simulation simulation(
        robot,
        {.faults = {{.kind = Kind::kCut, .at = 60, .module = 8, .face = base::Direction::kMinusX},
                    {.kind = Kind::kMend,
                     .at = 60 + gap,
                     .module = 8,
                     .face = base::Direction::kMinusX}}});
    simulation.run();
    expect_verdict(simulation, agent::Verdict::kSafe);
    EXPECT_TRUE(simulation.result().all_agree) << gap;
    EXPECT_EQ(simulation.result().effort.module_count, 9U);
  }
}

TEST(Fault, of_a_connection_opened_and_closed_again_leads_to_both_verdicts) {
  model::RobotSpec spec = cube(2);
  spec.existing.push_back({2, 0, 1});
  const model::Robot robot = make_robot(spec);
  const Fault open{.kind = Kind::kUnplug, .at = 60, .module = 8, .face = base::Direction::kMinusX};
  Fault close = open;
  close.kind = Kind::kPlug;
  close.at = 500;
  for (const bool is_closed : {false, true}) {
    Simulation simulation(robot,
                          {.faults = is_closed ? std::vector{open, close} : std::vector{open}});
    simulation.run();
    EXPECT_EQ(simulation.agent(0).answer().verdict, agent::Verdict::kSafe);
    EXPECT_EQ(simulation.result().all_agree, is_closed);
  }
}

/// A module starts again as after a power failure: its neighbours stay, and have not noticed.
TEST(Fault, of_a_module_that_starts_again_leads_to_the_verdict_with_it) {
  const model::Robot robot = make_robot(cube(2));
  for (const agent::Method method : {agent::Method::kElimination, agent::Method::kFronts}) {
    for (const Time at : {Time{5}, Time{60}, Time{5000}}) {
      Simulation simulation(robot, {.method = method,
                                    .faults = {{.kind = Kind::kKill, .at = 20'000, .module = 3},
                                               {.kind = Kind::kReset, .at = at, .module = 7},
                                               {.kind = Kind::kReset, .at = 40'000, .module = 3}}});
      simulation.run();
      expect_verdict(simulation, agent::Verdict::kSafe);
      EXPECT_TRUE(simulation.result().all_agree) << at;
      EXPECT_TRUE(simulation.is_alive(3));
    }
  }
}

TEST(Fault, list_works_with_busy_modules_and_bad_lines) {
  const model::Robot robot = make_robot(cube(2));
  LinkModel link = blinky_blocks_v1();
  link.compute_time = 3'000;
  link.loss = 0.1;
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    const SimulationOptions options{
        .link = link,
        .seed = seed,
        .faults = {{.kind = Kind::kDetach, .at = 100'000 * seed, .module = 7},
                   {.kind = Kind::kAttach, .at = 103'000 * seed, .module = 7}}};
    Simulation simulation(robot, options);
    simulation.run();
    expect_verdict(simulation, agent::Verdict::kSafe);
    EXPECT_EQ(simulation.result().effort.module_count, 8U) << "seed " << seed;
  }
}

TEST(Announcement, leads_to_the_verdict_of_the_robot_with_the_planned_module) {
  const model::Robot planned = make_robot(arm(1));
  const SimulationResult expected = simulate(planned, {});
  const model::Robot bare = make_robot(arm(0));
  for (const Time at : {Time{0}, Time{25}, Time{5000}}) {
    const SimulationResult result =
        simulate(bare, {.announcements = {{.at = at, .module = 2, .cell = {1, 0, 1}}}});
    EXPECT_TRUE(result.all_agree);
    EXPECT_EQ(result.answer.verdict, expected.answer.verdict);
    EXPECT_EQ(result.effort.module_count, 4U);
  }
}

}  // namespace
}  // namespace holdfast::sim
