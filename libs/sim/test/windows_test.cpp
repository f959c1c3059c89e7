// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
// Events that are handled in groups, by several threads, against the same events one by one.
#include <gtest/gtest.h>

#include <array>
#include <string>
#include <utility>

#include "holdfast/base/rng.hpp"
#include "holdfast/sim/simulation.hpp"
#include "random_robot.hpp"
#include "robots.hpp"
#include "seeds.hpp"

namespace holdfast::sim {
namespace {

constexpr std::size_t kNoWindow = ~std::size_t{0};

/// What of a result must not depend on windows: all of it.
void expect_same(const SimulationResult& a, const SimulationResult& b, const std::string& where) {
  EXPECT_EQ(a.trace_hash, b.trace_hash) << where;  // Of every packet, with its time, in order.
  EXPECT_EQ(a.time, b.time) << where;
  EXPECT_EQ(a.verdict_time, b.verdict_time) << where;
  EXPECT_EQ(a.rounds, b.rounds) << where;
  EXPECT_EQ(a.events, b.events) << where;
  EXPECT_EQ(a.is_quiet, b.is_quiet) << where;
  EXPECT_EQ(a.packets, b.packets) << where;
  EXPECT_EQ(a.bytes, b.bytes) << where;
  EXPECT_EQ(a.data_packets, b.data_packets) << where;
  EXPECT_EQ(a.payload_bytes, b.payload_bytes) << where;
  EXPECT_EQ(a.lost_packets, b.lost_packets) << where;
  EXPECT_EQ(a.packets_module_max, b.packets_module_max) << where;
  EXPECT_EQ(a.bytes_module_max, b.bytes_module_max) << where;
  EXPECT_EQ(a.all_agree, b.all_agree) << where;
  EXPECT_TRUE(is_same(a.answer, b.answer)) << where;
  EXPECT_EQ(a.root, b.root) << where;
  EXPECT_EQ(a.effort.iterations, b.effort.iterations) << where;
  EXPECT_EQ(a.epoch, b.epoch) << where;
  for (std::size_t i = 0; i < kPhaseCount; ++i) {
    EXPECT_EQ(a.phases[i].packets, b.phases[i].packets) << where << ", phase " << i;
    EXPECT_EQ(a.phases[i].bytes, b.phases[i].bytes) << where << ", phase " << i;
    EXPECT_EQ(a.phases[i].time, b.phases[i].time) << where << ", phase " << i;
    EXPECT_EQ(a.phases[i].rounds, b.phases[i].rounds) << where << ", phase " << i;
  }
}

/// All that a link model can do, by chance.
LinkModel random_link(base::Rng& rng) {
  LinkModel link = *find_link_model(std::array{"unit", "v1", "v2"}[rng.below(3)]);
  const bool has_length = link.ticks_per_second > 0;
  link.latency = rng.below(2) == 0 ? 0 : rng.below(has_length ? 3000 : 4);
  if (rng.below(2) == 0) {
    link.jitter = rng.below(has_length ? 6000 : 3);
    link.loss = 0.02;
    link.duplication = 0.02;
    link.corruption = 0.02;
    link.reordering = 0.02;
    link.reordering_delay = has_length ? 9000 : 3;
    link.clock_drift = 0.001;
  }
  return link;
}

/// Faults, plans and a watch, by chance, and some modules that come late.
void add_changes(const model::Robot& robot, base::Rng& rng, SimulationOptions& options) {
  const Time second = options.link.ticks_per_second > 0 ? options.link.ticks_per_second : 200;
  const std::size_t count = robot.modules().size() - robot.planned_count();
  const auto module = [&] { return static_cast<std::int32_t>(rng.below(count)); };
  for (std::uint64_t i = rng.below(3); i > 0; --i) {
    options.faults.push_back({.kind = rng.below(2) == 0 ? Fault::Kind::kKill : Fault::Kind::kReset,
                              .at = rng.below(8 * second),
                              .module = module()});
  }
  if (rng.below(3) == 0) {
    options.announcements.push_back(
        {.at = rng.below(8 * second), .module = module(), .cell = {100, 100, 100}});
  }
  options.watch_for = rng.below(3) == 0 ? 5 * second : 0;
  options.time_max = rng.below(4) == 0 ? rng.below(6 * second) : agent::kNever;
}

TEST(Windows, change_nothing_that_any_robot_does) {
  std::uint64_t window_count = 0;
  const std::uint64_t robot_count = test::campaign(100);
  for (std::uint64_t seed = 0; seed < robot_count; ++seed) {
    base::Rng rng(seed);
    const model::Robot robot = make_robot(test::random_robot(seed));
    SimulationOptions options{.link = random_link(rng), .seed = seed, .event_count_max = 2'000'000};
    if (rng.below(2) == 0) {
      add_changes(robot, rng, options);
    }
    options.window_events_min = kNoWindow;
    const SimulationResult one_by_one = simulate(robot, options);
    for (const auto& [thread_count, least] : {std::pair{2, 1}, {1, 40}}) {
      options.thread_count = thread_count;
      options.window_events_min = static_cast<std::size_t>(least);
      Simulation simulation(robot, options);
      simulation.run();
      expect_same(simulation.result(), one_by_one, "seed " + std::to_string(seed));
      window_count += simulation.window_count();
    }
  }
  EXPECT_GT(window_count, 300 * robot_count);
}

TEST(Windows, are_used_by_large_robots_alone_and_not_where_somebody_looks) {
  const model::Robot robot = make_robot(cube(9));
  Simulation large(robot, {});
  large.run();
  EXPECT_GT(large.window_count(), 100U);
  PacketLog log;
  Simulation seen(robot, {.trace = &log});
  seen.run();
  EXPECT_EQ(seen.window_count(), 0U);
  EXPECT_EQ(log.sent.size(), large.result().packets);
  expect_same(seen.result(), large.result(), "traced");
}

TEST(Windows, leave_a_robot_that_can_go_on) {
  const model::Robot robot = make_robot(cube(3));
  SimulationResult results[2];
  for (const std::size_t least : {std::size_t{1}, kNoWindow}) {
    Simulation simulation(robot, {.thread_count = 2, .window_events_min = least});
    simulation.run();
    simulation.happen(Announcement{.module = 5, .cell = {0, 0, 3}});
    simulation.run();
    simulation.happen(Fault{.kind = Fault::Kind::kDetach, .module = 26});
    simulation.run();
    results[least == 1 ? 0 : 1] = simulation.result();
  }
  EXPECT_TRUE(results[0].all_agree);
  expect_same(results[0], results[1], "changed");
}

}  // namespace
}  // namespace holdfast::sim
