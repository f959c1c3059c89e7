// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
// More than five planned modules at once, up to thirty, against the exact solver.
#include "many_planned.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "campaign.hpp"
#include "holdfast/holdfast.hpp"

namespace holdfast {
namespace {

using agent::Method;

model::Robot made(const model::RobotSpec& spec) {
  auto robot = model::Robot::create(spec);
  HOLDFAST_CHECK(robot.has_value());
  return std::move(robot).value();
}

/// Robots that the exact solver does not decide prove nothing.
void expect_right(const test::Comparison& comparison) {
  EXPECT_TRUE(comparison.result.all_agree) << comparison.text();
  if (comparison.exact == verdict::Verdict::kUndecided) {
    return;
  }
  EXPECT_FALSE(comparison.is_wrong()) << comparison.text();
  EXPECT_FALSE(comparison.is_undecided()) << comparison.text();
  EXPECT_LT(comparison.ratio_error(), 1) << comparison.text();
}

TEST(ManyPlanned, random_robots_are_decided_in_few_sweeps_with_fronts) {
  std::vector<double> sweeps;
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    SCOPED_TRACE(::testing::Message() << "many_planned_robot(" << seed << ")");
    const auto comparison = test::compare(made(test::many_planned_robot(seed)),
                                          {.seed = seed, .method = Method::kFronts});
    expect_right(comparison);
    if (comparison.sweeps() > 0) {
      sweeps.push_back(comparison.sweeps());
    }
  }
  ASSERT_GT(sweeps.size(), 100U);
  std::ranges::sort(sweeps);
  EXPECT_LE(sweeps[sweeps.size() * 99 / 100], 30);
  EXPECT_LE(sweeps.back(), 60);
}

TEST(ManyPlanned, random_robots_are_decided_without_memory_for_fronts) {
  for (std::uint64_t seed = 0; seed < 60; ++seed) {
    SCOPED_TRACE(::testing::Message() << "many_planned_robot(" << seed << ")");
    expect_right(test::compare(made(test::many_planned_robot(seed)), {.seed = seed}));
  }
}

TEST(ManyPlanned, bad_links_change_no_verdict) {
  for (std::uint64_t seed = 0; seed < 24; ++seed) {
    SCOPED_TRACE(::testing::Message() << "many_planned_robot(" << seed << ")");
    expect_right(
        test::compare(made(test::many_planned_robot(seed)),
                      {.link = test::noisy_rounds(), .seed = seed, .method = Method::kFronts}));
  }
}

}  // namespace
}  // namespace holdfast
