// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
// 2,000 robots that nobody has looked at: the answer always comes, and the two stability checks,
// which share no code, agree on flat ground wherever the margin is not exactly zero.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "holdfast/verdict/assessment.hpp"
#include "random_robot.hpp"
#include "seeds.hpp"

namespace holdfast {
namespace {

constexpr std::uint64_t kRandomCount = test::campaign(2000U, 8U);

TEST(RandomRobots, are_always_decided_and_both_stability_checks_agree) {
  int unilateral_count = 0;
  int unstable_count = 0;
  for (std::uint64_t seed = 0; seed < kRandomCount; ++seed) {
    SCOPED_TRACE(::testing::Message() << "random_robot(" << seed << ")");
    const auto robot = model::Robot::create(test::random_robot(seed));
    ASSERT_TRUE(robot) << robot.error().message;
    ASSERT_GE(robot.value().modules().size(), 3U);
    const verdict::Assessment assessment = verdict::assess(robot.value());
    EXPECT_NE(assessment.verdict, verdict::Verdict::kUndecided);
    ASSERT_TRUE(assessment.model.is_settled);
    if (*assessment.simplified.margin_mm != 0) {
      EXPECT_EQ(assessment.model.is_stable, assessment.is_stable);
    }
    unilateral_count += assessment.contact_model == verdict::ContactModel::kUnilateral ? 1 : 0;
    unstable_count += assessment.is_stable ? 0 : 1;
  }
  // The generator must reach the hard cases, or the test above says little.
  EXPECT_GE(unilateral_count, test::least(20, 8));
  EXPECT_GE(unstable_count, test::least(200, 8));
}

/// Gravity does not know north: a quarter turn about the vertical turns the answer.
TEST(RandomRobots, have_the_same_answer_when_turned) {
  for (std::uint64_t seed = 0; seed < kRandomCount; seed += 10) {
    SCOPED_TRACE(::testing::Message() << "random_robot(" << seed << ")");
    model::RobotSpec spec = test::random_robot(seed);
    const auto robot = model::Robot::create(spec);
    for (auto* cells : {&spec.existing, &spec.planned}) {
      std::ranges::for_each(*cells, [](base::Cell& cell) { cell = {-cell.y, cell.x, cell.z}; });
    }
    const auto turned = model::Robot::create(spec);
    ASSERT_TRUE(robot && turned);
    const verdict::Assessment a = verdict::assess(robot.value());
    const verdict::Assessment b = verdict::assess(turned.value());
    EXPECT_EQ(a.verdict, b.verdict);
    EXPECT_NEAR(*a.simplified.margin_mm, *b.simplified.margin_mm, 1e-9);
    if (a.is_stable) {
      // Solver and rounding: 1e-7 of the largest ratio.
      EXPECT_NEAR(*a.load_ratio_max, *b.load_ratio_max, 1e-7 * (1 + std::abs(*a.load_ratio_max)));
    }
  }
}

/// The solver of large robots is another method, so each checks the other.
TEST(RandomRobots, have_the_same_answer_by_multigrid) {
  int unilateral_count = 0;
  for (std::uint64_t seed = 0; seed < kRandomCount; seed += 2) {
    SCOPED_TRACE(::testing::Message() << "random_robot(" << seed << ")");
    const auto robot = model::Robot::create(test::random_robot(seed)).value();
    const verdict::Assessment direct = verdict::assess(robot);
    const verdict::Assessment multigrid =
        verdict::assess(robot, {.method = solver::Method::kMultigrid});
    EXPECT_EQ(direct.is_stable, multigrid.is_stable);
    if (!direct.is_stable || direct.equilibrium.open_but_held_count > 0) {
      continue;  // Nothing is sought, or the answer is a range.
    }
    EXPECT_EQ(direct.contact_model, multigrid.contact_model);
    ASSERT_TRUE(multigrid.load_ratio_max);
    if (direct.contact_model == multigrid.contact_model) {
      EXPECT_NEAR(*direct.load_ratio_max, *multigrid.load_ratio_max,
                  1e-4 * (1 + std::abs(*direct.load_ratio_max)));
    }
    unilateral_count += multigrid.contact_model == verdict::ContactModel::kUnilateral ? 1 : 0;
  }
  EXPECT_GE(unilateral_count, test::least(6, 8));
}

}  // namespace
}  // namespace holdfast
