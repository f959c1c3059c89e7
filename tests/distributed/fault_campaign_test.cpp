// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
// A module dies or a link fails at any moment: the robot still carries its weight, so a wrong
// `safe` would be a lie that breaks it. `./dev bench` runs 1,000 of these.
#include <gtest/gtest.h>

#include "campaign.hpp"
#include "holdfast/base/rng.hpp"
#include "random_robot.hpp"
#include "seeds.hpp"

namespace holdfast {
namespace {

TEST(FaultCampaign, a_silent_module_or_link_never_leads_to_a_wrong_safe) {
  base::Rng rng(20211);
  int undecided_count = 0;
  for (std::uint64_t seed = 0; seed < test::campaign(40U, 8U); ++seed) {
    SCOPED_TRACE(::testing::Message() << "random_robot(" << seed << ")");
    const auto robot = model::Robot::create(test::random_robot(seed));
    ASSERT_TRUE(robot);
    const auto whole = test::compare(robot.value(), {.seed = seed});
    const sim::Fault fault = test::random_fault(robot.value(), rng, whole.result.verdict_time);
    SCOPED_TRACE(::testing::Message()
                 << sim::name(fault.kind) << " module " << fault.module << " at " << fault.at);
    sim::SimulationOptions options{.seed = seed, .faults = {fault}};
    sim::Simulation simulation(robot.value(), options);
    simulation.run();
    ASSERT_TRUE(simulation.result().is_quiet);
    for (std::int32_t i = 0; i < simulation.agent_count(); ++i) {
      if (!simulation.is_alive(i)) {
        continue;
      }
      const agent::Verdict verdict = simulation.agent(i).answer().verdict;
      if (verdict == agent::Verdict::kSafe) {
        EXPECT_EQ(whole.exact, verdict::Verdict::kSafe) << "module " << i;
      }
      undecided_count += verdict == agent::Verdict::kUndecided ? 1 : 0;
    }
  }
  // Most faults come while the verdict is still open.
  EXPECT_GE(undecided_count, test::least(300, 8));
}

/// A module that is taken off is no longer part of the robot: the answer is that of what is left.
TEST(FaultCampaign, a_module_taken_off_gives_the_answer_of_the_rest) {
  model::RobotSpec whole{
      .existing = {
          {0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}, {1, 0, 1}, {2, 0, 1}, {3, 0, 1}, {4, 0, 1}}};
  model::RobotSpec rest = whole;
  rest.existing.pop_back();
  const auto robot = model::Robot::create(whole);
  const auto robot_rest = model::Robot::create(rest);
  ASSERT_TRUE(robot && robot_rest);
  const verdict::Assessment exact_whole = verdict::assess(robot.value());
  const verdict::Assessment exact_rest = verdict::assess(robot_rest.value());
  ASSERT_NE(exact_whole.verdict, exact_rest.verdict);
  for (const agent::Time at :
       {agent::Time{0}, agent::Time{30}, agent::Time{100}, agent::Time{5000}}) {
    SCOPED_TRACE(at);
    sim::SimulationOptions options{
        .faults = {{.kind = sim::Fault::Kind::kDetach, .at = at, .module = 7}}};
    sim::Simulation simulation(robot.value(), options);
    simulation.run();
    const sim::SimulationResult result = simulation.result();
    EXPECT_TRUE(result.is_quiet);
    EXPECT_TRUE(result.all_agree);
    EXPECT_STREQ(agent::name(result.answer.verdict), verdict::name(exact_rest.verdict));
  }
}

}  // namespace
}  // namespace holdfast
