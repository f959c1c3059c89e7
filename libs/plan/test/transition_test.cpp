// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
//
// Which moves of cubes there are follows from cells alone: a slide by one cell needs two modules
// side by side, one beside each of its ends on the same side; a turn goes to a cell across an edge,
// with a module in one of the two cells between and nothing in the other.
#include "holdfast/plan/transition.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdlib>

#include "moves.hpp"
#include "random_robot.hpp"

namespace holdfast::plan {
namespace {

using base::Cell;

Cell plus(const Cell& a, const Cell& b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }

bool can_slide(const RobotState& robot, const Cell& from, const Cell& to) {
  const auto is_there = [&](const Cell& cell) {
    return cell != from && robot.find(cell) != RobotState::kNone;
  };
  for (const base::Direction side : base::kDirections) {
    if (is_there(base::neighbour(from, side)) && is_there(base::neighbour(to, side))) {
      return true;
    }
  }
  return false;
}

bool can_turn(const RobotState& robot, const Cell& from, const Cell& to) {
  std::size_t there_count = 0;
  for (const base::Direction side : base::kDirections) {
    const Cell between = base::neighbour(from, side);
    const bool is_beside =
        std::abs(between.x - to.x) + std::abs(between.y - to.y) + std::abs(between.z - to.z) == 1;
    there_count += is_beside && robot.find(between) != RobotState::kNone ? 1 : 0;
  }
  return there_count == 1;
}

bool is_expected(const RobotState& robot, const Cell& from, const Cell& to) {
  if (robot.find(to) != RobotState::kNone) {
    return false;
  }
  const Cell way = plus(to, {-from.x, -from.y, -from.z});
  const int length = std::abs(way.x) + std::abs(way.y) + std::abs(way.z);
  const bool is_straight = std::abs(way.x) == 2 || std::abs(way.y) == 2 || std::abs(way.z) == 2;
  return length == 1 ? can_slide(robot, from, to) : is_straight ? false : can_turn(robot, from, to);
}

TEST(Transition, finds_every_move_of_a_cube_that_there_is) {
  std::size_t found_count = 0;
  for (std::uint64_t seed = 0; seed < 40; ++seed) {
    model::RobotSpec spec = holdfast::test::random_robot(seed, 3, 20);
    spec.planned.clear();
    spec.fixed.clear();
    const RobotState robot(spec);
    for (const ModuleState& module : robot.modules()) {
      for (const Cell& to : test::cells_near(robot.lattice(), module.cell)) {
        const bool is_found = find_transition(robot, test::move(module.cell, to)).has_value();
        EXPECT_EQ(is_found, to != module.cell && is_expected(robot, module.cell, to))
            << seed << model::text(module.cell) << model::text(to);
        found_count += is_found ? 1 : 0;
      }
    }
  }
  EXPECT_GT(found_count, 500);
}

TEST(Transition, leaves_the_state_that_it_says) {
  RobotState robot(model::RobotSpec{.existing = {{0, 0, 0}, {1, 0, 0}, {0, 0, 1}},
                                    .own_masses = {{{0, 0, 1}, 0.5}},
                                    .payloads = {{.cell = {0, 0, 1}, .force_n = {0, 0, -3}}}});
  model::Step step = test::move({0, 0, 1}, {1, 0, 1});
  step.attach = {{2, 0, 0}};
  apply(step, find_transition(robot, step).value(), robot);
  const model::RobotSpec spec = robot.spec();
  EXPECT_EQ(spec.existing, (std::vector<Cell>{{0, 0, 0}, {1, 0, 0}, {1, 0, 1}, {2, 0, 0}}));
  ASSERT_EQ(spec.own_masses.size(), 1);
  EXPECT_EQ(spec.own_masses[0].cell, (Cell{1, 0, 1}));
  ASSERT_EQ(spec.payloads.size(), 1);
  EXPECT_EQ(spec.payloads[0].cell, (Cell{1, 0, 1}));
}

TEST(Transition, keeps_what_is_released_until_it_is_connected) {
  RobotState robot(model::RobotSpec{.existing = {{0, 0, 0}, {1, 0, 0}}});
  const auto go = [&](const model::Step& step) {
    const auto transition = find_transition(robot, step);
    ASSERT_TRUE(transition) << transition.error().message;
    apply(step, transition.value(), robot);
  };
  const model::CellPair pair = {Cell{1, 0, 0}, Cell{0, 0, 0}};
  go({.release = {pair}});
  EXPECT_FALSE(robot.are_connected(pair[0], pair[1]));
  go({.attach = {{1, 0, 1}}});
  EXPECT_FALSE(robot.are_connected(pair[0], pair[1]));
  go({.connect = {pair}});
  EXPECT_TRUE(robot.are_connected(pair[0], pair[1]));
}

/// What is wrong with a step of a robot of four modules, one of them fixed, and an obstacle.
std::string fault_of(const model::Step& step) {
  const RobotState robot(model::RobotSpec{
      .existing = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {1, 0, 1}},
      .fixed = {{0, 0, 0}},
      .obstacles = {{.from = {2, 0, 1}, .to = {2, 0, 1}, .cells = {}, .touch = {}}}});
  const auto found = find_transition(robot, step);
  return found ? "none" : found.error().message;
}

TEST(Transition, says_what_cannot_be_done_and_in_which_stage) {
  const auto carried = [](const Cell& from, const Cell& to, const Cell& carrier) {
    return model::Step{.moves = {{.from = from, .to = to, .carrier = carrier}}};
  };
  const std::pair<model::Step, std::string> cases[] = {
      {test::move({5, 5, 5}, {5, 5, 6}),
       "release: no module can move from (5,5,5) to (5,5,6): no "},
      {test::move({0, 0, 0}, {0, 0, 1}),
       "release: no module can move from (0,0,0) to (0,0,1): that"},
      {{.detach = {{7, 0, 0}}}, "release: no module can be detached at (7,0,0): none is there"},
      {{.detach = {{2, 0, 0}, {2, 0, 0}}}, "release: no module can be detached at (2,0,0): it is "},
      {{.release = {{Cell{0, 0, 0}, Cell{2, 0, 0}}}},
       "release: (0,0,0)-(2,0,0) cannot be released"},
      {test::move({1, 0, 1}, {1, 0, 0}),
       "shift: (1,0,1) cannot go to (1,0,0): (1,0,0) is occupied"},
      {test::move({1, 0, 1}, {2, 0, 1}),
       "shift: (1,0,1) cannot go to (2,0,1): (2,0,1) is occupied"},
      {test::move({1, 0, 1}, {1, 0, 1}),
       "shift: (1,0,1) cannot go to (1,0,1): it is there already"},
      {test::move({1, 0, 1}, {1, 0, 2}), "shift: (1,0,1) cannot go to (1,0,2): no module carries"},
      {test::move({1, 0, 1}, {5, 0, 1}), "shift: (1,0,1) cannot go to (5,0,1): there is no slide"},
      {carried({1, 0, 1}, {0, 0, 1}, {9, 0, 0}),
       "shift: (1,0,1) cannot go to (0,0,1): the carrier"},
      {carried({1, 0, 1}, {1, 0, -1}, {1, 0, 0}),
       "shift: (1,0,1) cannot go to (1,0,-1): that is out of reach of its carrier (1,0,0)"},
      {{.attach = {{1, 0, 0}}}, "connect: no module can be attached at (1,0,0): a module is there"},
      {{.attach = {{2, 0, 1}}}, "connect: no module can be attached at (2,0,1): an obstacle is"},
      {{.connect = {{Cell{0, 0, 0}, Cell{1, 0, 0}}}},
       "connect: (0,0,0)-(1,0,0) cannot be connected"}};
  for (const auto& [step, message] : cases) {
    EXPECT_EQ(fault_of(step).substr(0, message.size()), message);
  }
}

/// One module in the face-centred lattice, and what it hangs on: a sphere in a hollow of four.
model::RobotSpec hanging_sphere() {
  return {.existing = {{0, 0, 1}, {0, 1, 0}}, .fixed = {{0, 0, 1}}, .lattice = base::kFaceCentred};
}

std::string fault_of(const model::RobotSpec& spec, const model::Step& step) {
  const auto found = find_transition(RobotState(spec), step);
  return found ? "none" : found.error().message;
}

TEST(Transition, turns_through_no_floor) {
  // Under the sphere at (0,0,1) the modules (0,1,0) and (1,0,0) lie across from each other. About
  // it the way between them leads over (0,0,-1), which touches all four below the sphere.
  const model::RobotSpec standing = hanging_sphere();
  const model::Step step = test::move({0, 1, 0}, {1, 0, 0});
  EXPECT_EQ(
      fault_of(standing, step),
      "shift: (0,1,0) cannot go to (1,0,0): there is no slide by one cell and no turn about a "
      "corner that leads there");
  model::Step named = step;
  named.moves[0].carrier = Cell{0, 0, 1};
  EXPECT_EQ(fault_of(standing, named),
            "shift: (0,1,0) cannot go to (1,0,0): on its way (0,0,-1) is below the floor");
  // No floor bars where there is none, or where a module of the robot is below, before or after.
  model::RobotSpec held = standing;
  held.support_z = std::nullopt;
  EXPECT_EQ(fault_of(held, step), "none");
  held = standing;
  held.existing.push_back({0, -1, -1});
  EXPECT_EQ(fault_of(held, step), "none");
  model::Step attaching = step;
  attaching.attach = {{0, -1, -1}};
  EXPECT_EQ(fault_of(standing, attaching), "none");
}

TEST(Transition, knows_the_only_way_above_the_floor) {
  // Beside the sphere in the floor's layer the way leads over (1,1,0).
  model::RobotSpec spec = hanging_sphere();
  spec.existing.push_back({0, 0, 0});
  const auto found = find_transition(RobotState(spec), test::move({0, 1, 0}, {1, 0, 0}));
  ASSERT_TRUE(found) << found.error().message;
  const Group& group = found.value().groups.at(0);
  EXPECT_EQ(group.way.at(2), (Cell{2, 0, 0}));
  EXPECT_EQ(group.carriers, std::vector(5, std::vector<Cell>{{0, 0, 0}}));
}

/// Two spheres, connected and both beside a third, that go one cell along x and one along y: both
/// ways over a cell between lead about the third, one along x first, the other upwards first.
model::RobotSpec two_about_one() {
  return {.existing = {{1, 1, 2}, {1, 0, 2}, {0, 0, 3}},
          .fixed = {{1, 1, 2}},
          .support_z = std::nullopt,
          .lattice = base::kFaceCentred};
}

/// A step with its moves in both orders, each with a carrier or without.
std::vector<model::Step> in_both_orders(const std::optional<Cell>& lower,
                                        const std::optional<Cell>& upper) {
  const model::Move a{.from = {1, 0, 2}, .to = {2, 1, 2}, .carrier = lower};
  const model::Move b{.from = {0, 0, 3}, .to = {1, 1, 3}, .carrier = upper};
  return {{.moves = {a, b}}, {.moves = {b, a}}};
}

TEST(Transition, refuses_a_group_with_two_ways_about_one_carrier) {
  const auto expect_refusal = [](const std::optional<Cell>& carrier, const std::string& message) {
    for (const model::Step& step : in_both_orders(carrier, carrier)) {
      const std::string fault = fault_of(two_about_one(), step);
      EXPECT_NE(fault.find(message), std::string::npos) << fault;
    }
  };
  expect_refusal({}, "there is more than one way; name its carrier");
  expect_refusal(Cell{1, 1, 2}, "there is more than one way about its carrier (1,1,2)");
}

TEST(Transition, takes_the_way_of_a_group_that_is_left_in_any_order_of_its_moves) {
  const auto expect_way = [](const model::RobotSpec& spec, const std::vector<model::Step>& steps,
                             const Cell& middle) {
    for (const model::Step& step : steps) {
      const auto found = find_transition(RobotState(spec), step);
      ASSERT_TRUE(found) << found.error().message;
      EXPECT_EQ(found.value().groups.at(0).way.at(2), middle);
    }
  };
  // An obstacle bars the way along x.
  model::RobotSpec barred = two_about_one();
  barred.obstacles = {{.from = {2, 0, 2}, .to = {2, 0, 2}, .cells = {}, .touch = {}}};
  expect_way(barred, in_both_orders({}, {}), {0, 0, 2});
  expect_way(barred, in_both_orders(Cell{1, 1, 2}, Cell{1, 1, 2}), {0, 0, 2});
  // About (0,1,3), which the upper module leaves along x and ends beside, there is the other only.
  model::RobotSpec beside = two_about_one();
  beside.existing.push_back({0, 1, 3});
  expect_way(beside, in_both_orders(Cell{1, 1, 2}, Cell{0, 1, 3}), {2, 0, 0});
}

/// A connection keeps what it is called by where both of its modules move, and ends with one.
TEST(RobotState, connections_keep_their_tags_as_groups_move) {
  model::RobotSpec spec{.existing = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {3, 0, 0}}};
  const Cell a{2, 0, 0};
  const Cell b{3, 0, 0};
  spec.own_connectors.push_back({.between = {b, a}, .law = {}, .tag = 7});
  spec.own_connectors.push_back({.between = {Cell{0, 0, 0}, Cell{1, 0, 0}}, .law = {}, .tag = 3});
  const model::Robot robot = model::Robot::create(spec).value();
  std::vector<std::int32_t> tags;
  for (const model::Connection& pair : robot.connections()) {
    tags.push_back(robot.connector_tag(pair));
  }
  std::ranges::sort(tags);
  EXPECT_EQ(tags, (std::vector<std::int32_t>{model::OwnConnector::kNoTag, 3, 7}));
  RobotState state(spec);
  const std::array from = {a, b};
  const std::array to = {Cell{2, 1, 0}, Cell{3, 1, 0}};
  state.move(from, to);
  const model::RobotSpec moved = state.spec();
  const auto found = std::ranges::find(moved.own_connectors, 7, &model::OwnConnector::tag);
  ASSERT_NE(found, moved.own_connectors.end());
  EXPECT_EQ(found->between, (model::CellPair{to[0], to[1]}));
  state.remove(to[1]);
  EXPECT_EQ(state.spec().own_connectors.size(), 1U);
}

}  // namespace
}  // namespace holdfast::plan
