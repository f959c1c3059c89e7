// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
//
// Steps that are told before a search ends: whoever carries them out at once relies on them, so
// they are all of the order that is found, none is taken back, and every state behind them is a
// robot that verdict::assess calls safe here.
#include <gtest/gtest.h>

#include <limits>

#include "family_spec.hpp"
#include "general_robot.hpp"
#include "holdfast/plan/order.hpp"
#include "holdfast/verdict/assessment.hpp"
#include "seeds.hpp"

namespace holdfast::plan {
namespace {

struct Told {
  std::vector<Batch> steps;  ///< The first one is what is there before any.
  std::vector<Judgement> judged;
  std::size_t early_count = 0;  ///< Those that were told before the search ended.
};

RobotOrderOptions listening(Told& told, bool is_apart) {
  RobotOrderOptions options{.state_count_max = 3000};
  options.told_end = is_apart ? Sense::kShrinking : Sense::kGrowing;
  options.progress = [&told](std::size_t, std::size_t, std::size_t) {
    told.early_count = told.steps.size();
  };
  options.certified = [&told](const Batch& step, const Judgement& judged) {
    told.steps.push_back(step);
    told.judged.push_back(judged);
  };
  return options;
}

void expect_safe(const OrderTask& task, const ElementSet& state) {
  model::RobotSpec spec = task.target;
  spec.existing.clear();
  for (const Element element : state.elements()) {
    spec.existing.push_back(task.target.existing[base::at(element)]);
  }
  model::forget_absent(spec);
  const auto robot = model::Robot::create(spec);
  ASSERT_TRUE(robot) << robot.error().message;
  EXPECT_EQ(verdict::assess(robot.value()).verdict, verdict::Verdict::kSafe) << state.size();
}

/// Carries out what was told, and compares it with the order.
void expect_order(const OrderTask& task, const Order& order, const Told& told, bool is_apart) {
  const std::size_t count = order.steps.size();
  ASSERT_EQ(told.steps.size(), count + 1);
  ElementSet state(task.target.existing.size());
  for (std::size_t i = 0; i <= count; ++i) {
    EXPECT_EQ(told.judged[i], order.judgements[is_apart ? count - i : i]) << i;
    if (i > 0) {
      EXPECT_EQ(told.steps[i], order.steps[is_apart ? count - i : i - 1]) << i;
    }
    state = changed(std::move(state), i > 0 && is_apart ? Sense::kShrinking : Sense::kGrowing,
                    told.steps[i]);
    expect_safe(task, state);
  }
  EXPECT_EQ(state.size(), is_apart ? order.start.size() : task.target.existing.size());
}

TEST(CertifiedSteps, are_those_of_the_order_and_safe) {
  int found_count = 0;
  for (std::uint64_t seed = 0; seed < holdfast::test::campaign(240U); ++seed) {
    model::RobotSpec spec = test::general_robot(test::kLattices[seed % 4], seed);
    if (seed % 3 != 0) {
      spec = test::on_a_floor(std::move(spec), seed % 3 == 1);
    }
    if (!model::Robot::create(spec) || spec.existing.size() > 16) {
      continue;
    }
    const bool is_apart = seed / 4 % 2 == 0;
    OrderTask task{.target = std::move(spec), .parallel_max = 1 + seed / 8 % 3};
    task.group_size = task.parallel_max == 1 ? 1 + seed / 5 % 2 : 1;
    Told told;
    const auto result = find_robot_order(task, listening(told, is_apart));
    SCOPED_TRACE(seed);
    if (!result || result.value().order.outcome != OrderOutcome::kFound) {
      EXPECT_TRUE(told.steps.empty());
      continue;
    }
    ++found_count;
    expect_order(task, result.value().order, told, is_apart);
  }
  EXPECT_GE(found_count, holdfast::test::least(60));
}

TEST(CertifiedSteps, come_before_the_search_ends_where_it_makes_time_steps) {
  for (const auto& [family, size] :
       std::vector<std::pair<const char*, std::size_t>>{{"growth", 120}, {"cube", 5}}) {
    for (const bool is_apart : {false, true}) {
      const OrderTask task{.target = test::family_spec(family, size), .parallel_max = 4};
      Told told;
      const auto result = find_robot_order(task, listening(told, is_apart)).value();
      ASSERT_EQ(result.order.outcome, OrderOutcome::kFound);
      // Who takes a robot apart begins with what such a search finds last.
      EXPECT_EQ(told.early_count > 1, !is_apart) << family;
      expect_order(task, result.order, told, is_apart);
    }
  }
}

}  // namespace
}  // namespace holdfast::plan
