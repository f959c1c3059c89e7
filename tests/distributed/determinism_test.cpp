// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
// The same inputs give the same packets at the same times, bit for bit, with every compiler and
// optimisation level: the presets dev (g++ -O2) and sanitize (clang -O1) run this against one hash.
// The hash was read off a run; it changes with the wire format, the protocol or the arithmetic, and
// then says nothing about which of them is right.
#include <gtest/gtest.h>

#include "campaign.hpp"
#include "random_robot.hpp"

namespace holdfast {
namespace {

TEST(Determinism, the_trace_is_the_same_with_every_compiler_and_level) {
  const auto robot = model::Robot::create(test::random_robot(3));
  ASSERT_TRUE(robot);
  sim::SimulationOptions options{.link = sim::blinky_blocks_v1(), .seed = 42};
  options.link.loss = 0.05;
  options.link.corruption = 0.01;
  options.link.jitter = 5'000;
  options.link.clock_drift = 0.001;
  const auto comparison = test::compare(robot.value(), options);
  EXPECT_FALSE(comparison.is_wrong()) << comparison.text();
  EXPECT_EQ(comparison.result.trace_hash, 7476639310636017002U);
}

}  // namespace
}  // namespace holdfast
