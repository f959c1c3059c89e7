// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
//
// Pieces that fall are what the cascade lets fall, still connected, and not before their round;
// they come down, and not through the floor. How bodies fall is the room fall's.
#include "holdfast/falling_pieces.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <set>

#include "general_robot.hpp"
#include "seeds.hpp"

namespace holdfast {
namespace {

using base::at;
using base::Cell;

struct Broken {
  model::RobotSpec spec;
  model::Robot robot;
  plan::Cascade cascade;
};

/// A random robot on a floor, so weak that some of it breaks.
std::optional<Broken> broken_robot(const base::Lattice& lattice, std::uint64_t seed) {
  model::RobotSpec spec = test::on_a_floor(test::general_robot(lattice, seed), seed % 2 == 0);
  const auto whole = model::Robot::create(spec, 1);
  if (!whole) {
    return std::nullopt;
  }
  const auto ratio = verdict::assess(whole.value(), {.thread_count = 1}).load_ratio_max;
  if (!ratio || *ratio <= 0) {
    return std::nullopt;
  }
  spec = test::with_strengths_times(spec, *ratio * 0.6);
  auto robot = model::Robot::create(spec, 1);
  auto cascade = plan::find_cascade(spec, {.equilibrium = {.thread_count = 1}, .progress = {}});
  if (!robot || !cascade) {
    return std::nullopt;
  }
  return Broken{spec, std::move(robot).value(), std::move(cascade).value()};
}

/// The round in which each module falls.
std::map<Cell, std::size_t> rounds_of(const plan::Cascade& cascade) {
  std::map<Cell, std::size_t> rounds;
  for (std::size_t i = 0; i < cascade.rounds.size(); ++i) {
    for (const Cell& cell : cascade.rounds[i].fallen) {
      rounds[cell] = i;
    }
  }
  return rounds;
}

/// Modules of a body reach each other by connections that have not broken by then.
void expect_connected(const Broken& broken, const std::vector<std::int32_t>& modules,
                      std::size_t round) {
  std::set<std::set<Cell>> gone;
  for (std::size_t i = 0; i <= round; ++i) {
    for (const auto& [between, ratio] : broken.cascade.rounds[i].broken) {
      gone.insert({between[0], between[1]});
    }
  }
  std::set<std::int32_t> left(modules.begin() + 1, modules.end());
  std::vector<std::int32_t> found = {modules.front()};
  for (std::size_t i = 0; i < found.size(); ++i) {
    const Cell& cell = broken.robot.modules()[at(found[i])].cell;
    for (const std::int32_t next : broken.robot.connected()[at(found[i])]) {
      if (left.contains(next) && !gone.contains({cell, broken.robot.modules()[at(next)].cell})) {
        left.erase(next);
        found.push_back(next);
      }
    }
  }
  EXPECT_TRUE(left.empty());
}

void expect_right(const Broken& broken, const FallingPieces& pieces) {
  const auto rounds = rounds_of(broken.cascade);
  std::map<std::int32_t, std::vector<std::int32_t>> bodies;
  for (std::size_t i = 0; i < pieces.body_of.size(); ++i) {
    const Cell& cell = broken.robot.modules()[i].cell;
    EXPECT_EQ(pieces.body_of[i] != FallingPieces::kNone, rounds.contains(cell));
    if (pieces.body_of[i] != FallingPieces::kNone) {
      bodies[pieces.body_of[i]].push_back(static_cast<std::int32_t>(i));
    }
  }
  EXPECT_EQ(bodies.size(), pieces.fall.centres.size());
  for (const auto& [body, modules] : bodies) {
    const std::size_t round = rounds.at(broken.robot.modules()[at(modules.front())].cell);
    for (const std::int32_t module : modules) {
      EXPECT_EQ(rounds.at(broken.robot.modules()[at(module)].cell), round);
    }
    expect_connected(broken, modules, round);
    for (std::size_t frame = 0; frame < pieces.fall.frames.size(); ++frame) {
      if (pieces.fall.frame_s * static_cast<double>(frame) < pieces.round_s[round]) {
        EXPECT_EQ(pieces.fall.frames[frame][at(body)].moved, fall::Point{});
      }
    }
  }
}

TEST(FallingPieces, are_what_the_cascade_lets_fall) {
  std::size_t fallen = 0;
  for (const base::Lattice& lattice : test::kLattices) {
    for (std::uint64_t seed = 0; seed < test::campaign(15U); ++seed) {
      if (const auto broken = broken_robot(lattice, seed)) {
        const FallingPieces pieces = simulate_fall(broken->spec, broken->robot, broken->cascade);
        expect_right(*broken, pieces);
        fallen += broken->cascade.fallen_count();
      }
    }
  }
  EXPECT_GE(fallen, test::least(100));
}

/// An arm of five at the top of a tower of four, whose first connection breaks.
Broken broken_arm() {
  model::RobotSpec spec;
  for (int z = 0; z < 4; ++z) {
    spec.existing.push_back({0, 0, z});
    spec.existing.push_back({-1, 0, z});
    spec.existing.push_back({-2, 0, z});
    spec.existing.push_back({-3, 0, z});
  }
  for (int x = 1; x < 6; ++x) {
    spec.existing.push_back({x, 0, 3});
  }
  auto robot = model::Robot::create(spec, 1);
  auto cascade = plan::find_cascade(spec, {.equilibrium = {.thread_count = 1}, .progress = {}});
  return {spec, std::move(robot).value(), std::move(cascade).value()};
}

TEST(FallingPieces, of_an_arm_come_down_to_the_floor) {
  const Broken broken = broken_arm();
  ASSERT_EQ(broken.cascade.outcome, plan::CascadeOutcome::kStands);
  const FallingPieces pieces = simulate_fall(broken.spec, broken.robot, broken.cascade);
  expect_right(broken, pieces);
  ASSERT_EQ(pieces.fall.centres.size(), 1U);
  // Three modules' heights, wherever it leans on the tower.
  const double moved = pieces.fall.frames.back().front().moved[2];
  EXPECT_LT(moved, -2.5 * broken.robot.material().pitch_mm);
  EXPECT_GT(moved, -3 * broken.robot.material().pitch_mm - 0.5);
}

TEST(FallingPieces, are_none_of_a_robot_that_holds) {
  model::RobotSpec spec;
  spec.existing = {{0, 0, 0}, {0, 0, 1}};
  const auto robot = model::Robot::create(spec, 1);
  const auto cascade =
      plan::find_cascade(spec, {.equilibrium = {.thread_count = 1}, .progress = {}});
  const FallingPieces pieces = simulate_fall(spec, robot.value(), cascade.value());
  EXPECT_TRUE(pieces.fall.centres.empty());
  EXPECT_EQ(pieces.body_of, (std::vector<std::int32_t>(2, FallingPieces::kNone)));
}

}  // namespace
}  // namespace holdfast
