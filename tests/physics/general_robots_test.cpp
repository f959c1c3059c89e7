// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
// Robots of every lattice, supported anywhere and loaded in any way, that nobody has looked at: an
// answer always comes, forces balance, and turning the world with the robot turns the answer.
#include <gtest/gtest.h>

#include "general_checks.hpp"
#include "hard_robot.hpp"
#include "seeds.hpp"

namespace holdfast {
namespace {

using verdict::Assessment;

// bench/general_bench.cpp looks at thousands of each.
constexpr std::uint64_t kRobotCount = test::campaign(120U, 5U);

class GeneralRobots : public testing::TestWithParam<base::Lattice> {};

INSTANTIATE_TEST_SUITE_P(Lattices, GeneralRobots, testing::ValuesIn(test::kLattices));

TEST_P(GeneralRobots, are_answered_with_reasons_and_balance) {
  int settled_count = 0;
  int undecided_count = 0;
  for (std::uint64_t seed = 0; seed < kRobotCount; ++seed) {
    const auto robot = model::Robot::create(test::general_robot(GetParam(), seed));
    ASSERT_TRUE(robot) << robot.error().message;
    const Assessment assessment = verdict::assess(robot.value());
    const test::Checked checked = test::check_answer(robot.value(), assessment);
    EXPECT_EQ(checked.fault, "") << "general_robot " << seed;
    settled_count += checked.is_compared ? 1 : 0;
    // Where two contact laws disagree is mechanics, not a search that gave up.
    const bool are_laws_at_odds =
        assessment.reasons.front().code == verdict::ReasonCode::kStatesDisagree;
    const bool is_undecided = assessment.verdict == verdict::Verdict::kUndecided;
    undecided_count += is_undecided && !are_laws_at_odds ? 1 : 0;
  }
  // The generator must reach robots that stand, or the test above says little.
  EXPECT_GE(settled_count, test::least(15, 5));
  EXPECT_LT(20 * undecided_count, static_cast<int>(kRobotCount));
}

TEST_P(GeneralRobots, double_their_answer_when_all_loads_double) {
  for (std::uint64_t seed = 0; seed < kRobotCount; seed += 4) {
    EXPECT_EQ(test::check_doubling(test::general_robot(GetParam(), seed)).fault, "")
        << "general_robot " << seed;
  }
}

TEST_P(GeneralRobots, break_just_below_the_strength_that_they_need) {
  for (std::uint64_t seed = 0; seed < kRobotCount; seed += 4) {
    EXPECT_EQ(test::check_limit(test::general_robot(GetParam(), seed)).fault, "")
        << "general_robot " << seed;
  }
}

TEST_P(GeneralRobots, have_the_same_answer_when_all_is_turned) {
  const auto turns = test::symmetries(GetParam());
  int compared_count = 0;
  for (std::uint64_t seed = 0; seed < kRobotCount; ++seed) {
    const model::RobotSpec spec = test::general_robot(GetParam(), seed);
    const std::size_t turn = 1 + seed % (turns.size() - 1);
    if (test::may_be_turned(spec, turns[turn])) {
      const test::Checked checked = test::check_turning(spec, turns[turn]);
      EXPECT_EQ(checked.fault, "") << "general_robot " << seed << " turned by " << turn;
      compared_count += checked.is_compared ? 1 : 0;
    }
  }
  EXPECT_GE(compared_count, test::least(10, 5));
}

TEST_P(GeneralRobots, that_are_hard_have_the_same_answer_when_all_is_turned) {
  const auto turns = test::symmetries(GetParam());
  for (std::uint64_t seed = 0; seed < kRobotCount; ++seed) {
    const model::RobotSpec spec = test::hard_robot(GetParam(), seed);
    const std::size_t turn = 1 + seed % (turns.size() - 1);
    if (test::may_be_turned(spec, turns[turn])) {
      EXPECT_EQ(test::check_turning(spec, turns[turn]).fault, "")
          << "hard_robot " << seed << " turned by " << turn;
    }
  }
}

/// Walls that carry by shear alone press with rounding: its sign must not decide.
TEST(RobotsBetweenWalls, have_the_same_answer_when_their_pressure_is_rounding) {
  struct Case {
    base::Lattice lattice;
    std::uint64_t seed;
    std::size_t turn;
  };

  for (const auto& [lattice, seed, turn] :
       {Case{base::kCubic, 624, 14}, Case{base::kCubic, 1342, 27}, Case{base::kCubic, 1621, 24},
        Case{base::kHexagonalPrism, 813, 9}}) {
    SCOPED_TRACE(::testing::Message() << "general_robot " << seed << " turned by " << turn);
    const test::Checked checked =
        test::check_turning(test::general_robot(lattice, seed), test::symmetries(lattice)[turn]);
    EXPECT_EQ(checked.fault, "");
  }
}

/// The weak springs of open facets pull in the paper's law, those of tilted ones (305) bend back;
/// then the exact law is asked, too.
TEST(RobotsWithOpenFacets, are_judged_by_both_laws) {
  for (const std::uint64_t seed : {std::uint64_t{268}, std::uint64_t{587}, std::uint64_t{305}}) {
    SCOPED_TRACE(::testing::Message() << "general_robot " << seed);
    const auto robot = model::Robot::create(test::general_robot(base::kCubic, seed));
    const Assessment assessment = verdict::assess(robot.value());
    ASSERT_EQ(assessment.contact_model, verdict::ContactModel::kRegularised);
    ASSERT_TRUE(assessment.several && assessment.several->unilateral);
    EXPECT_GT(assessment.several->unilateral->high, assessment.several->regularised.high);
  }
}

verdict::Verdict verdict_of(std::vector<base::Cell> modules, std::vector<base::Cell> obstacle) {
  model::RobotSpec spec = {.existing = std::move(modules)};
  spec.support_z = {};
  spec.obstacles.resize(1);
  spec.obstacles[0].cells = std::move(obstacle);
  const auto robot = model::Robot::create(spec);
  return verdict::assess(robot.value()).verdict;
}

/// Newton's method for the paper's law settles on neither robot, and the exact law holds them. All
/// their states were tried by a program of its own, tools/contact_states.py
/// (docs/evidence/supports.md).
TEST(RobotsOnWalls, are_not_safe_where_the_papers_law_lets_them_fall) {
  using verdict::Verdict;
  // A foot and a wall beside the middle one: one set of states is consistent, and falls.
  EXPECT_EQ(verdict_of({{0, 0, 0}, {1, 0, 0}, {2, 0, 0}}, {{0, 0, -1}, {1, -1, 0}}),
            Verdict::kUndecided);
  // A hook: none is consistent.
  EXPECT_EQ(verdict_of({{0, 0, 0}, {0, 0, 1}, {1, 0, 1}}, {{0, 0, -1}, {2, 0, 1}}), Verdict::kSafe);
}

/// Facets at the border of two states, which have the same solution: rounding goes from one to the
/// other for ever, by the order of the modules.
TEST(RobotsOnWalls, with_facets_at_a_border_have_one_verdict_in_any_order) {
  std::vector<base::Cell> two = {{0, 0, -1}, {0, 0, 0}};
  std::vector<base::Cell> three = {{0, 0, -2}, {0, 0, -1}, {0, 0, 0}};
  for (std::vector<base::Cell>* modules : {&two, &three}) {
    do {
      EXPECT_EQ(verdict_of(*modules, {{0, 1, 0}, {-1, 0, 0}, {0, 0, 1}}), verdict::Verdict::kSafe);
    } while (std::next_permutation(modules->begin(), modules->end()));
  }
}

TEST(Symmetries, are_as_many_as_of_the_polyhedra) {
  EXPECT_EQ(test::symmetries(base::kCubic).size(), 48U);
  EXPECT_EQ(test::symmetries(base::kFaceCentred).size(), 48U);
  EXPECT_EQ(test::symmetries(base::kHexagonal).size(), 24U);
  EXPECT_EQ(test::symmetries(base::kHexagonalPrism).size(), 24U);
}

/// The floor of version 1 and obstacles below the same modules are the same thing.
TEST(CubesOnObstacles, are_cubes_on_a_floor) {
  for (std::uint64_t seed = 0; seed < kRobotCount; ++seed) {
    EXPECT_EQ(test::check_floor(test::general_robot(base::kCubic, seed)).fault, "")
        << "general_robot " << seed;
  }
}

TEST(CubesOfVersionOne, are_cubes_of_version_two) {
  for (std::uint64_t seed = 0; seed < kRobotCount; ++seed) {
    EXPECT_EQ(test::check_versions(test::general_robot(base::kCubic, seed)).fault, "")
        << "general_robot " << seed;
  }
}

}  // namespace
}  // namespace holdfast
