// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
// The same inputs give the same packets at the same times, bit for bit, with every compiler and
// optimisation level: g++ -O3, the program's own build, and clang -O1 run this in their presets,
// g++ -O0 and -O2 and clang -O0 and -O3 by ./dev test bits, WebAssembly by ./dev test web. Emulated
// firmware is compared with the host's agents step by step (tests/firmware).
// The hashes were read off a run; they change with the wire format, the protocol or the arithmetic,
// and then say nothing about which of them is right. That verdicts are right is tested elsewhere.
#include <gtest/gtest.h>

#include "holdfast/sim/simulation.hpp"
#include "random_robot.hpp"

namespace holdfast {
namespace {

/// Bad lines: many packets, in an order that depends on every time and every random number.
sim::LinkModel noisy_blocks() {
  sim::LinkModel link = sim::blinky_blocks_v1();
  link.loss = 0.05;
  link.corruption = 0.01;
  link.jitter = 5'000;
  link.clock_drift = 0.001;
  return link;
}

/// A hollow square tower that rests on the ground, as high as clusters need (depth 64).
model::RobotSpec tower(std::int32_t height) {
  model::RobotSpec spec;
  for (std::int32_t z = 0; z < height; ++z) {
    for (std::int32_t y = 0; y < 3; ++y) {
      for (std::int32_t x = 0; x < 3; ++x) {
        if (x != 1 || y != 1) {
          spec.existing.push_back({x, y, z});
        }
      }
    }
  }
  return spec;
}

sim::SimulationResult simulated(const model::RobotSpec& spec,
                                const sim::SimulationOptions& options) {
  const auto robot = model::Robot::create(spec);
  EXPECT_TRUE(robot);
  sim::Simulation simulation(robot.value(), options);
  simulation.run();
  return simulation.result();
}

struct Case {
  const char* name;
  std::uint64_t seed;  ///< Of the robot.
  agent::Method method;
  std::uint64_t hash;
};

class Determinism : public ::testing::TestWithParam<Case> {};

/// Robots 6 and 8 have planned modules, 8 such as touch several others.
constexpr Case kCases[] = {
    {"elimination", 6, agent::Method::kElimination, 17287114288205420056U},
    {"polynomial", 12, agent::Method::kPolynomial, 11151561467803241176U},
    {"planned_between_others", 8, agent::Method::kPolynomial, 14485290013320252477U},
};

TEST_P(Determinism, every_method_has_one_trace) {
  const Case& expected = GetParam();
  const auto result = simulated(test::random_robot(expected.seed),
                                {.link = noisy_blocks(), .seed = 42, .method = expected.method});
  EXPECT_TRUE(result.all_agree);
  EXPECT_EQ(result.effort.method, expected.method);
  EXPECT_EQ(result.trace_hash, expected.hash);
}

std::string name_of(const ::testing::TestParamInfo<Case>& test_case) {
  return test_case.param.name;
}

INSTANTIATE_TEST_SUITE_P(Methods, Determinism, ::testing::ValuesIn(kCases), name_of);

TEST(Clusters, of_a_high_tower_have_one_trace) {
  const auto result = simulated(tower(130), {.method = agent::Method::kPolynomial});
  EXPECT_EQ(result.effort.method, agent::Method::kPolynomial);
  EXPECT_EQ(result.trace_hash, 18061100550205962583U);
}

}  // namespace
}  // namespace holdfast
