// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
//
// Plans whose length can be counted on a drawing, and tasks that are none.
#include "holdfast/plan/move_plan.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace holdfast::plan {
namespace {

using base::Cell;

MoveTask task_of(std::vector<Cell> start, std::vector<Cell> target) {
  return {.start = {.existing = std::move(start)}, .target = {.existing = std::move(target)}};
}

MovePlan plan_of(const MoveTask& task, const MoveOptions& options = {}) {
  return find_moves(task, options).value();
}

std::vector<std::pair<Cell, Cell>> moves_in(const MovePlan& plan) {
  std::vector<std::pair<Cell, Cell>> moves;
  for (const model::Step& step : plan.steps) {
    moves.emplace_back(step.moves.at(0).from, step.moves.at(0).to);
  }
  return moves;
}

std::string fault_of(const MoveTask& task) { return find_moves(task).error().message; }

TEST(MovePlan, a_module_slides_along_a_row_and_turns_around_its_end) {
  const std::vector<Cell> row = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}};
  std::vector<Cell> start = row;
  start.push_back({0, 0, 1});
  std::vector<Cell> target = row;
  target.push_back({3, 0, 0});
  const MovePlan plan = plan_of(task_of(start, target));
  ASSERT_EQ(plan.outcome, MoveOutcome::kFound);
  EXPECT_TRUE(plan.is_shortest);
  const std::vector<std::pair<Cell, Cell>> expected = {
      {{0, 0, 1}, {1, 0, 1}}, {{1, 0, 1}, {2, 0, 1}}, {{2, 0, 1}, {3, 0, 0}}};
  EXPECT_EQ(moves_in(plan), expected);
  ASSERT_TRUE(plan.judgement);
  EXPECT_EQ(plan.judgement->verdict(), verdict::Verdict::kSafe);
}

TEST(MovePlan, an_undecided_target_proves_nothing) {
  // It stands by the rigid body; by the elastic solution its feet may slip, beside a wall.
  MoveTask task = task_of({{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {0, 0, 1}, {1, 0, 1}, {2, 0, 1}},
                          {{0, 0, 0}, {2, 0, 0}, {0, 0, 1}, {1, 0, 1}, {2, 0, 1}, {2, 0, 2}});
  task.start.floor.friction = 0.01;
  task.target.floor.friction = 0.01;
  const model::Obstacle wall = {
      .from = {}, .to = {}, .cells = {{3, 0, 2}}, .touch = {.friction = 0.01}};
  task.start.obstacles = task.target.obstacles = {wall};
  const MovePlan plan = plan_of(task);
  EXPECT_EQ(plan.outcome, MoveOutcome::kNotFound);
  EXPECT_EQ(plan.undecided_count, 1U);
  EXPECT_FALSE(plan.certificate);
  const MoveCertificate certificate{.task = task,
                                    .target = Judgement{.verdict = verdict::Verdict::kUndecided}};
  EXPECT_FALSE(verify(certificate));
}

TEST(MovePlan, the_same_shape_needs_no_step) {
  const MovePlan plan = plan_of(task_of({{0, 0, 0}, {0, 0, 1}}, {{0, 0, 1}, {0, 0, 0}}));
  EXPECT_EQ(plan.outcome, MoveOutcome::kFound);
  EXPECT_TRUE(plan.steps.empty());
  EXPECT_TRUE(plan.is_shortest);
}

TEST(MovePlan, a_cube_that_pivots_needs_the_cells_that_it_sweeps) {
  // Under a ceiling one cell above a sliding cube fits, and none that turns over its edge.
  const std::vector<Cell> row = {{0, 0, 0}, {1, 0, 0}, {0, 0, 2}, {1, 0, 2}, {2, 0, 0}, {2, 0, 2}};
  std::vector<Cell> start = row;
  start.insert(start.end(), {{3, 0, 0}, {3, 0, 1}, {3, 0, 2}, {0, 0, 1}});
  std::vector<Cell> target = start;
  target.back() = {1, 0, 1};
  MoveTask task = task_of(start, target);
  task.within = CellBox{.low = {0, 0, 0}, .high = {3, 0, 2}};
  EXPECT_EQ(plan_of(task).steps.size(), 1U);
  task.motions = pivoting_cubes();
  const MovePlan plan = plan_of(task);
  EXPECT_EQ(plan.outcome, MoveOutcome::kNone);
  EXPECT_EQ(verify(*plan.certificate).value().shape_count, 1U);
}

TEST(MovePlan, a_target_that_topples_is_none_with_its_verdict) {
  const MovePlan plan = plan_of(task_of({{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {3, 0, 0}},
                                        {{0, 0, 0}, {0, 0, 1}, {1, 0, 1}, {2, 0, 1}}));
  EXPECT_EQ(plan.outcome, MoveOutcome::kNone);
  ASSERT_TRUE(plan.certificate && plan.certificate->target);
  EXPECT_EQ(plan.certificate->target->verdict, verdict::Verdict::kUnstable);
  EXPECT_EQ(verify(*plan.certificate).value().target, verdict::Verdict::kUnstable);
  // It proves nothing where steps, and so the target, need not be safe.
  MoveCertificate other = *plan.certificate;
  other.task.ignores_mechanics = true;
  EXPECT_FALSE(verify(other));
  EXPECT_NE(find_moves(other.task).value().outcome, MoveOutcome::kNone);
}

TEST(MovePlan, modules_of_another_kind_change_places_where_those_alike_need_not) {
  MoveTask task = task_of({{0, 0, 0}, {1, 0, 0}, {2, 0, 0}}, {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}});
  task.start.own_masses = {{{0, 0, 0}, 0.1}};
  task.target.own_masses = {{{2, 0, 0}, 0.1}};
  const MovePlan plan = plan_of(task);
  EXPECT_EQ(plan.outcome, MoveOutcome::kFound);
  EXPECT_GT(plan.steps.size(), 0U);
  EXPECT_TRUE(plan.is_shortest);
}

TEST(MovePlan, is_the_same_with_any_number_of_threads_and_safe_for_every_seed) {
  const MoveTask task = task_of({{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {3, 0, 0}},
                                {{0, 0, 0}, {0, 0, 1}, {0, 0, 2}, {0, 0, 3}});
  const MovePlan one = plan_of(task, {.solver = {.thread_count = 1}});
  const MovePlan four = plan_of(task, {.solver = {.thread_count = 4}});
  EXPECT_EQ(moves_in(one), moves_in(four));
  for (const std::uint64_t seed : {1U, 2U, 3U}) {
    EXPECT_EQ(plan_of(task, {.seed = seed}).steps.size(), one.steps.size());
  }
}

TEST(MovePlan, that_is_interrupted_leaves_safe_steps_to_the_nearest_shape) {
  const MoveTask task = task_of({{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {3, 0, 0}, {4, 0, 0}},
                                {{0, 0, 0}, {0, 0, 1}, {0, 0, 2}, {0, 0, 3}, {0, 0, 4}});
  int asked = 0;
  const MovePlan plan = plan_of(task, {.is_interrupted = [&] { return ++asked > 12; }});
  EXPECT_EQ(plan.outcome, MoveOutcome::kNotFound);
  ASSERT_FALSE(plan.steps.empty());
  EXPECT_EQ(plan.judgement->verdict(), verdict::Verdict::kSafe);
  EXPECT_GT(plan.length_min, 0);
}

TEST(MovePlan, along_the_surface_is_safe_where_shapes_are_too_many) {
  // The exact search may judge next to nothing, so a module walks at a time.
  std::vector<Cell> start;
  std::vector<Cell> target;
  for (std::int32_t i = 0; i < 12; ++i) {
    start.push_back({i % 4, i / 4, 0});
    target.push_back({i % 2, i / 2 % 2, i / 4});
  }
  const MovePlan plan = plan_of(task_of(start, target), {.exact_count_max = 0});
  ASSERT_EQ(plan.outcome, MoveOutcome::kFound);
  EXPECT_GE(plan.steps.size(), static_cast<std::size_t>(plan.length_min));
  EXPECT_EQ(plan.judgement->verdict(), verdict::Verdict::kSafe);
}

TEST(MovePlan, to_where_nothing_safe_leads_is_proved_from_the_target) {
  // Below a plate a module of weight w hangs by 0.75 of the strength; half a cell further on its
  // way the same connection would carry w + 2 w (20 mm) / (40 mm), 1.5 times its strength. Above it
  // a module has 49 places.
  MoveTask task;
  for (std::int32_t i = 0; i < 49; ++i) {
    task.start.existing.push_back({i % 7, i / 7, 0});
  }
  task.start.support_z = std::nullopt;
  task.start.fixed = task.start.existing;
  task.start.material.strength_vertical_n = model::module_weight_n(task.start.material) / 0.75;
  task.target = task.start;
  task.start.existing.push_back({0, 0, 1});
  task.target.existing.push_back({3, 3, -1});
  const MovePlan plan = plan_of(task, {.exact_count_max = 0});
  ASSERT_EQ(plan.outcome, MoveOutcome::kNone);
  EXPECT_TRUE(plan.certificate->is_backward);
  EXPECT_EQ(plan.certificate->shapes.size(), 1U);
  EXPECT_EQ(verify(*plan.certificate).value().unsafe_count, 4U);
  MoveCertificate wrong = *plan.certificate;
  wrong.is_backward = false;
  EXPECT_FALSE(verify(wrong));
}

TEST(MovePlan, refuses_what_is_no_pair_of_shapes_of_one_robot) {
  const std::vector<Cell> row = {{0, 0, 0}, {1, 0, 0}};
  EXPECT_EQ(fault_of(task_of(row, {{0, 0, 0}})),
            "the robot has 2 modules and its target 1; expected shapes of the same modules");
  EXPECT_EQ(fault_of(task_of({{0, 0, 0}}, row)),
            "the robot has 1 module and its target 2; expected shapes of the same modules");
  MoveTask task = task_of(row, row);
  task.target.material.mass_kg = 1;
  EXPECT_EQ(fault_of(task),
            "both robots differ in material; expected two shapes of one robot where it stands");
  task = task_of(row, row);
  task.start.fixed = {{0, 0, 0}};
  EXPECT_EQ(fault_of(task),
            "the module (0,0,0) is fixed, and the target has no such fixed module there; fixed "
            "modules do not move");
  EXPECT_TRUE(fault_of(task_of(row, {{0, 0, 0}, {2, 0, 0}})).starts_with("the target: "));
  EXPECT_EQ(fault_of(task_of({{0, 0, 0}, {0, 0, 1}, {1, 0, 1}, {2, 0, 1}},
                             {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {3, 0, 0}})),
            "the robot is unstable before any step; a plan begins with a safe one");
  task = task_of(row, row);
  task.within = CellBox{.low = {1, 0, 0}, .high = {5, 5, 5}};
  EXPECT_EQ(fault_of(task),
            "the robot: the module (0,0,0) is outside the box from (1,0,0) to (5,5,5)");
  task = task_of(row, row);
  task.start.lattice = task.target.lattice = base::kFaceCentred;
  task.motions = pivoting_cubes();
  EXPECT_EQ(fault_of(task),
            "the motions \"pivoting\" are those of modules of another lattice than the robot's");
}

TEST(MovePlan, of_spheres_and_discs_is_safe_and_shortest) {
  for (const base::Lattice& lattice : {base::kFaceCentred, base::kHexagonal}) {
    MoveTask task = task_of({{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {0, 0, 1}},
                            {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {1, 0, 1}});
    task.start.lattice = task.target.lattice = lattice;
    const MovePlan plan = plan_of(task);
    EXPECT_EQ(plan.outcome, MoveOutcome::kFound);
    EXPECT_EQ(plan.steps.size(), 1U);
  }
}

TEST(LooseModules, are_those_without_which_the_rest_is_one_piece) {
  const model::RobotSpec spec{
      .existing = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {1, 0, 1}, {2, 0, 1}, {3, 0, 1}},
      .fixed = {{3, 0, 1}}};
  const RobotState robot(spec);
  std::vector<Cell> loose;
  for (const std::int32_t module : loose_modules(robot)) {
    loose.push_back(robot.module(module).cell);
  }
  std::ranges::sort(loose);
  EXPECT_EQ(loose, (std::vector<Cell>{{0, 0, 0}, {1, 0, 1}, {2, 0, 0}}));
}

}  // namespace
}  // namespace holdfast::plan
