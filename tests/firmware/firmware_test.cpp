// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
// The firmware on emulated microcontrollers against the exact solver and against the host's agent,
// which takes the same steps. Needs the images that './dev firmware' builds.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "holdfast/base/rng.hpp"
#include "holdfast/emulated.hpp"
#include "looped_robot.hpp"

namespace holdfast {
namespace {

using emulator::EmulationOptions;
using emulator::Fault;

constexpr sim::Time kSlice = 5'000;

// The limits: 5 ms of 48 MHz, and 2 KB.
constexpr std::uint64_t kStepCyclesMax = 240'000;
constexpr std::uint32_t kStackBytesMax = 2'048;

std::vector<std::string> paths_in(const std::string& folder) {
  std::vector<std::string> paths;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    if (entry.path().extension() == ".json") {
      paths.push_back(entry.path().string());
    }
  }
  std::ranges::sort(paths);
  return paths;
}

Structure load_path(const std::string& path) {
  auto structure = load_file(path);
  EXPECT_TRUE(structure);
  return std::move(structure).value();
}

Structure load(const std::string& name) {
  return load_path(std::string(HOLDFAST_SCENARIO_DIR) + "/" + name + ".json");
}

const emulator::Image& image() {
  static const base::Result<emulator::Image> loaded = emulator::load_image(HOLDFAST_IMAGE);
  EXPECT_TRUE(loaded) << loaded.error().message;
  return loaded.value();
}

emulator::Emulation finished(const Structure& structure, const EmulationOptions& options) {
  emulator::Emulation emulation(image(), structure.robot, options);
  while (emulation.run_for(kSlice)) {
  }
  return emulation;
}

class EveryScenario : public ::testing::TestWithParam<std::string> {};

/// The goals: every module's verdict is the exact one, load ratios within 0.01 + 1 %, every
/// step bit for bit the host's, at most 10 s from the plan to the last verdict, no step longer than
/// 5 ms, and a stack of at most 2 KB.
TEST_P(EveryScenario, is_decided_by_the_firmware_like_the_exact_answer) {
  const Structure structure = load_path(GetParam());
  const verdict::Assessment exact = check(structure).assessment;
  const emulator::Emulation emulation = finished(structure, {});
  const auto result = emulation.result();
  const auto report = emulation.report();
  EXPECT_TRUE(result.all_agree);
  EXPECT_EQ(report.mismatch_count, 0U);
  EXPECT_LE(result.verdict_time, report.planned_at + 10'000'000);
  EXPECT_LE(report.step_cycles_max, kStepCyclesMax);
  EXPECT_LE(report.stack_bytes_max, kStackBytesMax);
  for (std::int32_t i = 0; i < emulation.module_count(); ++i) {
    const emulator::ModuleView module = emulation.module(i);
    ASSERT_EQ(to_verdict(module.answer.verdict), exact.verdict) << "module " << i;
    EXPECT_EQ(module.own_load_ratio, emulation.shadow(i).own_load_ratio()) << "module " << i;
    EXPECT_EQ(module.colour, emulation.shadow(i).colour()) << "module " << i;
    if (exact.verdict != verdict::Verdict::kUnstable) {
      EXPECT_NEAR(module.answer.load_ratio_max, *exact.load_ratio_max,
                  0.01 + 0.01 * *exact.load_ratio_max);
    }
  }
  for (std::size_t i = 0; i < exact.connections.size() && exact.is_stable; ++i) {
    const model::Connection& pair = structure.robot.connections()[i];
    float ratio = 0;
    if (pair.a < emulation.module_count() &&
        emulation.shadow(pair.a).find_load_ratio(
            structure.robot.modules()[static_cast<std::size_t>(pair.a)].cell, pair.direction,
            ratio)) {
      const double expected = exact.connections[i].load_ratio;
      EXPECT_NEAR(static_cast<double>(ratio), expected, 0.01 + 0.01 * std::abs(expected)) << i;
    }
  }
}

std::string stem_of(const ::testing::TestParamInfo<std::string>& path) {
  return std::filesystem::path(path.param).stem().string();
}

INSTANTIATE_TEST_SUITE_P(Firmware, EveryScenario,
                         ::testing::ValuesIn(paths_in(HOLDFAST_SCENARIO_DIR)), stem_of);

/// The scenarios with the most to do at one module.
INSTANTIATE_TEST_SUITE_P(HardForFirmware, EveryScenario,
                         ::testing::ValuesIn(paths_in(HOLDFAST_HARD_DIR)), stem_of);

/// The simulated robot's verdict, bit for bit the host's.
void expect_decided_as_simulated(const model::Robot& robot, const emulator::Image& image,
                                 const sim::LinkModel& link) {
  sim::SimulationOptions options;
  options.link = link;
  sim::Simulation simulation(robot, options);
  simulation.run();
  emulator::Emulation emulation(image, robot, {.link = link});
  while (emulation.run_for(kSlice)) {
  }
  EXPECT_TRUE(emulation.result().all_agree);
  EXPECT_EQ(emulation.result().answer.verdict, simulation.result().answer.verdict);
  EXPECT_NE(emulation.result().answer.verdict, agent::Verdict::kUndecided);
  EXPECT_EQ(emulation.report().mismatch_count, 0U);
  EXPECT_LE(emulation.report().step_cycles_max, kStepCyclesMax);
  EXPECT_LE(emulation.report().stack_bytes_max, kStackBytesMax);
}

model::Robot looped(const std::string& name) {
  const auto all = test::looped_robots();
  auto robot = model::Robot::create(std::ranges::find(all, name, &test::LoopedRobot::name)->spec);
  EXPECT_TRUE(robot);
  return std::move(robot).value();
}

/// Elimination cannot hold these robots. All twenty: firmware_bench.
TEST(Firmware, decides_robots_with_many_loops) {
  for (const char* name :
       {"block_2x2x2", "middle_planned", "row_planned", "square_planned", "wall_3x1x3"}) {
    SCOPED_TRACE(name);
    expect_decided_as_simulated(looped(name), image(), sim::blinky_blocks_v2());
  }
}

/// Lines and memory of Blinky Blocks 1: 38,400 baud, packets of 17 bytes, 16 KB with the stack.
TEST(Firmware, decides_on_the_lines_of_version_1) {
  const auto v1 = emulator::load_image(HOLDFAST_IMAGE_V1);
  ASSERT_TRUE(v1);
  EXPECT_LE(v1.value().ram_bytes + kStackBytesMax, 16'384U);
  const auto link = sim::blinky_blocks_v1();
  expect_decided_as_simulated(load("arm_breaks_b").robot, v1.value(), link);
  expect_decided_as_simulated(looped("block_2x2x2"), v1.value(), link);
}

TEST(Firmware, takes_a_plan_on_any_module) {
  const Structure structure = load("crane_tips_b");
  const auto count =
      static_cast<std::int32_t>(structure.robot.modules().size() - structure.robot.planned_count());
  for (std::int32_t module = 0; module < count; ++module) {
    const auto emulation =
        finished(structure, {.seed = 7, .anchor = count - 1, .plan_module = module});
    EXPECT_TRUE(emulation.result().all_agree) << module;
    EXPECT_EQ(emulation.result().answer.verdict, agent::Verdict::kUnstable) << module;
    EXPECT_EQ(emulation.report().mismatch_count, 0U) << module;
  }
}

/// The arm grows by one module: planned, attached;
/// one more is planned and withdrawn. The module that holds the plans starts again before and
/// after.
TEST(Firmware, plans_end_when_they_are_carried_out_or_withdrawn) {
  const Structure structure = load("arm_breaks_a");
  const base::Cell first = structure.robot.modules().back().cell;
  ASSERT_EQ(structure.robot.planned_count(), 1U);
  const base::Cell aside = base::neighbour(first, base::Direction::kPlusZ);
  const auto changed =
      with_changes(structure, {{.kind = Change::Kind::kPlan, .at = 2'000'000, .cell = aside},
                               {.kind = Change::Kind::kAttach, .at = 4'000'000, .cell = first},
                               {.kind = Change::Kind::kWithdraw, .at = 6'000'000, .cell = aside}});
  ASSERT_TRUE(changed);
  emulator::EmulationOptions options{.tells_planned = false,
                                     .announcements = changed.value().announcements};
  options.announcements.front().at = options.plan_at;
  options.faults = {{.kind = emulator::Fault::Kind::kReset, .at = 3'000'000, .module = 0},
                    {.kind = emulator::Fault::Kind::kAttach,
                     .at = 4'000'000,
                     .module = changed.value().attachments[0].module},
                    {.kind = emulator::Fault::Kind::kReset, .at = 8'000'000, .module = 0}};
  const Structure& end = changed.value().structure;
  const auto emulation = finished(end, options);
  EXPECT_TRUE(emulation.result().all_agree);
  EXPECT_EQ(to_verdict(emulation.result().answer.verdict), check(end).assessment.verdict);
  EXPECT_NE(emulation.result().answer.verdict, agent::Verdict::kUndecided);
  EXPECT_EQ(emulation.report().mismatch_count, 0U);
  for (std::int32_t i = 0; i < emulation.module_count(); ++i) {
    EXPECT_EQ(emulation.shadow(i).announcements().count(), 0) << i;
  }
}

TEST(Firmware, does_the_same_when_run_again_and_something_else_with_another_seed) {
  const Structure structure = load("bush_tips_b");
  const auto first = finished(structure, {.seed = 3}).result();
  const auto second = finished(structure, {.seed = 3}).result();
  const auto other = finished(structure, {.seed = 4}).result();
  EXPECT_EQ(first.events, second.events);
  EXPECT_EQ(first.bytes, second.bytes);
  EXPECT_EQ(first.verdict_time, second.verdict_time);
  EXPECT_NE(first.verdict_time, other.verdict_time);
}

/// A random fault at a random time between the start and the verdict. `is_unsafe` robots may not be
/// called safe by any module; every run comes to its end by itself.
void break_robots(Fault::Kind kind, std::uint64_t seed) {
  base::Rng rng(seed);
  for (const char* name : {"arm_tips_b", "bush_tips_b", "crane_tips_b", "crane_breaks_b"}) {
    const Structure structure = load(name);
    const auto& robot = structure.robot;
    const std::size_t count = robot.modules().size() - robot.planned_count();
    Fault fault{.kind = kind,
                .at = 20'000 + rng.below(900'000),
                .module = static_cast<std::int32_t>(rng.below(count))};
    const auto has_neighbour = [&](base::Direction face) {
      const std::int32_t other = robot.neighbours()[static_cast<std::size_t>(fault.module)]
                                                   [static_cast<std::size_t>(base::index(face))];
      return other >= 0 && other < static_cast<std::int32_t>(count);
    };
    fault.face = *std::ranges::find_if(base::kDirections, has_neighbour);
    SCOPED_TRACE(std::string(name) + " module " + std::to_string(fault.module) + " at " +
                 std::to_string(fault.at));
    const EmulationOptions options{.seed = rng.next(), .faults = {fault}, .time_max = 30'000'000};
    const auto emulation = finished(structure, options);
    const auto result = emulation.result();
    EXPECT_LT(result.time, options.time_max);
    EXPECT_EQ(emulation.report().mismatch_count, 0U);
    const bool heals = kind == Fault::Kind::kFlip || kind == Fault::Kind::kReset;
    for (std::int32_t i = 0; i < emulation.module_count(); ++i) {
      const emulator::ModuleView module = emulation.module(i);
      if (!module.is_alive || module.answer.verdict == agent::Verdict::kUndecided) {
        EXPECT_TRUE(!heals) << "module " << i;
        continue;
      }
      const auto exact = check(structure).assessment.verdict;
      EXPECT_EQ(to_verdict(module.answer.verdict), exact) << "module " << i;
    }
  }
}

TEST(FirmwareFaults, a_module_without_power_never_makes_a_wrong_safe) {
  break_robots(Fault::Kind::kKill, 1);
}

/// The limit is that of docs/distributed.md, Watching: on lines of version 2, 15 s and three times
/// what the waves take, a quarter of a second here. The arm's middle dies long after the verdict;
/// modules behind it hear no order any more.
TEST(FirmwareFaults, nobody_keeps_an_old_verdict) {
  const Structure structure = load("arm_breaks_a");
  const auto& modules = structure.robot.modules();
  const auto dead = std::ranges::find(modules, base::Cell{3, 1, 2}, &model::Module::cell);
  ASSERT_NE(dead, modules.end());
  const emulator::Time break_at = 6'000'000;
  for (const emulator::Time watched : {emulator::Time{0}, emulator::Time{16'000'000}}) {
    const auto emulation = finished(
        structure,
        {.faults = {{.kind = Fault::Kind::kKill,
                     .at = break_at,
                     .module = static_cast<std::int32_t>(std::distance(modules.begin(), dead))}},
         .time_min = break_at + watched});
    EXPECT_EQ(emulation.report().mismatch_count, 0U);
    EXPECT_LE(emulation.report().step_cycles_max, kStepCyclesMax);
    for (std::int32_t i = 0; i < emulation.module_count(); ++i) {
      if (emulation.module(i).is_alive) {
        EXPECT_EQ(emulation.module(i).answer.verdict,
                  watched > 0 ? agent::Verdict::kUndecided : agent::Verdict::kSafe)
            << "module " << i;
      }
    }
  }
}

TEST(FirmwareFaults, a_cut_line_never_makes_a_wrong_safe) { break_robots(Fault::Kind::kCut, 2); }

TEST(FirmwareFaults, a_damaged_byte_does_no_harm) { break_robots(Fault::Kind::kFlip, 3); }

TEST(FirmwareFaults, a_module_that_starts_again_joins_in) { break_robots(Fault::Kind::kReset, 4); }

/// A processor's fault finds its vector behind the bootloader, the lamp shows it, the watchdog
/// starts the module again, and it joins in.
TEST(FirmwareFaults, a_program_that_goes_astray_starts_again) {
  const Structure structure = load("arm_tips_b");
  const auto emulation = finished(
      structure, {.faults = {{.kind = Fault::Kind::kCrash, .at = 2'000'000, .module = 1}}});
  EXPECT_TRUE(emulation.result().all_agree);
  EXPECT_EQ(emulation.result().answer.verdict, agent::Verdict::kUnstable);
  EXPECT_EQ(emulation.report().watchdog_count, 1U);
  EXPECT_EQ(emulation.report().mismatch_count, 0U);
}

/// RM0091, 27.5.5: a USART bears 3.33 % between two clocks. Crystals are off by some 50 ppm;
/// without, the HSI48 is by up to 3 %.
TEST(FirmwareFaults, clocks_may_be_off_as_far_as_lines_bear_it) {
  const Structure structure = load("crane_breaks_a");
  const auto crystals = finished(structure, {.clock_off_ppm = 50});
  EXPECT_EQ(crystals.result().answer.verdict, agent::Verdict::kSafe);
  const auto good = finished(structure, {.clock_off_ppm = 15'000, .has_crystals = false});
  EXPECT_TRUE(good.result().all_agree);
  EXPECT_EQ(good.result().answer.verdict, agent::Verdict::kSafe);
  EXPECT_EQ(good.report().mismatch_count, 0U);
  const auto bad =
      finished(structure, {.clock_off_ppm = 30'000, .has_crystals = false, .time_max = 20'000'000});
  EXPECT_FALSE(bad.result().all_agree && bad.result().answer.verdict == agent::Verdict::kSafe);
  EXPECT_GT(bad.report().lost_bytes, 100 + good.report().lost_bytes);
}

}  // namespace
}  // namespace holdfast
