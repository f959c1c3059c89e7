// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
//
// A post stands with its centre of mass above the middle of its foot; a row that hangs from it
// moves the centre beyond the foot's edge. A bonded floor holds both.
#include "holdfast/plan/judgement.hpp"

#include <gtest/gtest.h>

namespace holdfast::plan {
namespace {

using verdict::Verdict;

model::Robot robot(const std::vector<base::Cell>& cells) {
  return model::Robot::create({.existing = cells}).value();
}

TEST(Judgement, of_a_post_has_half_a_facet_to_spare) {
  const Judgement judgement = judge(robot({{0, 0, 0}, {0, 0, 1}}));
  EXPECT_TRUE(judgement.is_safe());
  EXPECT_EQ(judgement.margin_mm, 20);
  ASSERT_TRUE(judgement.load_ratio_max);
  EXPECT_LT(*judgement.load_ratio_max, 1);
}

TEST(Judgement, of_a_robot_that_topples_needs_no_loads) {
  // Three of four modules are in the row, 40, 80 and 120 mm beside the foot's middle.
  const model::Robot toppling = robot({{0, 0, 0}, {0, 0, 1}, {1, 0, 1}, {2, 0, 1}, {3, 0, 1}});
  const Judgement judgement = judge(toppling);
  EXPECT_EQ(judgement.verdict, Verdict::kUnstable);
  EXPECT_NEAR(judgement.margin_mm.value(), 20 - (40 + 80 + 120) / 5.0, 1e-12);
  EXPECT_FALSE(judgement.load_ratio_max);
  EXPECT_EQ(first_look(toppling).verdict, Verdict::kUnstable);
}

TEST(Judgement, of_a_bonded_robot_asks_what_its_connections_carry) {
  const model::Robot row = robot({{0, 0, 0}, {0, 0, 1}, {1, 0, 1}, {2, 0, 1}, {3, 0, 1}});
  const Judgement judgement = judge(row, {.is_bonded = true});
  EXPECT_NE(judgement.verdict, Verdict::kUnstable);
  EXPECT_TRUE(judgement.load_ratio_max);
}

}  // namespace
}  // namespace holdfast::plan
