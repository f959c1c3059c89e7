// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
//
// Contacts that begin as a robot bends, against distances by elementary geometry: an arm above a
// floor, above a wall, and above itself. Of a stiff arm under a small load sagging is linear
// theory's.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "holdfast/large/follow.hpp"

namespace holdfast::large {
namespace {

/// An arm of `count` modules beside a fixed one, so soft that its end sags under its weight.
model::RobotSpec arm(int count, double modulus) {
  model::RobotSpec spec;
  for (int i = 0; i <= count; ++i) {
    spec.existing.push_back({i, 0, 2});
  }
  spec.fixed = {spec.existing.front()};
  spec.support_z = {};
  spec.material.elastic_modulus_mpa = modulus;
  return spec;
}

Path path_of(const model::RobotSpec& spec, std::span<const model::Obstacle> obstacles = {}) {
  const auto robot = model::Robot::create(spec, 1);
  EXPECT_TRUE(robot) << (robot ? "" : robot.error().message);
  return follow(robot.value(), {.obstacles = obstacles, .thread_count = 1});
}

std::optional<Event> event_of(const Path& path, EventKind kind) {
  const auto found = std::ranges::find(path.events, kind, &Event::kind);
  return found != path.events.end() ? std::optional(*found) : std::nullopt;
}

/// Where the lowest corner of the last module is below its node at rest.
double lowest_corner(const State& state) {
  const auto& pose = state.poses.back();
  const double angle = mechanics::rotation_vector(pose.rotation)[1];
  return pose.displacement[2] - 20 * (std::cos(angle) + std::sin(std::abs(angle)));
}

TEST(touching, tells_when_the_end_of_an_arm_reaches_the_floor) {
  model::RobotSpec spec = arm(5, 0.15);
  spec.support_z = 0;  // Its upper side is 60 mm below the nodes: 1.5 pitches.
  const Path path = path_of(spec);
  const auto event = event_of(path, EventKind::kTouchesFloor);
  ASSERT_TRUE(event);
  EXPECT_EQ(event->modules, std::vector<std::size_t>{5});
  // Just there the lowest corner is at the floor.
  const auto robot = model::Robot::create(spec, 1);
  const Path there = follow(robot.value(), {.factor_max = event->factor, .thread_count = 1});
  EXPECT_NEAR(lowest_corner(there.last), -(2 * 40 + 20), 1e-5);
}

TEST(touching, tells_when_it_meets_an_obstacle_that_it_did_not_touch) {
  const model::RobotSpec spec = arm(5, 0.15);
  EXPECT_FALSE(event_of(path_of(spec), EventKind::kTouchesItself));
  const model::Obstacle wall{.from = {3, -1, 0}, .to = {6, 1, 0}};  // Its upper side: -60 mm.
  const Path path = path_of(spec, {&wall, 1});
  const auto event = event_of(path, EventKind::kTouchesItself);
  ASSERT_TRUE(event);
  EXPECT_EQ(event->modules, std::vector<std::size_t>{5});
  const auto robot = model::Robot::create(spec, 1);
  const Path there = follow(robot.value(), {.factor_max = event->factor, .thread_count = 1});
  EXPECT_NEAR(lowest_corner(there.last), -60, 1e-5);
}

TEST(touching, tells_when_an_arm_meets_its_own_foot) {
  // A stiff foot below, fixed all along, and an arm above it.
  model::RobotSpec spec = arm(4, 0.2);
  spec.existing.push_back({0, 0, 1});
  for (int i = 0; i <= 4; ++i) {
    spec.existing.push_back({i, 0, 0});
    spec.fixed.push_back({i, 0, 0});
  }
  const Path path = path_of(spec);
  const auto event = event_of(path, EventKind::kTouchesItself);
  ASSERT_TRUE(event);
  EXPECT_EQ(event->modules.size(), 2U);
  EXPECT_LT(event->factor, 2);
}

// Modules that are neighbours across an edge touch at rest: their bodies say nothing.
TEST(touching, does_not_tell_of_modules_that_touch_at_rest) {
  model::RobotSpec spec = arm(3, 0.5);
  spec.existing.push_back({3, 1, 2});
  spec.existing.push_back({3, 1, 3});
  EXPECT_FALSE(event_of(path_of(spec), EventKind::kTouchesItself));
}

}  // namespace
}  // namespace holdfast::large
