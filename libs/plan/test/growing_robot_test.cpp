// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
//
// Robots that grow module by module, every state beside a full check of it alone.
#include "holdfast/plan/growing_robot.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "holdfast/verdict/assessment.hpp"
#include "random_robot.hpp"
#include "robot_growth.hpp"

namespace holdfast::plan {
namespace {

/// The target's modules from its supports outwards.
std::vector<Element> outwards(const model::Robot& target) {
  std::vector<Element> order;
  std::vector<bool> has_come(target.modules().size());
  const auto take = [&](std::size_t module) {
    if (!has_come[module]) {
      has_come[module] = true;
      order.push_back(static_cast<Element>(module));
    }
  };
  const auto support = std::ranges::find_if(target.modules(), [](const model::Module& module) {
    return module.support != model::Support::kNone;
  });
  take(static_cast<std::size_t>(support - target.modules().begin()));
  for (std::size_t i = 0; i < order.size(); ++i) {
    for (const std::int32_t other : target.connected()[base::at(order[i])]) {
      if (other != model::Robot::kNoNeighbour) {
        take(base::at(other));
      }
    }
  }
  return order;
}

struct Tally {
  int state_count = 0;
  int sure_count = 0;
};

void grow(model::RobotSpec spec, Tally& tally) {
  spec.existing.insert(spec.existing.end(), spec.planned.begin(), spec.planned.end());
  spec.planned.clear();
  const model::Robot target = model::Robot::create(spec).value();
  GrowingRobot growing(target);
  ElementSet state(spec.existing.size());
  for (const Element element : outwards(target)) {
    state.insert(element);
    const verdict::Assessment full =
        verdict::assess(model::Robot::create(part_of(spec, state)).value());
    const auto grown = growing.assess_safe(state);
    ++tally.state_count;
    if (grown && full.verdict != verdict::Verdict::kUnstable) {
      ++tally.sure_count;
      EXPECT_EQ(full.verdict, verdict::Verdict::kSafe) << state.size();
      // Both solve to 1e-10 of the loads; a load ratio is at most some thousand loads' levers.
      EXPECT_NEAR(grown->load_ratio_max.value_or(0), full.load_ratio_max.value_or(0), 1e-8)
          << state.size();
    }
  }
}

TEST(GrowingRobot, has_the_load_ratio_of_a_full_check) {
  Tally tally;
  for (std::uint64_t seed = 1; seed <= 60; ++seed) {
    grow(test::random_robot(seed), tally);
  }
  EXPECT_GT(tally.sure_count, tally.state_count / 10);
}

TEST(GrowingRobot, leaves_what_tilts_and_what_breaks) {
  // A row at a post's top: at first its foot presses all over, then on one side only.
  const std::vector<base::Cell> cells = {{0, 0, 0}, {1, 0, 0}, {0, 0, 1}, {0, 0, 2},
                                         {1, 0, 2}, {2, 0, 2}, {3, 0, 2}, {4, 0, 2}};
  const model::Robot target = model::Robot::create({.existing = cells}).value();
  GrowingRobot growing(target);
  EXPECT_TRUE(growing.is_thin());
  ElementSet state(cells.size());
  state.insert(0);
  EXPECT_TRUE(growing.assess_safe(state));
  for (Element element = 1; element < 8; ++element) {
    state.insert(element);
  }
  EXPECT_FALSE(growing.assess_safe(state));
  // Back to what presses.
  ElementSet post(cells.size());
  post.insert(0);
  post.insert(2);
  EXPECT_TRUE(growing.assess_safe(post));
}

}  // namespace
}  // namespace holdfast::plan
