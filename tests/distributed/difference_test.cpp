// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
//
// What a robot's report says of its own error, and of why it answers otherwise than the exact
// solver.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "campaign.hpp"
#include "general_robot.hpp"
#include "holdfast/base/rng.hpp"
#include "holdfast/distributed.hpp"
#include "holdfast/verdict/assessment.hpp"
#include "seeds.hpp"

namespace holdfast {
namespace {

struct Answers {
  verdict::Assessment exact;
  DistributedRun robot;
};

Answers answers_of(const model::Robot& robot, const sim::SimulationOptions& options = {}) {
  CheckResult exact;
  exact.assessment = verdict::assess(robot);
  DistributedRun run = simulate(robot, exact, options).value();
  return {.exact = std::move(exact.assessment), .robot = std::move(run)};
}

/// Modules that grow one by one on a fixed one, each beside a single one that is there.
model::RobotSpec random_tree(const base::Lattice& lattice, std::uint64_t seed) {
  base::Rng rng(seed);
  model::RobotSpec spec{.existing = {{0, 0, 9}}, .fixed = {{0, 0, 9}}};
  spec.lattice = lattice;
  const std::size_t count = 3 + rng.below(12);
  std::vector<base::Cell>& cells = spec.existing;
  for (int attempt = 0; attempt < 400 && cells.size() < count; ++attempt) {
    const auto face = static_cast<base::Direction>(
        rng.below(static_cast<std::uint64_t>(lattice.direction_count)));
    const base::Cell cell = base::neighbour(lattice, cells[rng.below(cells.size())], face);
    int beside_count = 0;
    for (const base::Direction other : base::directions(lattice)) {
      beside_count += std::ranges::count(cells, base::neighbour(lattice, cell, other)) > 0 ? 1 : 0;
    }
    if (std::ranges::count(cells, cell) == 0 && cell.z > 0 && beside_count == 1) {
      cells.push_back(cell);
    }
  }
  return spec;
}

/// The stated error, and the rounding of messages besides, bound the distance to the exact answer
/// where there is no loop; a second fixed module, or a foot beside the fixed one, makes a loop.
TEST(ErrorKind, is_a_bound_just_where_balance_alone_gives_the_forces) {
  constexpr agent::Method kMethods[] = {agent::Method::kElimination, agent::Method::kFronts};
  constexpr double kRounding = 2e-7;
  int count = 0;
  for (const base::Lattice& lattice : test::kLattices) {
    for (std::uint64_t seed = 0; seed < test::campaign(24U, 4U); ++seed) {
      SCOPED_TRACE(::testing::Message() << lattice.direction_count << " directions, seed " << seed);
      model::RobotSpec spec = random_tree(lattice, seed);
      const Answers tree = answers_of(test::robot_of(test::with_last_planned(spec, seed % 3)),
                                      {.method = kMethods[seed % 2]});
      EXPECT_EQ(tree.robot.error_kind, ErrorKind::kBound);
      EXPECT_EQ(tree.robot.difference, Difference::kNone);
      if (const auto ratio = load_ratio_max(tree.robot.result.answer)) {
        const double exact = *tree.exact.load_ratio_max;
        EXPECT_LE(std::abs(*ratio - exact),
                  static_cast<double>(tree.robot.result.effort.ratio_error) +
                      kRounding * (1 + std::abs(exact)));
        ++count;
      }
      const base::Cell foot = spec.existing.back();
      bool is_beside = false;
      for (const base::Direction face : base::directions(lattice)) {
        is_beside = is_beside || base::neighbour(lattice, foot, face) == spec.existing.front();
      }
      spec.fixed.push_back(foot);
      EXPECT_EQ(answers_of(test::robot_of(spec)).robot.error_kind,
                is_beside ? ErrorKind::kBound : ErrorKind::kEstimate);
      spec.fixed.pop_back();
      spec.obstacles = {
          {.from = {}, .to = {}, .cells = {base::neighbour(lattice, foot, base::Direction{5})}}};
      if (const auto standing = model::Robot::create(spec);
          standing && !standing.value().facets().empty()) {
        EXPECT_EQ(answers_of(standing.value()).robot.error_kind, ErrorKind::kEstimate);
      }
    }
  }
  EXPECT_GE(count, test::least(80, 10));
}

/// The difference is none where robot and exact solver say the same, by the same law and as far as
/// promised; else the report knows why.
TEST(Difference, is_named_wherever_robot_and_exact_solver_answer_otherwise) {
  constexpr std::size_t kFewModules = 6;  // Large ones with loops take long.
  int count = 0;
  for (const base::Lattice& lattice : test::kLattices) {
    for (std::uint64_t seed = 0; seed < test::campaign(60U, 4U); ++seed) {
      SCOPED_TRACE(::testing::Message() << lattice.direction_count << " directions, seed " << seed);
      const model::RobotSpec spec = test::with_friction(test::general_robot(lattice, seed), seed);
      const auto robot = model::Robot::create(test::with_last_planned(spec, 1));
      if (!robot || spec.existing.size() > kFewModules) {
        continue;
      }
      const Answers run = answers_of(robot.value());
      const Difference difference = run.robot.difference;
      const bool is_other_verdict = run.robot.view.verdict != run.exact.verdict;
      const auto ratio = load_ratio_max(run.robot.result.answer);
      const bool is_unilateral = run.exact.contact_model == verdict::ContactModel::kUnilateral;
      const bool is_other_law = ratio && run.robot.result.effort.solves > 0 &&
                                run.exact.contact_model != verdict::ContactModel::kNone &&
                                run.robot.result.effort.is_unilateral != is_unilateral;
      EXPECT_NE(difference, Difference::kUnexplained);
      EXPECT_TRUE(difference != Difference::kNone || !(is_other_verdict || is_other_law));
      EXPECT_TRUE(difference != Difference::kRobotUndecided ||
                  run.robot.view.verdict == verdict::Verdict::kUndecided);
      EXPECT_TRUE(difference != Difference::kExactUndecided ||
                  run.exact.verdict == verdict::Verdict::kUndecided);
      EXPECT_TRUE(difference != Difference::kContactLaw || is_other_law);
      count += difference == Difference::kNone ? 0 : 1;
    }
  }
  EXPECT_GE(count, test::least(4));
}

}  // namespace
}  // namespace holdfast
