// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
// More than five planned modules at once, up to thirty, against the exact solver.
#include "many_planned.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "campaign.hpp"
#include "expectations.hpp"
#include "holdfast/distributed.hpp"
#include "holdfast/holdfast.hpp"
#include "seeds.hpp"

namespace holdfast {
namespace {

using agent::Method;

/// Robots that the exact solver does not decide prove nothing.
void expect_planned_right(const test::Comparison& comparison) {
  if (comparison.exact == verdict::Verdict::kUndecided) {
    EXPECT_TRUE(comparison.result.all_agree) << comparison.text();
    return;
  }
  test::expect_right(comparison);
}

TEST(ManyPlanned, random_robots_are_decided_in_few_sweeps_with_fronts) {
  std::vector<double> sweeps;
  for (std::uint64_t seed = 0; seed < test::campaign(200U, 10U); ++seed) {
    SCOPED_TRACE(::testing::Message() << "many_planned_robot(" << seed << ")");
    const auto comparison = test::compare(test::robot_of(test::many_planned_robot(seed)),
                                          {.seed = seed, .method = Method::kFronts});
    expect_planned_right(comparison);
    if (comparison.sweeps() > 0) {
      sweeps.push_back(comparison.sweeps());
    }
  }
  ASSERT_GE(sweeps.size(), test::least(100U, 10U));
  std::ranges::sort(sweeps);
  EXPECT_LE(sweeps[sweeps.size() * 98 / 100], 30);
  EXPECT_LE(sweeps.back(), 60);
}

/// Nothing holds the robot at first in 2478 and 2690; 4478 and 5382 have the longest fronts.
TEST(ManyPlanned, robots_that_took_many_sweeps_take_few) {
  for (const std::uint64_t seed : test::campaign({2478U, 2690U, 4478U, 5382U}, 2)) {
    SCOPED_TRACE(::testing::Message() << "many_planned_robot(" << seed << ")");
    const auto comparison = test::compare(test::robot_of(test::many_planned_robot(seed)),
                                          {.seed = seed, .method = Method::kFronts});
    expect_planned_right(comparison);
    EXPECT_LE(comparison.sweeps(), 60);
    EXPECT_EQ(comparison.result.effort.method, Method::kFronts);
  }
}

TEST(ManyPlanned, random_robots_are_decided_without_memory_for_fronts) {
  for (std::uint64_t seed = 0; seed < test::campaign(16U); ++seed) {
    SCOPED_TRACE(::testing::Message() << "many_planned_robot(" << seed << ")");
    expect_planned_right(
        test::compare(test::robot_of(test::many_planned_robot(seed)), {.seed = seed}));
  }
}

/// The robot has a state only under the exact law, in which an open foot must not hold sideways: if
/// it did, the largest load ratio would be 0.7369 instead of 0.7145.
TEST(ManyPlanned, a_fixed_robot_lets_go_of_open_feet_under_the_exact_law) {
  const auto comparison =
      test::compare(test::robot_of(test::many_planned_robot(1245)), {.method = Method::kFronts});
  expect_planned_right(comparison);
  EXPECT_TRUE(comparison.result.effort.is_unilateral);
}

TEST(ManyPlanned, bad_links_change_no_verdict) {
  for (std::uint64_t seed = 0; seed < test::campaign(24U); ++seed) {
    SCOPED_TRACE(::testing::Message() << "many_planned_robot(" << seed << ")");
    expect_planned_right(
        test::compare(test::robot_of(test::many_planned_robot(seed)),
                      {.link = test::noisy_rounds(), .seed = seed, .method = Method::kFronts}));
  }
}

/// Every module that is alive in the end has a verdict, and none is a wrong `safe`.
TEST(ManyPlanned, a_fault_makes_no_wrong_safe) {
  base::Rng rng(7);
  for (std::uint64_t seed = 0; seed < test::campaign(24U); ++seed) {
    SCOPED_TRACE(::testing::Message() << "many_planned_robot(" << seed << ")");
    const model::Robot robot = test::robot_of(test::many_planned_robot(seed));
    const auto whole = test::compare(robot, {.seed = seed, .method = Method::kFronts});
    const sim::Fault fault = test::random_fault(robot, rng, whole.result.verdict_time);
    sim::Simulation simulation(robot, {.seed = seed, .method = Method::kFronts, .faults = {fault}});
    simulation.run();
    for (std::int32_t i = 0; i < simulation.agent_count(); ++i) {
      const agent::Verdict verdict = simulation.agent(i).answer().verdict;
      if (simulation.is_alive(i)) {
        EXPECT_NE(verdict, agent::Verdict::kNone);
        EXPECT_TRUE(verdict != agent::Verdict::kSafe || whole.exact == verdict::Verdict::kSafe);
      }
    }
  }
}

void expect_all(const sim::Simulation& simulation, agent::Verdict verdict, agent::Reason reason) {
  for (std::int32_t i = 0; i < simulation.agent_count(); ++i) {
    EXPECT_EQ(simulation.agent(i).answer().verdict, verdict);
    EXPECT_EQ(simulation.agent(i).answer().reason, reason);
  }
}

/// The robot is a fixed tower of 3 with an arm that is planned piece by piece; one module after the
/// other is told of the pieces and their withdrawal. An arm of n breaks where n^2 times the ratio
/// of one exceeds 1 (statics).
TEST(ManyPlanned, plans_come_and_go_beyond_five) {
  model::RobotSpec spec;
  spec.existing = {{0, 0, 0}, {0, 0, 1}, {0, 0, 2}};
  spec.fixed = {{0, 0, 0}};
  const model::Robot robot = test::robot_of(spec);
  sim::Simulation simulation(robot, {.plans_many = true});
  simulation.run();
  const auto tell = [&](base::Cell cell, bool is_withdrawal) {
    simulation.happen(
        sim::Announcement{.module = cell.x % 3, .cell = cell, .is_withdrawal = is_withdrawal});
    simulation.run();
    EXPECT_TRUE(simulation.result().is_quiet);
  };
  const auto exact = [&](std::int32_t length) {
    model::RobotSpec planned = spec;
    for (std::int32_t x = 1; x <= length; ++x) {
      planned.planned.push_back({x, 0, 2});
    }
    return verdict::assess(test::robot_of(planned));
  };
  std::int32_t length = 0;
  for (const std::int32_t wanted : {9, 4, 12, 30, 7, 3}) {
    while (length != wanted) {
      tell({length < wanted ? length + 1 : length, 0, 2}, length > wanted);
      length += length < wanted ? 1 : -1;
    }
    const auto answer = simulation.result().answer;
    const auto expected = exact(length);
    EXPECT_EQ(to_verdict(answer.verdict), expected.verdict) << length;
    EXPECT_NEAR(static_cast<double>(answer.load_ratio_max), *expected.load_ratio_max,
                0.01 + 0.01 * *expected.load_ratio_max)
        << length;
  }
  for (std::int32_t x = 4; x <= 31; ++x) {
    tell({x, 0, 2}, false);
  }
  expect_all(simulation, agent::Verdict::kUndecided, agent::Reason::kPlannedTooMany);
  tell({31, 0, 2}, true);
  EXPECT_EQ(to_verdict(simulation.result().answer.verdict), exact(30).verdict);
}

TEST(ManyPlanned, more_than_thirty_are_too_many) {
  model::RobotSpec spec;
  spec.existing = {{0, 0, 0}};
  spec.fixed = spec.existing;
  for (std::int32_t z = 1; z <= 31; ++z) {
    spec.planned.push_back({0, 0, z});
  }
  const model::Robot robot = test::robot_of(spec);
  sim::Simulation simulation(robot, {});
  simulation.run();
  expect_all(simulation, agent::Verdict::kUndecided, agent::Reason::kPlannedTooMany);
}

/// A module without lent memory plans five, and says so.
TEST(ManyPlanned, five_are_planned_where_no_memory_is_lent) {
  model::RobotSpec spec;
  spec.existing = {{0, 0, 0}};
  spec.fixed = spec.existing;
  const model::Robot robot = test::robot_of(spec);
  sim::Simulation simulation(robot, {});
  simulation.run();
  for (std::int32_t z = 1; z <= 6; ++z) {
    EXPECT_EQ(simulation.result().answer.verdict, agent::Verdict::kSafe);
    simulation.happen(sim::Announcement{.cell = {0, 0, z}});
    simulation.run();
  }
  expect_all(simulation, agent::Verdict::kUndecided, agent::Reason::kPlannedTooMany);
}

}  // namespace
}  // namespace holdfast
