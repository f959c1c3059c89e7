// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
// Same inputs, same events; whatever the lines do, the same verdict as the exact solver's.
#include "holdfast/sim/simulation.hpp"

#include <gtest/gtest.h>

#include "holdfast/verdict/assessment.hpp"
#include "random_robot.hpp"
#include "robots.hpp"

namespace holdfast::sim {
namespace {

LinkModel noisy(LinkModel link) {
  link.loss = 0.05;
  link.duplication = 0.02;
  link.corruption = 0.02;
  return link;
}

bool is_same_verdict(agent::Verdict ours, verdict::Verdict exact) {
  switch (exact) {
    case verdict::Verdict::kSafe:
      return ours == agent::Verdict::kSafe;
    case verdict::Verdict::kOverload:
      return ours == agent::Verdict::kOverload;
    case verdict::Verdict::kUnstable:
      return ours == agent::Verdict::kUnstable;
    case verdict::Verdict::kUndecided:
      break;
  }
  return ours == agent::Verdict::kUndecided;
}

TEST(Simulation, repeats_itself_exactly) {
  const model::Robot robot = make_robot(cube(3));
  for (const LinkModel& link : {unit(), noisy(unit()), noisy(blinky_blocks_v1())}) {
    const SimulationResult first = simulate(robot, {.link = link, .seed = 11});
    const SimulationResult again = simulate(robot, {.link = link, .seed = 11});
    EXPECT_EQ(first.trace_hash, again.trace_hash);
    EXPECT_EQ(first.time, again.time);
    EXPECT_EQ(first.events, again.events);
  }
}

TEST(Simulation, reaches_the_same_verdict_whatever_the_noise) {
  const model::Robot robot = make_robot(arm(3));
  const SimulationResult quiet = simulate(robot, {});
  ASSERT_TRUE(quiet.all_agree);
  std::uint64_t hash = quiet.trace_hash;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const SimulationResult result = simulate(robot, {.link = noisy(unit()), .seed = seed});
    EXPECT_TRUE(result.is_quiet) << "seed " << seed;
    EXPECT_TRUE(result.all_agree) << "seed " << seed;
    EXPECT_EQ(result.answer.verdict, quiet.answer.verdict) << "seed " << seed;
    EXPECT_NE(result.trace_hash, hash) << "seed " << seed;
    hash = result.trace_hash;
  }
}

TEST(Simulation, runs_in_slices_as_in_one_go) {
  const model::Robot robot = make_robot(cube(3));
  const SimulationOptions options{.link = noisy(blinky_blocks_v2()), .seed = 5};
  Simulation simulation(robot, options);
  int slices = 0;
  while (simulation.run_for(1000)) {
    ++slices;
  }
  const SimulationResult whole = simulate(robot, options);
  EXPECT_EQ(simulation.result().trace_hash, whole.trace_hash);
  EXPECT_EQ(simulation.result().events, whole.events);
  EXPECT_NEAR(slices, static_cast<double>(whole.events) / 1000, 2);
  EXPECT_FALSE(simulation.run_for(1));
}

TEST(Simulation, agrees_with_the_exact_solver) {
  // Mechanics across rooms is tested elsewhere; this sees that setups and plans arrive. Seeds that
  // end quickly.
  for (std::uint64_t seed = 18; seed <= 30; ++seed) {
    const model::Robot robot = make_robot(test::random_robot(seed));
    const SimulationResult result = simulate(robot, {.seed = seed});
    EXPECT_TRUE(result.is_quiet) << "seed " << seed;
    EXPECT_TRUE(result.all_agree) << "seed " << seed;
    EXPECT_TRUE(is_same_verdict(result.answer.verdict, verdict::assess(robot).verdict))
        << "seed " << seed << " " << agent::name(result.answer.verdict);
  }
}

/// A fixed module holds one more by its side, at every level, as there is no floor: all the weight
/// w at half a pitch, so Eq. (17) says 2 w (L / 2) / L / Fmax, w / Fmax.
TEST(Simulation, knows_no_floor_where_there_is_none) {
  const model::Material material;
  const double expected = model::module_weight_n(material) / material.strength_lateral_n;
  for (const std::int32_t level : {-1, 0, 1}) {
    const model::Robot robot = make_robot({.existing = {{0, 0, level}, {1, 0, level}},
                                           .fixed = {{0, 0, level}},
                                           .support_z = std::nullopt});
    const SimulationResult result = simulate(robot, {});
    EXPECT_EQ(result.answer.verdict, agent::Verdict::kSafe) << "level " << level;
    EXPECT_NEAR(result.answer.load_ratio_max, expected, 1e-5) << "level " << level;
  }
}

/// The module has no load ratio that could make what its facets carry matter or not. It is pulled
/// off one wall and along the other.
TEST(Simulation, waits_for_the_facets_of_a_single_module) {
  const model::Robot robot =
      make_robot({.existing = {{0, 0, 0}},
                  .support_z = std::nullopt,
                  .obstacles = {{.from = {}, .to = {}, .cells = {{-1, 0, 0}, {0, -1, 0}}}},
                  .gravity_m_s2 = {{5, 0, -10}}});
  EXPECT_EQ(verdict::assess(robot).verdict, verdict::Verdict::kUnstable);
  for (const agent::Method method : {agent::Method::kElimination, agent::Method::kPolynomial}) {
    const SimulationResult result = simulate(robot, {.method = method});
    EXPECT_EQ(result.answer.verdict, agent::Verdict::kUnstable)
        << agent::name(result.answer.reason);
  }
}

TEST(Simulation, may_tell_the_plan_to_any_module_and_anchor_any) {
  const model::Robot robot = make_robot(arm(4));
  const SimulationResult first = simulate(robot, {});
  for (std::int32_t module = 0; module < 3; ++module) {
    const SimulationResult result = simulate(robot, {.anchor = 2 - module, .plan_module = module});
    EXPECT_TRUE(result.all_agree);
    EXPECT_EQ(result.answer.verdict, first.answer.verdict);
    EXPECT_EQ(result.effort.module_count, 7U);
  }
}

TEST(Simulation, adds_up) {
  const model::Robot robot = make_robot(cube(3));
  const SimulationResult result = simulate(robot, {.link = noisy(unit())});
  PhaseStatistics sum;
  for (const PhaseStatistics& phase : result.phases) {
    sum.packets += phase.packets;
    sum.bytes += phase.bytes;
    sum.time += phase.time;
    sum.rounds += phase.rounds;
  }
  EXPECT_EQ(sum.packets, result.packets);
  EXPECT_EQ(sum.bytes, result.bytes);
  EXPECT_EQ(sum.time, result.time);
  EXPECT_EQ(sum.rounds, result.rounds);
  EXPECT_LE(result.verdict_time, result.time);
  EXPECT_LT(result.payload_bytes, result.bytes);
  EXPECT_LE(result.data_packets, result.packets);
  EXPECT_GE(result.bytes_module_max * 27, result.bytes);
  EXPECT_GE(result.root, 0);
}

TEST(Simulation, counts_rounds_as_the_time_of_unit_lines) {
  // Without noise hardly anything waits but the first wave (acknowledge_after), so that the longest
  // chain of packets, one tick each, takes all of the time up to the last report.
  const model::Robot robot = make_robot(cube(4));
  const SimulationResult result = simulate(robot, {});
  EXPECT_LE(result.rounds, result.time);
  EXPECT_GT(result.rounds * 100, result.verdict_time * 97);
}

TEST(Simulation, stops_at_its_limits) {
  const model::Robot robot = make_robot(cube(3));
  const SimulationResult late = simulate(robot, {.time_max = 100});
  EXPECT_LE(late.time, 100U);
  EXPECT_FALSE(late.is_quiet);
  EXPECT_FALSE(late.all_agree);
  const SimulationResult few = simulate(robot, {.event_count_max = 1000});
  EXPECT_GE(few.events, 1000U);
  EXPECT_LT(few.events, 1100U);  // What one event sends comes on top.
  EXPECT_FALSE(few.is_quiet);
}

TEST(Simulation, of_one_module_needs_no_lines) {
  const SimulationResult result = simulate(make_robot(cube(1)), {});
  EXPECT_TRUE(result.is_quiet);
  EXPECT_TRUE(result.all_agree);
  EXPECT_EQ(result.packets, 0U);
}

TEST(SimulationOptions, are_checked) {
  const model::Robot robot = make_robot(arm(2));
  EXPECT_FALSE(find_options_fault(robot, {}));
  EXPECT_EQ(*find_options_fault(robot, {.anchor = 3}),
            "anchor is 3, expected existing modules: 0 to 2");
  EXPECT_TRUE(find_options_fault(robot, {.plan_module = -1}));
  EXPECT_TRUE(find_options_fault(robot, {.announcements = {{.at = 0, .module = 4, .cell = {}}}}));
  // Module 1 has no neighbour in +x, and the one above it is only planned.
  EXPECT_TRUE(find_options_fault(robot, {.faults = {{.kind = Fault::Kind::kCut, .module = 1}}}));
  EXPECT_TRUE(find_options_fault(
      robot,
      {.faults = {{.kind = Fault::Kind::kCut, .module = 1, .face = base::Direction::kPlusZ}}}));
  EXPECT_TRUE(find_options_fault(
      robot, {.faults = {{.kind = Fault::Kind::kAttach, .at = 9, .module = 0}}}));
}

TEST(SimulationOptions, refuse_a_robot_whose_neighbours_are_not_all_connected) {
  model::RobotSpec spec = cube(2);
  spec.released = {{spec.existing[0], spec.existing[1]}};
  const auto fault = find_options_fault(make_robot(spec), {});
  ASSERT_TRUE(fault);
  EXPECT_NE(fault->find("1 pair of neighbours that is not connected"), std::string::npos);
  const agent::StepWord off = {.kind = agent::StepWord::Kind::kOff, .face = 0, .mask = 7};
  EXPECT_FALSE(find_options_fault(make_robot(spec), {.step = {off}}));
  EXPECT_TRUE(find_options_fault(make_robot(spec),
                                 {.announcements = {{.at = 9, .cell = {1, 0, 2}}}, .step = {off}}));
  spec.planned = {{0, 0, 2}};
  EXPECT_TRUE(find_options_fault(make_robot(spec), {.step = {off}}));
}

}  // namespace
}  // namespace holdfast::sim
