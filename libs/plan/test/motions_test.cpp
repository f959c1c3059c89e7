// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
//
// Motions as data: their images are as many as the point group has, none is twice, and each of them
// is the motion as the turned robot has it; a module goes where a motion leads whose cells are as
// it needs them, and nowhere else; none goes between two that are opposite to each other if it is
// not to.
#include "holdfast/plan/motions.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <set>
#include <utility>
#include <vector>

#include "grown_robot.hpp"
#include "holdfast/base/rng.hpp"
#include "holdfast/plan/module_moves.hpp"
#include "moves.hpp"
#include "seeds.hpp"

namespace holdfast::plan {
namespace {

using base::Cell;

std::set<Cell> ends_of(const RobotState& robot, const Cell& from, const Motions& motions) {
  std::set<Cell> ends;
  for (const model::Move& move : moves_of(robot, robot.find(from),
                                          {.motions = std::make_shared<const Motions>(motions),
                                          .floor_z = robot.surroundings().support_z})) {
    ends.insert(move.to);
  }
  return ends;
}

TEST(Motions, have_as_many_images_as_the_lattice_has_maps) {
  // A motion without a symmetry of its own: cells in general places.
  const Motion skew = {.to = {1, 0, 0}, .modules = {{2, 3, 5}}, .free = {{4, -7, 1}}};
  const std::vector<std::pair<base::Lattice, std::array<std::size_t, 2>>> groups = {
      {base::kCubic, {24, 48}},
      {base::kFaceCentred, {24, 48}},
      {base::kHexagonal, {12, 24}},
      {base::kHexagonalPrism, {12, 24}}};
  for (const auto& group : groups) {
    const base::Lattice& lattice = group.first;
    const std::array<std::size_t, 2>& count = group.second;
    EXPECT_EQ(images_of(lattice, skew, MotionImages::kNone).size(), 1U);
    EXPECT_EQ(images_of(lattice, skew, MotionImages::kTurned).size(), count[0]);
    EXPECT_EQ(images_of(lattice, skew, MotionImages::kMirrored).size(), count[1]);
    for (const Motion& image : images_of(lattice, skew, MotionImages::kMirrored)) {
      const auto length = [&](const Cell& cell) {
        const auto place = base::place_of<double>(lattice, cell);
        return place[0] * place[0] + place[1] * place[1] + place[2] * place[2];
      };
      EXPECT_NEAR(length(image.modules[0]), length(skew.modules[0]), 1e-9);
      EXPECT_NEAR(length(image.free[0]), length(skew.free[0]), 1e-9);
    }
  }
  // A slide over two modules is its own mirror image: 24 of them, all turned ones.
  const Motion slide = {.to = {1, 0, 0}, .modules = {{0, 0, -1}, {1, 0, -1}}, .free = {}};
  EXPECT_EQ(images_of(base::kCubic, slide, MotionImages::kTurned).size(), 24U);
  EXPECT_EQ(images_of(base::kCubic, slide, MotionImages::kMirrored).size(), 24U);
}

/// A slide along two modules in a row, and a turn about one over the free cell beside it: the moves
/// of sliding cubes whose slides are carried by nothing else.
Motions sliding() {
  Motions motions{.name = "sliding"};
  for (const Motion& each : std::vector<Motion>{
           {.name = "slide", .to = {1, 0, 0}, .modules = {{0, 0, -1}, {1, 0, -1}}, .free = {}},
           {.name = "turn", .to = {1, 0, -1}, .modules = {{0, 0, -1}}, .free = {{1, 0, 0}}}}) {
    std::ranges::move(images_of(base::kCubic, each, MotionImages::kTurned),
                      std::back_inserter(motions.motions));
  }
  return motions;
}

TEST(Motions, of_sliding_cubes_lead_where_sliding_cubes_go) {
  base::Rng rng(3);
  std::size_t count = 0;
  for (int round = 0; round < holdfast::test::campaign(200); ++round) {
    const model::RobotSpec spec = test::grown_robot(base::kCubic, 3 + rng.below(10), rng);
    const RobotState robot(spec);
    for (const std::int32_t module : loose_modules(robot)) {
      const Cell from = robot.module(module).cell;
      std::set<Cell> own;
      for (const model::Move& move : moves_of(robot, module, {})) {
        own.insert(move.to);
      }
      EXPECT_EQ(ends_of(robot, from, sliding()), own) << round << ": " << model::text(from);
      count += own.size();
    }
  }
  EXPECT_GE(count, holdfast::test::least(1000U));
}

TEST(Motions, need_their_modules_and_their_free_cells) {
  const RobotState robot(
      model::RobotSpec{.existing = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {0, 0, 1}}, .support_z = 0});
  Motions motions{.name = "one"};
  motions.motions = {
      {.name = "slide", .to = {1, 0, 0}, .modules = {{0, 0, -1}, {1, 0, -1}}, .free = {{2, 0, 0}}}};
  EXPECT_EQ(ends_of(robot, {0, 0, 1}, motions), (std::set<Cell>{{1, 0, 1}}));
  motions.motions[0].free = {{2, 0, -1}};
  EXPECT_TRUE(ends_of(robot, {0, 0, 1}, motions).empty());
  motions.motions[0].free = {{0, 0, -2}};  // Below the floor.
  EXPECT_TRUE(ends_of(robot, {0, 0, 1}, motions).empty());
  motions.motions[0].free = {};
  motions.motions[0].modules = {{0, 0, -1}, {3, 0, -1}};
  EXPECT_TRUE(ends_of(robot, {0, 0, 1}, motions).empty());
}

TEST(Motions, lead_between_no_two_opposite_modules_if_they_are_not_to) {
  // Along a wall into a gap between two modules, and past it.
  const auto with_one_at = [](const Cell& cell) {
    model::RobotSpec spec{
        .existing = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {1, 1, 0}, {1, -1, 0}, {1, 1, 1}, {1, -1, 1}},
        .support_z = 0};
    spec.existing.push_back(cell);
    return RobotState(spec);
  };
  const RobotState robot = with_one_at({0, 0, 1});
  Motions motions = sliding();
  EXPECT_TRUE(ends_of(robot, {0, 0, 1}, motions).contains({1, 0, 1}));
  motions.goes_between = false;
  const std::set<Cell> ends = ends_of(robot, {0, 0, 1}, motions);
  EXPECT_FALSE(ends.contains({1, 0, 1}));
  EXPECT_FALSE(ends.empty());
  // Who is there does not leave.
  const RobotState inside = with_one_at({1, 0, 1});
  EXPECT_TRUE(ends_of(inside, {1, 0, 1}, motions).empty());
  motions.goes_between = true;
  EXPECT_FALSE(ends_of(inside, {1, 0, 1}, motions).empty());
}

/// Whether modules other than the one at `from` are on opposite sides of a cell.
bool is_between(const model::RobotSpec& spec, const Cell& cell, const Cell& from) {
  const auto has = [&](base::Direction direction) {
    const Cell beside = base::neighbour(spec.lattice, cell, direction);
    return beside != from && std::ranges::find(spec.existing, beside) != spec.existing.end();
  };
  for (const base::Direction direction : base::directions(spec.lattice)) {
    if (has(direction) && has(base::opposite(direction))) {
      return true;
    }
  }
  return false;
}

TEST(Motions, without_those_between_opposing_modules_are_all_others) {
  base::Rng rng(5);
  std::size_t kept = 0;
  std::size_t barred = 0;
  for (const base::Lattice& lattice :
       {base::kCubic, base::kFaceCentred, base::kHexagonal, base::kHexagonalPrism}) {
    const Motions motions{.lattice = lattice, .goes_between = false};
    for (int round = 0; round < holdfast::test::campaign(100); ++round) {
      const model::RobotSpec spec = test::grown_robot(lattice, 3 + rng.below(10), rng);
      const RobotState robot(spec);
      for (const std::int32_t module : loose_modules(robot)) {
        const Cell from = robot.module(module).cell;
        const std::set<Cell> ends = ends_of(robot, from, motions);
        for (const model::Move& move : moves_of(robot, module, {})) {
          const bool is_barred = is_between(spec, from, from) || is_between(spec, move.to, from);
          EXPECT_EQ(ends.contains(move.to), !is_barred) << round << ": " << model::text(move.to);
          ++(is_barred ? barred : kept);
        }
      }
    }
  }
  EXPECT_GE(kept, holdfast::test::least(1000U));
  EXPECT_GE(barred, holdfast::test::least(100U));
}

TEST(Motions, that_no_module_has_are_refused) {
  const auto fault_of = [](Motion motion) {
    const auto valid = valid_motion(base::kCubic, std::move(motion));
    return valid ? std::string() : valid.error().message;
  };
  EXPECT_EQ(fault_of({.to = {2, 0, 0}, .modules = {{1, 0, 0}}}),
            "the way from (0,0,0) to (2,0,0) is neither one to a neighbouring cell nor one "
            "around the corner of a module");
  EXPECT_EQ(fault_of({.to = {1, 0, 0}}), "expected at least one module that it goes along");
  EXPECT_EQ(fault_of({.to = {1, 0, 0}, .modules = {{1, 0, 0}}}),
            "the cell (1,0,0) cannot have a module and be free for the motion as well");
  EXPECT_EQ(fault_of({.to = {1, 0, 0}, .modules = {{0, 0, -1}}, .free = {{0, 0, -1}}}),
            "the cell (0,0,-1) cannot have a module and be free for the motion as well");
  EXPECT_EQ(fault_of({.to = {1, 0, -1}, .modules = {{0, 0, -1}}, .free = {{1, 0, 0}}}), "");
}

TEST(Motions, bar_moves_of_steps) {
  const RobotState robot(
      model::RobotSpec{.existing = {{0, 0, 0}, {1, 0, 0}, {0, 0, 1}}, .support_z = 0});
  const auto barred = [&](const Cell& from, const Cell& to) {
    const model::Step step = test::move(from, to);
    const auto error =
        find_barred_move(robot, step, find_transition(robot, step).value(), pivoting_cubes());
    return error ? error->message : std::string();
  };
  EXPECT_EQ(barred({0, 0, 1}, {1, 0, 1}), "");
  const RobotState low(model::RobotSpec{
      .existing = {{0, 0, 0}, {1, 0, 0}, {0, 0, 1}, {0, 0, 2}, {1, 0, 2}, {2, 0, 2}, {2, 0, 1}},
      .support_z = 0});
  // Up along two modules a quarter turn sweeps (2,0,1), which has a module.
  const model::Step step = test::move({1, 0, 0}, {1, 0, 1});
  EXPECT_EQ(
      find_barred_move(low, step, find_transition(low, step).value(), pivoting_cubes())->message,
      "no motion leads from (1,0,0) to (1,0,1)");
}

}  // namespace
}  // namespace holdfast::plan
