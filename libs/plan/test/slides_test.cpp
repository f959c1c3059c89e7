// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
//
// Many cubes: what slides where, beside the moves of a robot; plans between random shapes, replayed
// by a second program that knows shapes only. Every pair of connected shapes with room around has a
// plan [Abel 2024]. HOLDFAST_SLIDE_CASES=N tries as many pairs as that.
#include <gtest/gtest.h>

#include <cstdlib>
#include <set>

#include "holdfast/plan/move_plan.hpp"
#include "moves/slide_moves.hpp"
#include "seeds.hpp"
#include "slide_support.hpp"
#include "slides/slide_grid.hpp"

namespace holdfast::plan {
namespace {

using base::Cell;
using test::Cells;

MoveTask task_of(const Cells& start, const Cells& target) {
  MoveTask task{.start = {.existing = {start.begin(), start.end()}},
                .target = {.existing = {target.begin(), target.end()}}};
  task.ignores_mechanics = true;
  return task;
}

TEST(SlideGrid, has_the_moves_of_a_robot) {
  base::Rng rng(1);
  const std::uint64_t case_count = holdfast::test::campaign(300U, 100U);
  std::size_t move_count = 0;
  for (std::uint64_t i = 0; i < case_count; ++i) {
    const Cells cells = test::random_blob(2 + rng.below(14), {-2, -2, 0}, {2, 2, 2}, {}, rng);
    const RobotState robot({.existing = {cells.begin(), cells.end()},
                            .obstacles = {{.from = {3, 0, 0}, .to = {3, 0, 0}}}});
    SlideGrid grid({.low = {-3, -3, 0}, .high = {4, 4, 4}});
    grid.set(grid.find({3, 0, 0}), SlideGrid::What::kBarred);
    for (const Cell& cell : cells) {
      grid.set(grid.find(cell), SlideGrid::What::kModule);
    }
    for (const std::int32_t module : loose_modules(robot)) {
      const Cell from = robot.module(module).cell;
      std::set<Cell> expected;
      for (const model::Move& move :
           moves_of(robot, module, {.floor_z = 0, .within = CellBox{{-3, -3, 0}, {4, 4, 4}}})) {
        expected.insert(move.to);
      }
      std::set<Cell> found;
      grid.set(grid.find(from), SlideGrid::What::kFree);
      grid.for_each_move(grid.find(from), [&](GridCell to) { found.insert(grid.cell(to)); });
      grid.set(grid.find(from), SlideGrid::What::kModule);
      EXPECT_EQ(found, expected) << "case " << i;
      move_count += found.size();
    }
  }
  EXPECT_GT(move_count, 10 * case_count);
}

TEST(SlideGrid, air_is_parted_where_a_hole_is_closed) {
  SlideGrid grid({.low = {0, 0, 0}, .high = {4, 4, 4}});
  for (const Cell& side : brute_force::sides()) {
    if (side.z != 1) {
      grid.set(grid.find({2 + side.x, 2 + side.y, 2 + side.z}), SlideGrid::What::kModule);
    }
  }
  EXPECT_FALSE(grid.may_part_air(grid.find({2, 2, 2})));  // Nothing is below it.
  EXPECT_TRUE(grid.may_part_air(grid.find({2, 2, 3})));   // A hole is.
  EXPECT_FALSE(grid.may_part_air(grid.find({0, 0, 0})));
}

/// What the constructive planner alone finds, however few the cubes are.
SlideMoves slides_of(const MoveTask& task, const CellBox& box) {
  const auto space = ShapeSpace::create(RobotState(task.start), RobotState(task.target)).value();
  const MoveOptions options;
  MoveJudge judge(task, options);
  return find_slides(space, {.floor_z = 0, .within = box}, 0, judge).value();
}

/// A pair of shapes of one robot, some with fixed modules or obstacles. Some pairs have no cell in
/// common and are further apart than the robot is long; few of these are not found.
void compare(std::uint64_t seed, int& far_count, int& far_missed) {
  SCOPED_TRACE("seed " + std::to_string(seed));
  base::Rng rng(seed);
  const bool is_flat = rng.below(3) == 0;
  const std::int32_t reach = 2 + static_cast<std::int32_t>(rng.below(4));
  const Cell low = {-reach, is_flat ? 0 : -reach, 0};
  const Cell high = {reach, is_flat ? 0 : reach, reach};
  const Cells barred = !is_flat && rng.below(3) == 0 ? Cells{{1, 0, 1}, {0, 0, 2}} : Cells{};
  const std::size_t count = 3 + rng.below(is_flat ? 10 : 30);
  const Cells start = test::random_blob(count, low, high, barred, rng);
  Cells target;
  const std::int32_t away = rng.below(4) == 0 ? 12 : 0;
  for (const Cell& cell : test::random_blob(count, low, high, barred, rng)) {
    target.insert({cell.x + away, cell.y, cell.z});
  }
  MoveTask task = task_of(start, target);
  const bool is_fixed = away == 0 && rng.below(2) == 0;
  const Cells fixed = is_fixed ? Cells{{0, 0, 0}} : Cells{};
  task.start.fixed.assign(fixed.begin(), fixed.end());
  for (const Cell& cell : barred) {
    task.start.obstacles.push_back({.from = cell, .to = cell});
  }
  task.target.fixed = task.start.fixed;
  task.target.obstacles = task.start.obstacles;
  const SlideMoves found =
      slides_of(task, {.low = {-9, is_flat ? 0 : -9, 0}, .high = {99, is_flat ? 0 : 9, 20}});
  far_count += away != 0 ? 1 : 0;
  far_missed += away != 0 && !found.is_found ? 1 : 0;
  ASSERT_TRUE(found.is_found || away != 0);
  if (!found.is_found) {
    return;
  }
  std::vector<model::Step> steps;
  for (const model::Move& move : found.moves) {
    steps.push_back(step_of(move));
  }
  test::Replayer replayer(start, fixed, barred);
  EXPECT_TRUE(replayer.run(steps));
  EXPECT_EQ(replayer.cells(), target);
}

TEST(Slides, lead_from_any_shape_to_any_other) {
  const char* const wanted = std::getenv("HOLDFAST_SLIDE_CASES");
  const std::uint64_t case_count =
      wanted != nullptr ? std::strtoull(wanted, nullptr, 10) : holdfast::test::campaign(400U, 20U);
  int far_count = 0;
  int far_missed = 0;
  for (std::uint64_t seed = 1; seed <= case_count && !testing::Test::HasFatalFailure(); ++seed) {
    compare(seed, far_count, far_missed);
  }
  RecordProperty("far", far_count);
  RecordProperty("far_missed", far_missed);
  EXPECT_LE(20 * far_missed, far_count);
}

TEST(Slides, of_many_cubes_are_safe_at_every_stage_and_short) {
  // A block becomes a plate of one layer, with the strengths of Blinky Blocks.
  Cells start;
  Cells target;
  for (std::int32_t i = 0; i < 64; ++i) {
    start.insert({2 + i % 4, 2 + i / 4 % 4, i / 16});
    target.insert({i % 8, i / 8, 0});
  }
  MoveTask task = task_of(start, target);
  task.ignores_mechanics = false;
  const MovePlan plan = find_moves(task).value();
  ASSERT_EQ(plan.outcome, MoveOutcome::kFound);
  ASSERT_TRUE(plan.judgement);
  EXPECT_EQ(plan.judgement->steps.size(), plan.steps.size());
  EXPECT_EQ(plan.judgement->verdict(), verdict::Verdict::kSafe);
  EXPECT_LE(2 * plan.steps.size(), 3 * static_cast<std::size_t>(plan.assignment_bound));
  test::Replayer replayer(start, {});
  EXPECT_TRUE(replayer.run(plan.steps));
  EXPECT_EQ(replayer.cells(), target);
  // The search keeps its judgements; judged anew they are the same.
  const SequenceJudgement anew = judge_sequence(task.start, plan.steps).value();
  EXPECT_EQ(anew.verdict(), verdict::Verdict::kSafe);
  EXPECT_EQ(anew.margin_min_mm, plan.judgement->margin_min_mm);
  EXPECT_NEAR(*anew.load_ratio_max, *plan.judgement->load_ratio_max, 1e-7);
}

/// Plans of few weak cubes beside brute_force: each move of a plan is one of its safe moves, and
/// there is a plan. Counts what was found, and pairs with a plan that was not.
void compare_weak(std::uint64_t seed, int& found_count, int& missed_count) {
  SCOPED_TRACE("seed " + std::to_string(seed));
  base::Rng rng(seed);
  brute_force::World world;
  world.low = {-1, 0, 0};
  world.high = {2, static_cast<std::int32_t>(rng.below(2)), 2};
  const double strength = 0.4 + 0.2 * static_cast<double>(rng.below(12));
  world.spec.material.strength_vertical_n = strength;
  world.spec.material.strength_lateral_n = 1.25 * strength;
  const std::size_t count = 3 + rng.below(3);
  Cells cells = test::random_blob(count, world.low, world.high, {}, rng);
  const Cells target = test::random_blob(count, world.low, world.high, {}, rng);
  if (!brute_force::is_safe(world, cells) || !brute_force::is_safe(world, target)) {
    return;
  }
  const auto truth = brute_force::shortest(world, cells, target);
  MoveTask task = task_of(cells, target);
  task.ignores_mechanics = false;
  task.start.material = task.target.material = world.spec.material;
  const SlideMoves found = slides_of(task, {.low = world.low, .high = world.high});
  EXPECT_TRUE(truth || !found.is_found);
  for (const model::Move& move : found.moves) {
    const std::vector<Cell> ends = brute_force::ends(world, cells, move.from);
    ASSERT_NE(std::ranges::find(ends, move.to), ends.end());
    cells.erase(move.from);
    cells.insert(move.to);
  }
  EXPECT_EQ(found.judged.size(), found.moves.size());
  EXPECT_TRUE(!found.is_found || cells == target);
  found_count += found.is_found ? 1 : 0;
  missed_count += truth && !found.is_found ? 1 : 0;
}

TEST(Slides, that_are_not_safe_are_not_made) {
  const std::uint64_t case_count = holdfast::test::campaign(150U, 20U);
  int found_count = 0;
  int missed_count = 0;
  for (std::uint64_t seed = 1; seed <= case_count && !testing::Test::HasFatalFailure(); ++seed) {
    compare_weak(seed, found_count, missed_count);
  }
  RecordProperty("found", found_count);
  RecordProperty("missed", missed_count);
  EXPECT_GT(found_count, static_cast<int>(case_count) / 8);
}

}  // namespace
}  // namespace holdfast::plan
