// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
// A robot that goes on from what it keeps says what one says that starts from nothing, and what the
// exact solver says, in a fraction of the time. The paper suggests it [Piranda 2021, Sec. II-G].
#include <gtest/gtest.h>

#include <algorithm>

#include "general_robot.hpp"
#include "holdfast/base/rng.hpp"
#include "holdfast/model/families.hpp"
#include "holdfast/simulated_steps.hpp"
#include "seeds.hpp"

namespace holdfast {
namespace {

using Cells = std::vector<base::Cell>;

/// A robot that stands, and one module more in every step.
StepsFile growing(Cells start, const Cells& more, bool is_fixed = false) {
  StepsFile file{.name = "growing", .document = {}, .warnings = {}};
  for (const base::Cell& cell : start) {
    file.document.modules.emplace_back().cell = cell;
  }
  file.document.modules.front().is_fixed = is_fixed;
  for (const base::Cell& cell : more) {
    file.document.steps.emplace_back().emplace_back().cell = cell;
  }
  return file;
}

SimulatedSteps simulated(const StepsFile& file, sim::SimulationOptions options = {}) {
  auto steps = simulate_steps(file, options);
  EXPECT_TRUE(steps.has_value()) << (steps ? "" : steps.error().message);
  return steps ? std::move(steps).value() : SimulatedSteps{};
}

void expect_the_same(const SimulatedSteps& steps) {
  for (std::size_t i = 0; i < steps.changes.size(); ++i) {
    const StepChange& change = steps.changes[i];
    SCOPED_TRACE(::testing::Message() << "change " << i << ", " << name(change.kind));
    EXPECT_EQ(to_verdict(change.kept.answer.verdict), change.exact);
    EXPECT_EQ(change.kept.answer.verdict, change.fresh.answer.verdict);
    EXPECT_TRUE(change.kept.all_agree);
    if (change.exact != verdict::Verdict::kUnstable) {
      EXPECT_NEAR(change.kept.answer.load_ratio_max, change.load_ratio_exact,
                  0.01 + 0.01 * change.load_ratio_exact);
    }
  }
}

Cells row(int from, int to) {
  Cells cells;
  for (int x = from; x < to; ++x) {
    cells.push_back({x, 0, 1});
  }
  return cells;
}

TEST(Kept, an_arm_takes_a_quarter_of_the_time) {
  Cells start = row(0, 5);
  start.insert(start.begin(), {0, 0, 0});
  const SimulatedSteps steps = simulated(growing(start, row(5, 55), true));
  expect_the_same(steps);
  EXPECT_LE(steps.time_share_median, 0.25);
}

TEST(Kept, a_growth_with_loops_takes_less_than_a_third) {
  const Cells cells = model::family_cells(model::Family::kGrowth, 32);
  const auto half = cells.begin() + 24;
  const SimulatedSteps steps =
      simulated(growing(Cells(cells.begin(), half), Cells(half, cells.end())));
  expect_the_same(steps);
  EXPECT_LE(steps.time_share_median, 0.3);
}

/// Most plans of a tower are between others, and what comes touches modules of several depths: it
/// would take more than a half if trees grew deeper than waves make them, and two fifths if the
/// bending of the tower had to be found anew for every plan.
TEST(Kept, a_tower_takes_less_than_a_quarter) {
  const Cells cells = model::family_cells(model::Family::kTower, 8);
  const auto start = cells.begin() + 45;
  const SimulatedSteps steps =
      simulated(growing(Cells(cells.begin(), start), Cells(start, start + 20)));
  expect_the_same(steps);
  EXPECT_LE(steps.time_share_median, 0.25);
}

/// An arm on a foot that topples in the end, as in the paper's first test, and comes back.
TEST(Kept, what_is_taken_off_starts_from_nothing) {
  StepsFile file = growing({{0, 0, 0}, {0, 0, 1}}, {{1, 0, 1}, {2, 0, 1}});
  const SimulatedSteps steps = simulated(file);
  expect_the_same(steps);
  EXPECT_EQ(steps.changes.back().exact, verdict::Verdict::kUnstable);
  EXPECT_EQ(worst_verdict(steps), verdict::Verdict::kUnstable);
}

TEST(Kept, the_same_on_noisy_and_on_slow_links) {
  sim::LinkModel noisy = sim::unit();
  noisy.loss = 0.1;
  noisy.duplication = 0.05;
  noisy.corruption = 0.02;
  noisy.jitter = 2;
  Cells start = row(0, 4);
  start.insert(start.begin(), {0, 0, 0});
  for (const sim::LinkModel& link : {noisy, sim::blinky_blocks_v1(), sim::blinky_blocks_v2()}) {
    for (std::uint64_t seed = 1; seed < 4; ++seed) {
      expect_the_same(simulated(growing(start, {{1, 1, 1}, {4, 0, 1}, {0, 1, 1}, {0, 1, 0}}, true),
                                {.link = link, .seed = seed}));
    }
  }
}

/// A robot that grew at random above a floor from one foot, its first third as the start and the
/// rest in steps of one or two modules; every third module of the start weighs something else, or
/// every second one that comes.
StepsFile growing_at_random(const base::Lattice& lattice, std::uint64_t seed,
                            bool is_of_start = true) {
  base::Rng rng(seed);
  Cells cells = {{0, 0, 0}};
  const std::size_t count = 9 + rng.below(16);
  while (cells.size() < count) {
    const base::Cell& from = cells[rng.below(cells.size())];
    const auto direction = static_cast<base::Direction>(
        rng.below(static_cast<std::uint64_t>(lattice.direction_count)));
    const base::Cell next = base::neighbour(lattice, from, direction);
    if (next.z >= 0 && std::ranges::find(cells, next) == cells.end()) {
      cells.push_back(next);
    }
  }
  const std::size_t first = count / 3;
  StepsFile file = growing(Cells(cells.begin(), cells.begin() + static_cast<std::ptrdiff_t>(first)),
                           {}, rng.below(4) == 0);
  file.document.extension.lattice = lattice;
  for (std::size_t i = 0; is_of_start && i < first; i += 3) {
    file.document.extension.own.push_back(
        {.step = 0,
         .module = i,
         .kind = {},
         .mass_kg = 1e-3 * static_cast<double>(60 + rng.below(60))});
  }
  for (std::size_t i = first; i < count;) {
    auto& step = file.document.steps.emplace_back();
    for (std::size_t k = 1 + rng.below(2); k > 0 && i < count; --k) {
      step.emplace_back().cell = cells[i++];
      if (!is_of_start && i % 2 == 0) {
        file.document.extension.own.push_back(
            {.step = file.document.steps.size(),
             .module = step.size() - 1,
             .kind = {},
             .mass_kg = 1e-3 * static_cast<double>(60 + rng.below(60))});
      }
    }
  }
  return file;
}

/// Catoms, discs and prisms, and cubes of different masses: the exact solver's verdicts, in less
/// time.
TEST(Kept, modules_of_every_lattice_and_mass_go_on_from_what_they_keep) {
  constexpr std::uint64_t seeds = test::campaign(6U, 3U);
  for (const base::Lattice& lattice : test::kLattices) {
    int count = 0;
    double share = 0;
    for (std::uint64_t seed = 0; seed < seeds; ++seed) {
      SCOPED_TRACE(::testing::Message() << lattice.direction_count << " faces, seed " << seed);
      const SimulatedSteps steps = simulated(growing_at_random(lattice, seed));
      expect_the_same(steps);
      count += static_cast<int>(steps.changes.size());
      share += steps.time_share_median / static_cast<double>(seeds);
    }
    EXPECT_GE(count, test::least(60, 3));
    EXPECT_LT(share, 0.7);
  }
}

TEST(Kept, modules_that_weigh_something_else_come_as_any) {
  for (const base::Lattice& lattice : test::kLattices) {
    for (std::uint64_t seed = 0; seed < test::campaign(4U); ++seed) {
      SCOPED_TRACE(::testing::Message() << lattice.direction_count << " faces, seed " << seed);
      expect_the_same(simulated(growing_at_random(lattice, seed, false)));
    }
  }
}

/// A battery of weight B at the tip of an arm on a foot, its modules of weight W. The foot carries
/// 2 W + B, which press, and the moments of W at a pitch and B at two: 2 W + 4 B - (2 W + B) = 3 B.
/// When it has gone the arm is left, W beside the foot; no other module can take its cell.
TEST(Kept, a_battery_comes_and_goes) {
  StepsFile file = growing({{0, 0, 0}, {0, 0, 1}, {1, 0, 1}}, {{2, 0, 1}}, true);
  file.document.extension.kinds = {{.name = "battery", .mass_kg = 0.3, .connectors = {}}};
  file.document.extension.own = {{.step = 1, .module = 0, .kind = "battery", .mass_kg = {}}};
  file.document.extension.plan = {{.detach = {{2, 0, 1}}}};
  const SimulatedSteps steps = simulated(file);
  expect_the_same(steps);
  const double weight = 0.06106 * 9.81;
  ASSERT_EQ(steps.changes.size(), 4);
  EXPECT_NEAR(steps.changes[2].kept.answer.load_ratio_max, 3 * 0.3 * 9.81 / 11.98, 0.001);
  EXPECT_NEAR(steps.changes[3].kept.answer.load_ratio_max, weight / 14.97, 0.001);
  file.document.extension.plan.push_back({.attach = {{2, 0, 1}}});
  EXPECT_FALSE(simulate_steps(file, {}).has_value());
}

/// A module inside a tower is taken off, and one that knows nothing is put there again: it takes
/// how the robot has moved from its neighbours, so plans behind that are as cheap as any. If it
/// took its own old changes for them, a plan would take 420 rounds.
TEST(Kept, who_is_put_on_again_knows_nothing_of_before) {
  Cells cells;
  for (int i = 0; i < 90; ++i) {
    cells.push_back({i % 3, i / 3 % 3, i / 9});
  }
  StepsFile file = growing(cells, {});
  const base::Cell again = {2, 2, 4};
  file.document.extension.plan = {{.detach = {again}}};
  for (const base::Cell& cell : Cells{{0, 0, 10},
                                      {1, 0, 10},
                                      {2, 0, 10},
                                      {0, 1, 10},
                                      {1, 1, 10},
                                      {2, 1, 10},
                                      {0, 2, 10},
                                      again,
                                      {1, 2, 10},
                                      {2, 2, 10}}) {
    file.document.extension.plan.push_back({.attach = {cell}});
  }
  const SimulatedSteps steps = simulated(file);
  expect_the_same(steps);
  const auto& changes = steps.changes;
  ASSERT_EQ(changes.size(), 22);
  for (const std::size_t plan : {changes.size() - 4, changes.size() - 2}) {
    EXPECT_LT(changes[plan].kept.rounds, 300) << plan;
  }
}

/// Found at random: with displacements that are kept the polynomial makes no progress here, from
/// nothing it does. Conjugate gradients in its place would take 3,075 rounds, twice a fresh start.
TEST(Kept, what_leads_nowhere_is_forgotten_before_another_method_is_tried) {
  StepsFile file = growing({{0, 0, 0},  {0, 0, 1},  {1, 0, 1},  {1, 2, 2},  {2, 0, 1},  {0, 2, 2},
                            {1, 0, 2},  {1, 0, 3},  {2, 0, 2},  {-1, 2, 2}, {1, 0, 4},  {2, -1, 1},
                            {1, 1, 3},  {1, 1, 2},  {0, 1, 1},  {1, -1, 3}, {1, -1, 1}, {-1, 2, 3},
                            {1, -1, 2}, {-1, 0, 1}, {-1, 3, 2}, {1, 1, 1},  {0, 0, 3},  {0, 1, 0},
                            {0, 0, 4},  {2, -1, 2}, {-1, 4, 2}, {0, 1, 3},  {1, 2, 1},  {-1, 3, 3},
                            {-1, 2, 4}, {0, -1, 2}, {0, -1, 1}, {0, 0, 2},  {2, -2, 2}, {2, -3, 2}},
                           {{1, -2, 3}});
  file.document.material.strength_vertical_n = 10.048747944916926;
  file.document.material.strength_lateral_n = 12.55674096288868;
  const SimulatedSteps steps = simulated(file);
  expect_the_same(steps);
  const StepChange& plan = steps.changes[1];
  EXPECT_LT(2 * plan.kept.rounds, 3 * plan.fresh.rounds);
}

/// Another module comes to the cell of one that was fixed, and is not: the modules cannot know.
TEST(Kept, no_module_takes_the_cell_of_a_fixed_one) {
  StepsFile file = growing({{0, 0, 0}, {1, 0, 0}}, {}, true);
  file.document.modules.back().is_fixed = true;
  file.document.extension.plan = {{.detach = {{1, 0, 0}}}};
  EXPECT_TRUE(simulate_steps(file, {}).has_value());
  file.document.extension.plan.push_back({.attach = {{1, 0, 0}}});
  EXPECT_FALSE(simulate_steps(file, {}).has_value());
}

/// The robot would tip over without either arm alone; arms that are taken one by one from the inner
/// end would leave it in pieces.
TEST(Kept, a_step_counts_as_a_whole) {
  StepsFile file =
      growing({{0, 0, 0}, {0, 0, 1}, {1, 0, 1}, {2, 0, 1}, {-1, 0, 1}, {-2, 0, 1}}, {});
  const Cells arms = {{1, 0, 1}, {2, 0, 1}, {-1, 0, 1}, {-2, 0, 1}};
  file.document.extension.plan = {{.detach = arms}, {.attach = {arms.rbegin(), arms.rend()}}};
  const SimulatedSteps steps = simulated(file);
  expect_the_same(steps);
  ASSERT_EQ(steps.changes.size(), 4);
  EXPECT_EQ(worst_verdict(steps), verdict::Verdict::kSafe);
}

/// Modules keep 30 plans. Whoever plans more withdraws what found no place once it is there.
TEST(Kept, a_step_of_more_than_modules_can_plan_leaves_no_doubt_behind) {
  for (const int count : {30, 31}) {
    SCOPED_TRACE(count);
    StepsFile file = growing({{-2, 0, 0}, {-1, 0, 0}}, {});
    Cells slab;
    for (int i = 0; i < count; ++i) {
      slab.push_back({i / 4, i % 4, 0});
    }
    file.document.extension.plan = {{.attach = slab}, {.attach = {{-3, 0, 0}}}};
    SimulatedSteps steps = simulated(file);
    ASSERT_EQ(steps.changes.size(), 5);
    if (count > 30) {
      EXPECT_EQ(steps.changes[1].kept.answer.verdict, agent::Verdict::kUndecided);
      EXPECT_EQ(steps.changes[1].fresh.answer.verdict, agent::Verdict::kUndecided);
      steps.changes.erase(steps.changes.begin() + 1);
    }
    expect_the_same(steps);
  }
}

/// One plan closes a loop, which takes a beam more; the other is held by none. Together they have
/// as many beams as would hold both, and yet another method is needed.
TEST(Kept, a_plan_that_touches_nothing_is_told_apart) {
  const auto robot = model::Robot::create(
      {.existing = {{0, 0, 0}, {1, 0, 0}, {0, -1, 0}, {0, -2, 0}, {0, -3, 0}}});
  ASSERT_TRUE(robot);
  sim::SimulationOptions options{
      .link = sim::blinky_blocks_v2(), .time_max = 11'000'000, .anchor = 4};
  options.announcements = {{.at = 1'000'000, .module = 3, .cell = {1, -1, 0}},
                           {.at = 1'160'000, .module = 0, .cell = {0, -5, 1}}};
  sim::Simulation simulation(robot.value(), options);
  simulation.run();
  for (std::int32_t i = 0; i < simulation.agent_count(); ++i) {
    EXPECT_EQ(simulation.agent(i).answer().reason, agent::Reason::kPlannedDetached) << i;
  }
}

/// Every change starts a round, or none does.
TEST(Kept, rounds_begin_anew_only_without_it) {
  Cells start = row(0, 4);
  start.insert(start.begin(), {0, 0, 0});
  const auto robot = model::Robot::create({.existing = start, .fixed = {{0, 0, 0}}});
  ASSERT_TRUE(robot);
  for (const bool keeps : {false, true}) {
    sim::SimulationOptions options{.keeps_answers = keeps};
    options.announcements = {{.at = 2000, .module = 0, .cell = {4, 0, 1}},
                             {.at = 3000, .module = 2, .cell = {4, 0, 1}, .is_withdrawal = true}};
    sim::Simulation simulation(robot.value(), options);
    simulation.run();
    EXPECT_EQ(simulation.result().epoch, keeps ? 1 : 3);
    EXPECT_EQ(simulation.result().answer.verdict, agent::Verdict::kSafe);
    for (std::int32_t i = 0; i < simulation.agent_count(); ++i) {
      EXPECT_EQ(simulation.agent(i).announcements().count(), 0) << i;
    }
  }
}

}  // namespace
}  // namespace holdfast
