// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0

// Moves of single modules: those of cubes are all that find_transition() takes, found by trying
// every cell, and every carrier of a turn; in every lattice each of them can be taken back, and
// rules only leave some out. Which modules are loose is asked of a walk through the rest.

#include "holdfast/plan/module_moves.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "general_robot.hpp"
#include "holdfast/base/lattice.hpp"
#include "moves.hpp"
#include "seeds.hpp"

namespace holdfast::plan {
namespace {

using base::Cell;

model::RobotSpec robot_of(const base::Lattice& lattice, std::uint64_t seed) {
  model::RobotSpec spec = holdfast::test::general_robot(lattice, seed);
  spec.obstacles.clear();
  return holdfast::test::on_a_floor(spec, false);
}

std::set<Cell> ends_of(const std::vector<model::Move>& moves) {
  std::set<Cell> ends;
  std::ranges::for_each(moves, [&](const model::Move& move) { ends.insert(move.to); });
  return ends;
}

/// Cells that a module gets to by a move with no carrier named, or in a turn any of its neighbours.
std::set<Cell> tried_ends(const RobotState& robot, const Cell& from) {
  std::set<Cell> ends;
  for (const Cell& to : test::cells_near(robot.lattice(), from)) {
    model::Step step = test::move(from, to);
    bool can = find_transition(robot, step).has_value();
    const bool is_turn = !model::direction_between(robot.lattice(), from, to);
    for (const base::Direction direction : base::directions(robot.lattice())) {
      step.moves.front().carrier = base::neighbour(robot.lattice(), from, direction);
      can = can || (is_turn && find_transition(robot, step).has_value());
    }
    if (can) {
      ends.insert(to);
    }
  }
  return ends;
}

TEST(ModuleMoves, of_cubes_are_all_that_a_step_can_do) {
  std::size_t count = 0;
  for (std::uint64_t seed = 0; seed < holdfast::test::campaign(40U); ++seed) {
    const RobotState robot(robot_of(base::kCubic, seed));
    for (const std::int32_t module : loose_modules(robot)) {
      const Cell& from = robot.module(module).cell;
      const auto tried = tried_ends(robot, from);
      EXPECT_EQ(ends_of(moves_of(robot, module, {})), tried) << seed;
      count += tried.size();
    }
  }
  EXPECT_GE(count, holdfast::test::least(300U));
}

TEST(ModuleMoves, can_be_taken_back_in_every_lattice) {
  std::size_t count = 0;
  for (const base::Lattice& lattice : holdfast::test::kLattices) {
    for (std::uint64_t seed = 0; seed < holdfast::test::campaign(12U); ++seed) {
      const RobotState robot(robot_of(lattice, seed));
      for (const std::int32_t module : loose_modules(robot)) {
        for (const model::Move& move : moves_of(robot, module, {})) {
          RobotState moved = robot;
          moved.move({&move.from, 1}, {&move.to, 1});
          EXPECT_TRUE(ends_of(moves_of(moved, moved.find(move.to), {})).contains(move.from))
              << seed << model::text(move.from) << model::text(move.to);
          ++count;
        }
      }
    }
  }
  EXPECT_GE(count, holdfast::test::least(200U));
}

TEST(ModuleMoves, leave_out_what_a_rule_bars) {
  for (std::uint64_t seed = 0; seed < holdfast::test::campaign(12U); ++seed) {
    const model::RobotSpec spec = robot_of(holdfast::test::kLattices[seed % 4], seed);
    const RobotState robot(spec);
    const Cell& low = *std::ranges::min_element(spec.existing, {}, &Cell::z);
    const CellBox box{.low = {-100, -100, low.z}, .high = {low.x, 100, 100}};
    for (const std::int32_t module : loose_modules(robot)) {
      const std::set<Cell> boxed = ends_of(moves_of(robot, module, {.within = box}));
      for (const Cell& cell : ends_of(moves_of(robot, module, {}))) {
        // A turn also needs the cell that it comes through.
        const bool is_next =
            model::direction_between(spec.lattice, robot.module(module).cell, cell) &&
            box.contains(cell);
        EXPECT_TRUE(!is_next || boxed.contains(cell)) << seed;
      }
      EXPECT_TRUE(std::ranges::all_of(boxed, [&](const Cell& cell) { return box.contains(cell); }));
      for (const Cell& cell : ends_of(moves_of(robot, module, {.floor_z = low.z}))) {
        EXPECT_GE(cell.z, low.z) << seed;
      }
    }
  }
}

/// Cells to be avoided bar ways as obstacles do, which every lattice's body has to keep clear of.
TEST(ModuleMoves, avoid_cells_as_if_they_were_obstacles) {
  std::size_t barred_count = 0;
  for (std::uint64_t seed = 0; seed < holdfast::test::campaign(48U); ++seed) {
    model::RobotSpec spec = robot_of(holdfast::test::kLattices[seed % 4], seed);
    const RobotState robot(spec);
    base::Rng rng(seed);
    std::set<Cell> avoided;
    for (const Cell& module : spec.existing) {
      for (const base::Direction direction : base::directions(spec.lattice)) {
        const Cell cell = base::neighbour(spec.lattice, module, direction);
        if (robot.find(cell) == RobotState::kNone && rng.below(4) == 0) {
          avoided.insert(cell);
        }
      }
    }
    for (const auto& motions : {std::shared_ptr<const Motions>(), pivoting_cubes()}) {
      if (motions && motions->lattice != spec.lattice) {
        continue;
      }
      MoveRule rule{.motions = motions, .avoid = model::CellIndex(avoided.size())};
      for (const Cell& cell : avoided) {
        rule.avoid.insert(cell, 0);
      }
      model::RobotSpec walled = spec;
      walled.obstacles.push_back({.from = {}, .to = {}, .cells = {avoided.begin(), avoided.end()}});
      const RobotState behind(walled);
      for (const std::int32_t module : loose_modules(robot)) {
        const auto found = ends_of(moves_of(robot, module, rule));
        EXPECT_EQ(found, ends_of(moves_of(behind, module, {.motions = motions}))) << seed;
        barred_count +=
            ends_of(moves_of(robot, module, {.motions = motions})).size() - found.size();
      }
    }
  }
  EXPECT_GE(barred_count, holdfast::test::least(100U));
}

/// Whether all modules but one are connected.
bool holds_together_without(const RobotState& robot, std::size_t left_out) {
  std::set<Cell> rest;
  for (std::size_t i = 0; i < robot.modules().size(); ++i) {
    if (i != left_out) {
      rest.insert(robot.modules()[i].cell);
    }
  }
  std::vector<Cell> reached = {*rest.begin()};
  rest.erase(rest.begin());
  for (std::size_t i = 0; i < reached.size(); ++i) {
    const Cell cell = reached[i];
    for (const base::Direction direction : base::directions(robot.lattice())) {
      const Cell next = base::neighbour(robot.lattice(), cell, direction);
      if (robot.are_connected(cell, next) && rest.erase(next) > 0) {
        reached.push_back(next);
      }
    }
  }
  return rest.empty();
}

TEST(ModuleMoves, loose_modules_are_those_without_which_the_rest_is_one_piece) {
  for (std::uint64_t seed = 0; seed < holdfast::test::campaign(40U); ++seed) {
    const RobotState robot(
        holdfast::test::general_robot(holdfast::test::kLattices[seed % 4], seed));
    const std::vector<std::int32_t> loose = loose_modules(robot);
    for (std::size_t i = 0; i < robot.modules().size(); ++i) {
      const bool is_loose = std::ranges::count(loose, static_cast<std::int32_t>(i)) > 0;
      EXPECT_EQ(is_loose, !robot.modules()[i].is_fixed && holds_together_without(robot, i))
          << seed << ' ' << i;
    }
  }
}

}  // namespace
}  // namespace holdfast::plan
