// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
// Plans begin and end. `./dev bench distributed plans FROM TO` runs the campaign over more robots.
#include <gtest/gtest.h>

#include "holdfast/distributed.hpp"
#include "plan_campaign.hpp"
#include "seeds.hpp"

namespace holdfast {
namespace {

using test::PlanCase;

/// Every module's answer is the exact one for the robot as it is in the end, and no plan that has
/// ended is still held. Only a plan and its withdrawal in one round, at two modules, may be
/// undecided: which came first is then not known.
class PlanCampaign : public ::testing::TestWithParam<std::size_t> {};

TEST_P(PlanCampaign, every_verdict_is_that_of_the_robot_and_its_plan_in_the_end) {
  constexpr std::uint64_t kRobots = test::campaign(5U, 2U);
  const auto what = static_cast<PlanCase>(GetParam());
  SCOPED_TRACE(test::name(what));
  test::PlanTally tally;
  for (std::uint64_t seed = 0; seed < kRobots; ++seed) {
    test::run_plan_case(what, seed, tally);
  }
  EXPECT_GE(tally.runs, test::least(3, 2));
  EXPECT_GE(tally.right, test::least(25, 2));
  EXPECT_EQ(tally.wrong_safe, 0);
  EXPECT_EQ(tally.wrong_otherwise, 0);
  EXPECT_EQ(tally.none, 0);
  EXPECT_EQ(tally.left_over, 0);
  if (what == PlanCase::kWithdrawnElsewhere) {
    EXPECT_EQ(tally.undecided, tally.disputed);
  } else {
    EXPECT_EQ(tally.undecided, 0);
  }
}

INSTANTIATE_TEST_SUITE_P(Cases, PlanCampaign,
                         ::testing::Range(std::size_t{0}, test::kPlanCaseCount));

/// Two feet and a post from which an arm grows in six steps, safe at first, too long in the end.
/// Told now here, now there; every step is planned, judged, carried out and judged again.
TEST(PlanSequence, of_six_steps_is_judged_right_before_and_after_each) {
  constexpr sim::Time kStep = 60'000'000;
  constexpr std::int32_t kSteps = 6;
  model::RobotSpec spec{
      .existing = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {1, 0, 1}, {1, 0, 2}, {2, 0, 2}},
      .fixed = {{0, 0, 0}}};
  sim::SimulationOptions options{.link = sim::blinky_blocks_v1(), .tells_planned = false};
  std::vector<verdict::Verdict> seen;
  for (std::int32_t step = 0; step < 2 * kSteps; ++step) {
    SCOPED_TRACE(step);
    const base::Cell cell = {3 + step / 2, 0, 2};
    const auto begin = static_cast<sim::Time>(step) * kStep;
    model::RobotSpec exact_spec = spec;
    if (step % 2 == 0) {
      options.announcements.push_back({.at = begin, .module = step % 5, .cell = cell});
      exact_spec.planned = {cell};
    } else {
      options.faults.push_back({.kind = sim::Fault::Kind::kAttach,
                                .at = begin,
                                .module = static_cast<std::int32_t>(spec.existing.size())});
      spec.existing.push_back(cell);
      exact_spec = spec;
    }
    const auto exact = model::Robot::create(exact_spec);
    const auto robot = model::Robot::create(spec);
    ASSERT_TRUE(exact && robot);
    const verdict::Assessment assessment = verdict::assess(exact.value());
    options.time_max = begin + kStep - 1;
    sim::Simulation simulation(robot.value(), options);
    simulation.run();
    const sim::SimulationResult result = simulation.result();
    EXPECT_TRUE(result.all_agree);
    EXPECT_EQ(to_verdict(result.answer.verdict), assessment.verdict);
    EXPECT_NEAR(static_cast<double>(result.answer.load_ratio_max), *assessment.load_ratio_max,
                0.01 * (1 + *assessment.load_ratio_max));
    seen.push_back(assessment.verdict);
    int held = 0;
    for (std::int32_t i = 0; i < simulation.agent_count(); ++i) {
      held += simulation.agent(i).announcements().count();
    }
    EXPECT_EQ(held, step % 2 == 0 ? 1 : 0);
  }
  EXPECT_EQ(seen.front(), verdict::Verdict::kSafe);
  EXPECT_EQ(seen.back(), verdict::Verdict::kOverload);
}

/// The holder goes, and the plan with it: it must be told again. Until the module is taken off the
/// robot knows that somebody is missing.
TEST(PlanSequence, a_module_that_is_taken_off_takes_its_plans_along) {
  const auto robot = model::Robot::create({.existing = {{0, 0, 0}, {1, 0, 0}, {0, 0, 1}}});
  ASSERT_TRUE(robot);
  sim::SimulationOptions options{
      .faults = {{.kind = sim::Fault::Kind::kKill, .at = 5'000, .module = 1},
                 {.kind = sim::Fault::Kind::kDetach, .at = 50'000, .module = 1},
                 {.kind = sim::Fault::Kind::kAttach, .at = 60'000, .module = 1}},
      .announcements = {{.at = 1'000, .module = 1, .cell = {1, 0, 1}},
                        {.at = 5'001, .module = 2, .cell = {0, 0, 2}}}};
  for (const auto& [until, verdict, modules] :
       {std::tuple{sim::Time{4'999}, agent::Verdict::kSafe, 4U},
        std::tuple{sim::Time{49'999}, agent::Verdict::kUndecided, 0U},
        std::tuple{sim::Time{100'000}, agent::Verdict::kSafe, 4U}}) {
    options.time_max = until;
    sim::Simulation simulation(robot.value(), options);
    simulation.run();
    EXPECT_EQ(simulation.result().answer.verdict, verdict);
    if (modules > 0) {
      EXPECT_EQ(simulation.result().effort.module_count, modules);
    }
  }
}

}  // namespace
}  // namespace holdfast
