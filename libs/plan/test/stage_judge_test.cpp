// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0

// The stages of a step are judged the same whether what stays where it is was solved for other
// steps as well or each robot is checked by itself, and whatever was judged before.

#include "judges/stage_judge.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "general_robot.hpp"
#include "holdfast/plan/module_moves.hpp"
#include "seeds.hpp"

namespace holdfast::plan {
namespace {

using verdict::Verdict;

const solver::EquilibriumOptions kOneThread{.thread_count = 1};

/// The steps of one module of a robot, each of which can be done.
struct Walker {
  RobotState robot;
  std::vector<model::Step> steps;
};

Walker walker_of(const base::Lattice& lattice, std::uint64_t seed) {
  Walker walker{
      RobotState(holdfast::test::held_robot(lattice, seed, holdfast::test::Fixed::kFirst)), {}};
  for (const std::int32_t module : loose_modules(walker.robot)) {
    for (const model::Move& move : moves_of(walker.robot, module, {})) {
      model::Step step;
      step.moves = {move};
      if (judge_step(walker.robot, step, kOneThread)) {
        walker.steps.push_back(step);
      }
    }
    if (walker.steps.size() > 2) {
      break;
    }
  }
  return walker;
}

/// Rounding, and that of a check of few modules.
void expect_same(const StepJudgement& a, const StepJudgement& b, std::uint64_t seed) {
  for (std::size_t i = 0; i < kStageCount; ++i) {
    EXPECT_EQ(a.stages[i].verdict, b.stages[i].verdict) << seed << ' ' << i;
    EXPECT_EQ(a.stages[i].margin_mm, b.stages[i].margin_mm) << seed << ' ' << i;
    const double ratio = b.stages[i].load_ratio_max.value_or(-1);
    EXPECT_NEAR(a.stages[i].load_ratio_max.value_or(-1), ratio, 1e-7 * std::max(1.0, ratio))
        << seed << ' ' << i;
  }
}

TEST(StageJudge, says_the_same_from_a_core_in_common_as_by_checks) {
  std::size_t count = 0;
  for (std::uint64_t seed = 0; seed < holdfast::test::campaign(60U); ++seed) {
    const Walker walker = walker_of(holdfast::test::kLattices[seed % 4], seed);
    StageJudge shared(kOneThread);
    for (const model::Step& step : walker.steps) {
      const Transition transition = find_transition(walker.robot, step).value();
      const auto by_core = shared.judge(walker.robot, step, transition, nullptr, true);
      const auto by_checks =
          StageJudge(kOneThread).judge(walker.robot, step, transition, nullptr, false);
      ASSERT_TRUE(by_core && by_checks) << seed;
      expect_same(by_core.value(), by_checks.value(), seed);
      // The first answer of a new judge is that of one that has judged others.
      EXPECT_EQ(by_core.value(),
                StageJudge(kOneThread).judge(walker.robot, step, transition, nullptr, true).value())
          << seed;
      ++count;
    }
  }
  EXPECT_GE(count, holdfast::test::least(60U));
}

TEST(StageJudge, takes_a_stage_over_that_finds_the_robot_as_it_was) {
  const model::RobotSpec spec{.existing = {{0, 0, 0}, {0, 0, 1}, {1, 0, 0}}};
  const RobotState robot(spec);
  model::Step step;
  step.attach = {{1, 0, 1}};
  const Transition transition = find_transition(robot, step).value();
  StageJudgement known;
  known.verdict = Verdict::kUndecided;  // Which no stage is by itself.
  const auto judged = StageJudge(kOneThread).judge(robot, step, transition, &known, false).value();
  EXPECT_EQ(judged.stages[0].verdict, Verdict::kUndecided);
  EXPECT_EQ(judged.stages[1].verdict, Verdict::kUndecided);
  EXPECT_EQ(judged.stages[2].verdict, Verdict::kSafe);
}

}  // namespace
}  // namespace holdfast::plan
