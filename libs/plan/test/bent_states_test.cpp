// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
//
// What planners call safe where somebody states the elastic modulus, against verdict::assess() with
// its second-order check, which is the second method; and Greenhill's column, which buckles at a
// height of (7.8373 E I / q)^(1/3).
#include <gtest/gtest.h>

#include "general_robot.hpp"
#include "holdfast/plan/candidates.hpp"
#include "holdfast/plan/order.hpp"
#include "holdfast/plan/part_of.hpp"
#include "holdfast/plan/sequence.hpp"
#include "seeds.hpp"

namespace holdfast::plan {
namespace {

using verdict::Verdict;

verdict::Assessment checked(const model::Robot& robot) {
  return verdict::assess(robot,
                         {.thread_count = 1, .second_order = solver::SecondOrderWish::kCheck});
}

/// A thin tower of Table I's modules but for E; of 5 MPa it buckles from 21 modules on.
model::RobotSpec soft_tower(std::int32_t height) {
  model::RobotSpec spec;
  for (std::int32_t z = 0; z < height; ++z) {
    spec.existing.push_back({0, 0, z});
  }
  spec.material.elastic_modulus_mpa = 5;
  return spec;
}

TEST(BentCandidates, are_undecided_where_linear_theory_does_not_suffice) {
  const model::RobotSpec spec = soft_tower(20);
  const std::vector<base::Cell> cells = {{0, 0, 20}};
  const Judgement bent = judge_candidates(spec, cells).candidates.front().judgement;
  EXPECT_EQ(bent.verdict, Verdict::kUndecided);
  EXPECT_TRUE(bent.is_bent);
  model::RobotSpec stiff = spec;
  stiff.material.elastic_modulus_mpa = 500;
  EXPECT_EQ(judge_candidates(stiff, cells).candidates.front().judgement.verdict, Verdict::kSafe);
}

/// Nobody states that the default is the modulus: a check warns, and its verdict stands.
TEST(BentCandidates, are_judged_by_linear_theory_where_nobody_states_the_elastic_modulus) {
  model::RobotSpec spec = soft_tower(60);
  spec.material.elastic_modulus_mpa = model::Material{}.elastic_modulus_mpa;
  const std::vector<base::Cell> cells = {{0, 0, 60}};
  EXPECT_EQ(judge_candidates(spec, cells).candidates.front().judgement.verdict, Verdict::kSafe);
  spec.is_modulus_stated = true;
  EXPECT_TRUE(judge_candidates(spec, cells).candidates.front().judgement.is_bent);
}

TEST(BentCandidates, are_what_a_check_with_the_second_order_check_says) {
  int bent_count = 0;
  int safe_count = 0;
  for (const base::Lattice& lattice : test::kLattices) {
    for (std::uint64_t seed = 0; seed < test::campaign(6U); ++seed) {
      model::RobotSpec spec = test::on_a_floor(test::general_robot(lattice, seed), seed % 2 == 0);
      spec.material.elastic_modulus_mpa = 0.2;
      const auto cells = free_cells(spec);
      for (const Candidate& candidate : judge_candidates(spec, cells).candidates) {
        model::RobotSpec grown = spec;
        grown.planned.push_back(candidate.cell);
        const auto robot = model::Robot::create(grown);
        ASSERT_EQ(robot.has_value(), candidate.is_robot);
        if (robot) {
          const auto full = checked(robot.value());
          EXPECT_EQ(candidate.judgement.verdict, full.verdict);
          bent_count += candidate.judgement.is_bent ? 1 : 0;
          safe_count += candidate.judgement.is_safe() ? 1 : 0;
        }
      }
    }
  }
  EXPECT_GT(bent_count, 0);
  EXPECT_GT(safe_count, 0);
}

/// A tower of 2 x 2 modules, of which one column alone buckles from 17 modules on.
TEST(BentOrder, leads_through_states_alone_that_the_second_order_check_does_not_doubt) {
  OrderTask task;
  for (std::int32_t z = 0; z < 18; ++z) {
    for (std::int32_t i = 0; i < 4; ++i) {
      task.target.existing.push_back({i % 2, i / 2, z});
    }
  }
  task.target.material.elastic_modulus_mpa = 2.5;
  const auto found = find_robot_order(task, {.state_count_max = 4000});
  ASSERT_TRUE(found) << found.error().message;
  ASSERT_EQ(found.value().order.outcome, OrderOutcome::kFound);
  ElementSet state = found.value().order.start;
  for (const Batch& step : found.value().order.steps) {
    state = changed(std::move(state), Sense::kGrowing, step);
    const auto robot = model::Robot::create(part_of(task.target, state));
    ASSERT_TRUE(robot);
    EXPECT_EQ(checked(robot.value()).verdict, Verdict::kSafe) << state.size();
  }
}

TEST(BentOrder, is_not_found_to_a_tower_that_buckles_nor_proved_not_to_exist) {
  const auto found = find_robot_order({.target = soft_tower(22)}, {.state_count_max = 1000});
  ASSERT_TRUE(found) << found.error().message;
  EXPECT_EQ(found.value().order.outcome, OrderOutcome::kNotFound);
  EXPECT_GE(found.value().order.undecided_count, 1U);
  const auto begun = find_robot_order({.target = soft_tower(23), .start = soft_tower(22).existing},
                                      {.state_count_max = 1000});
  ASSERT_FALSE(begun);
  EXPECT_NE(begun.error().message.find("linear theory does not suffice"), std::string::npos);
}

TEST(BentSteps, are_undecided_with_the_reason) {
  std::vector<model::Step> steps(3);
  for (std::int32_t i = 0; i < 3; ++i) {
    steps[static_cast<std::size_t>(i)].attach.push_back({0, 0, 19 + i});
  }
  const auto judged = judge_sequence(soft_tower(19), steps);
  ASSERT_TRUE(judged) << judged.error().message;
  ASSERT_TRUE(judged.value().first_undecided);
  const StageId first = *judged.value().first_undecided;
  const StageJudgement& stage =
      judged.value().steps[first.step].stages[static_cast<std::size_t>(first.stage)];
  EXPECT_EQ(stage.reasons.front().reason.code, verdict::ReasonCode::kSecondOrder);
  EXPECT_FALSE(judged.value().first_unsafe);
}

}  // namespace
}  // namespace holdfast::plan
