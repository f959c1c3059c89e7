// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
//
// Blocks behind the interface that VisibleSim is reached through, in the plainest world there is,
// beside the simulator of the room sim: the same robot, the same lines, so the same packets at the
// same times. Its own tests say that what it does is right.
#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "faces.hpp"
#include "holdfast/base/rng.hpp"
#include "plain_world.hpp"

namespace holdfast::visiblesim {
namespace {

Structure scenario(const std::string& name) {
  auto structure = load_file(std::string(HOLDFAST_SCENARIO_DIR) + "/" + name + ".json");
  EXPECT_TRUE(structure) << name;
  return std::move(structure).value();
}

sim::SimulationOptions options_v1() {
  sim::SimulationOptions options;
  options.link = sim::blinky_blocks_v1();
  return options;
}

/// The numbers of link-ups begin where those of sim::Simulation do.
std::vector<PlainWorld::Place> places_of(const Structure& structure,
                                         const sim::SimulationOptions& options) {
  const std::uint64_t base = base::Rng(options.seed).next();
  std::vector<PlainWorld::Place> places;
  for (const model::Module& module : structure.robot.modules()) {
    if (!module.is_planned) {
      base::Rng rng(base::Rng(base + places.size()).next());
      places.push_back({.cell = module.cell, .random = static_cast<std::uint16_t>(rng.next())});
    }
  }
  return places;
}

struct Robot {
  explicit Robot(const std::string& name, const sim::SimulationOptions& options = options_v1())
      : structure(scenario(name)), ensemble(structure, options), world(ensemble) {
    world.attach_all(places_of(structure, options));
  }

  Structure structure;
  Ensemble ensemble;
  PlainWorld world;
};

/// The result of `holdfast simulate` for the same robot.
sim::SimulationResult simulated(const Robot& robot, const sim::SimulationOptions& options) {
  sim::Simulation simulation(robot.structure.robot, options);
  simulation.run();
  return simulation.result();
}

/// An existing module, not the first, without which all others are one robot: the last of those
/// with one neighbour.
base::Cell end_of(const model::Robot& robot) {
  base::Cell end;
  for (std::size_t i = 1; i < robot.modules().size() - robot.planned_count(); ++i) {
    const auto& around = robot.neighbours()[i];
    const auto count = std::ranges::count_if(around, [](std::int32_t other) { return other >= 0; });
    end = count == 1 ? robot.modules()[i].cell : end;
  }
  return end;
}

std::int32_t index_of(const model::Robot& robot, const base::Cell& cell) {
  const auto found = std::ranges::find(robot.modules(), cell, &model::Module::cell);
  return static_cast<std::int32_t>(found - robot.modules().begin());
}

verdict::Verdict exact_verdict(const Ensemble& ensemble) {
  const auto report = ensemble.report();
  EXPECT_TRUE(report);
  return report.value().exact.assessment.verdict;
}

class BlockTest : public testing::TestWithParam<const char*> {};

// But for the order of what happens at one instant, which makes rounds differ by a few.
TEST_P(BlockTest, sends_as_many_bytes_as_the_simulated_module_and_at_the_same_times) {
  Robot robot(GetParam());
  robot.world.run();
  const sim::SimulationResult blocks = robot.ensemble.result();
  const sim::SimulationResult modules = simulated(robot, options_v1());
  EXPECT_TRUE(blocks.all_agree);
  EXPECT_TRUE(sim::is_same(blocks.answer, modules.answer));
  EXPECT_EQ(blocks.verdict_time, modules.verdict_time);
  EXPECT_EQ(blocks.packets, modules.packets);
  EXPECT_EQ(blocks.bytes, modules.bytes);
  EXPECT_EQ(blocks.root, modules.root);
  EXPECT_EQ(blocks.packets_module_max, modules.packets_module_max);
}

INSTANTIATE_TEST_SUITE_P(Scenarios, BlockTest,
                         testing::Values("arm_breaks_a", "arm_breaks_b", "arm_tips_c",
                                         "bush_tips_a", "crane_breaks_b", "angle_breaks_c"));

TEST(Block, keeps_a_line_for_one_packet_of_17_bytes_at_a_time) {
  Robot robot("arm_breaks_b");
  robot.world.run();
  EXPECT_EQ(robot.world.packet_bytes_max(), agent::wire::kPacketBytesMin);
  EXPECT_EQ(robot.world.line_count_max(), 1);
}

// Neither more nor less than the simulator's modules, which wait for the same lines and themselves;
// what comes first at one instant differs.
TEST(Block, computes_before_it_sends_and_before_it_hears_more) {
  sim::SimulationOptions options = options_v1();
  options.link.compute_time = 5'000;
  Robot robot("arm_breaks_b", options);
  robot.world.run();
  const sim::SimulationResult blocks = robot.ensemble.result();
  const sim::SimulationResult modules = simulated(robot, options);
  const sim::SimulationResult at_once = simulated(robot, options_v1());
  EXPECT_TRUE(sim::is_same(blocks.answer, modules.answer));
  EXPECT_NEAR(static_cast<double>(blocks.verdict_time), static_cast<double>(modules.verdict_time),
              0.05 * static_cast<double>(modules.verdict_time));
  EXPECT_GT(blocks.verdict_time, at_once.verdict_time * 3 / 2);
}

/// A module dies while the robot works, or when it has long known a verdict and only watches over
/// it.
class DeathTest : public testing::TestWithParam<Time> {};

TEST_P(DeathTest, leaves_the_others_undecided) {
  Robot robot("arm_breaks_a");
  const base::Cell end = end_of(robot.structure.robot);
  robot.world.run(GetParam());
  robot.world.kill(end);
  robot.world.run();
  sim::SimulationOptions options = options_v1();
  options.faults = {{.kind = sim::Fault::Kind::kKill,
                     .at = GetParam(),
                     .module = index_of(robot.structure.robot, end)}};
  const sim::SimulationResult blocks = robot.ensemble.result();
  const sim::SimulationResult modules = simulated(robot, options);
  EXPECT_TRUE(blocks.all_agree);
  EXPECT_EQ(blocks.answer.verdict, agent::Verdict::kUndecided);
  EXPECT_TRUE(sim::is_same(blocks.answer, modules.answer));
  EXPECT_EQ(blocks.verdict_time, modules.verdict_time);
  EXPECT_EQ(robot.world.block(end).describe(), "is silent");
}

INSTANTIATE_TEST_SUITE_P(Times, DeathTest, testing::Values(500'000, 30'000'000));

TEST(Block, that_is_taken_off_leaves_the_verdict_of_the_rest) {
  Robot robot("arm_breaks_b");
  robot.world.run(500'000);
  robot.world.detach(end_of(robot.structure.robot));
  robot.world.run();
  EXPECT_TRUE(robot.ensemble.result().all_agree);
  EXPECT_EQ(to_verdict(robot.ensemble.result().answer.verdict), exact_verdict(robot.ensemble));
}

// The plan goes with the one module that was told of it.
TEST(Block, that_was_told_of_the_plan_takes_it_away) {
  Robot robot("bush_tips_a");
  robot.world.run(500'000);
  robot.world.detach(robot.ensemble.first_cell());
  robot.world.run();
  EXPECT_TRUE(robot.ensemble.result().all_agree);
  EXPECT_EQ(to_verdict(robot.ensemble.result().answer.verdict), exact_verdict(robot.ensemble));
  EXPECT_EQ(robot.ensemble.report().value().structure.robot.planned_count(), 0U);
}

// The arm holds without its planned module, with it, and not with one more.
TEST(Block, that_is_put_on_while_the_robot_computes_counts) {
  Robot robot("arm_breaks_a");
  robot.world.run(500'000);
  const base::Cell planned = robot.structure.robot.modules().back().cell;
  robot.world.attach(planned, 77);
  robot.world.run();
  const sim::SimulationResult result = robot.ensemble.result();
  EXPECT_TRUE(result.all_agree);
  EXPECT_GT(result.epoch, 1);
  EXPECT_EQ(to_verdict(result.answer.verdict), exact_verdict(robot.ensemble));
  const auto report = robot.ensemble.report();
  EXPECT_EQ(report.value().structure.robot.planned_count(), 0U);
}

TEST(Block, that_is_exchanged_between_two_looks_is_another_neighbour) {
  Robot robot("arm_breaks_a");
  const base::Cell end = end_of(robot.structure.robot);
  robot.world.run();
  const std::uint16_t epoch = robot.ensemble.result().epoch;
  robot.world.exchange(end, 77);
  robot.world.run();
  EXPECT_GT(robot.ensemble.result().epoch, epoch);
  EXPECT_EQ(robot.ensemble.result().answer.verdict, agent::Verdict::kSafe);
}

TEST(Block, that_is_told_of_a_plan_makes_the_robot_judge_it) {
  Robot robot("arm_breaks_a");
  robot.world.run();
  const Structure overloaded = scenario("arm_breaks_b");
  for (const model::Module& module : overloaded.robot.modules()) {
    if (module.is_planned) {
      robot.ensemble.add_plan(module.cell);
      robot.world.block(robot.structure.robot.modules().front().cell).plan(module.cell);
    }
  }
  robot.world.run();
  EXPECT_TRUE(robot.ensemble.result().all_agree);
  EXPECT_EQ(to_verdict(robot.ensemble.result().answer.verdict), exact_verdict(robot.ensemble));
}

TEST(Block, tells_who_taps_it_the_verdict_and_its_load_ratios) {
  Robot robot("arm_breaks_b");
  robot.world.run();
  const sim::SimulationResult result = robot.ensemble.result();
  const std::string text = robot.world.block(result.answer.worst_cell).describe();
  EXPECT_EQ(text.find(sim::describe(result.answer)), 0U) << text;
  EXPECT_NE(text.find(';'), std::string::npos) << text;
}

TEST(Ensemble, says_when_every_module_knows_and_what_simulate_would_say) {
  Robot robot("arm_breaks_b");
  int count = 0;
  robot.ensemble.on_verdict([&] { ++count; });
  robot.world.run();
  EXPECT_EQ(count, 1);
  const auto report = robot.ensemble.report();
  ASSERT_TRUE(report);
  const auto& [structure, exact, run] = report.value();
  const auto simulation = simulate(robot.structure, exact, options_v1());
  ASSERT_TRUE(simulation);
  const auto without_cost = [](const std::string& text) {
    return text.substr(0, text.find("  cost"));
  };
  EXPECT_EQ(without_cost(report_text(structure, exact, run)),
            without_cost(report_text(robot.structure, exact, simulation.value())));
}

TEST(Faces, are_known_by_the_cells_to_which_they_lead) {
  for (const base::Direction direction : base::kDirections) {
    EXPECT_EQ(face_towards(base::neighbour({}, direction)), direction);
  }
  EXPECT_FALSE(face_towards({1, 1, 0}));
  EXPECT_FALSE(face_towards({}));
}

}  // namespace
}  // namespace holdfast::visiblesim
