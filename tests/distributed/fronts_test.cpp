// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
// Elimination with fronts (docs/distributed.md) against the exact solver: any loops, any contact,
// few sweeps.
#include <gtest/gtest.h>

#include <tuple>

#include "campaign.hpp"
#include "expectations.hpp"
#include "general_robot.hpp"
#include "holdfast/holdfast.hpp"
#include "random_robot.hpp"
#include "seeds.hpp"

namespace holdfast {
namespace {

constexpr auto kFronts = agent::Method::kFronts;

/// The method is neither the polynomial nor conjugate gradients.
void expect_exact_method(const test::Comparison& comparison) {
  const agent::Method method = comparison.result.effort.method;
  EXPECT_TRUE(method == kFronts || method == agent::Method::kElimination) << comparison.text();
}

/// 406, 616 and 926 have no state under the regularised law; planned modules between others in
/// most. 60 sweeps are what is asked of the worst robot.
TEST(Fronts, random_robots_are_decided_in_few_sweeps) {
  for (const std::uint64_t from : {0U, 400U, 610U, 920U}) {
    for (std::uint64_t seed = from; seed < from + test::campaign(20U); ++seed) {
      SCOPED_TRACE(::testing::Message() << "random_robot(" << seed << ")");
      const auto comparison = test::compare(test::robot_of(test::random_robot(seed)),
                                            {.seed = seed, .method = kFronts});
      test::expect_right(comparison);
      EXPECT_LE(comparison.sweeps(), 60);
      expect_exact_method(comparison);
    }
  }
}

/// These robots had many sweeps for other reasons: refinement that came to a halt at the rounding
/// of displacements and loads of kept facets (3534), a root's matrix that rounding had made
/// negative (6226), more kept facets than the root had room for (10506), batches of one and two
/// facets (4478, 12982), and open feet that are freed one after the other (5162).
TEST(Fronts, robots_that_took_many_sweeps_take_few) {
  for (const std::uint64_t seed : test::campaign({3534U, 4478U, 5162U, 6226U, 10506U, 12982U}, 3)) {
    SCOPED_TRACE(::testing::Message() << "random_robot(" << seed << ")");
    const auto comparison =
        test::compare(test::robot_of(test::random_robot(seed)), {.seed = seed, .method = kFronts});
    test::expect_right(comparison);
    EXPECT_LE(comparison.sweeps(), 60);
    expect_exact_method(comparison);
  }
}

/// The exact solver knows two solutions of the paper's law for each of these robots; in one of them
/// a connection breaks. In the one that is found first none does.
TEST(Fronts, no_robot_is_safe_that_another_solution_breaks) {
  for (const std::uint64_t seed : {7373U, 12085U, 31269U}) {
    SCOPED_TRACE(::testing::Message() << "random_robot(" << seed << ")");
    const auto comparison =
        test::compare(test::robot_of(test::random_robot(seed)), {.seed = seed, .method = kFronts});
    EXPECT_EQ(comparison.exact, verdict::Verdict::kUndecided);
    EXPECT_EQ(comparison.result.answer.verdict, agent::Verdict::kUndecided);
    EXPECT_EQ(comparison.result.answer.reason, agent::Reason::kAmbiguousFeet);
    EXPECT_EQ(comparison.result.effort.method, kFronts);
    EXPECT_LE(comparison.sweeps(), 30);
  }
}

/// Walls, ceilings, slots and floors, masses and payloads, laws of connectors: the root knows what
/// a kept node touches, so that no other method is needed. Who is undecided besides has a trial
/// that does not converge, or may slip. Cubes 63, four modules on three facets, are safe where the
/// exact solver knows another solution of the paper's law, by which a connection breaks: it goes
/// through all states of so few facets, the robot puts one at a time into another state.
TEST(Fronts, robots_of_every_lattice_on_any_supports_are_decided_by_them_alone) {
  int decided = 0;
  int undecided_alone = 0;
  int safe_alone = 0;
  for (const base::Lattice& lattice : test::kLattices) {
    for (std::uint64_t seed = 0; seed < test::campaign(90U, 9U); ++seed) {
      SCOPED_TRACE(::testing::Message() << lattice.direction_count << " directions, seed " << seed);
      model::RobotSpec spec = test::general_robot(lattice, seed);
      spec = seed % 2 == 0 ? spec : test::with_laws(std::move(spec), seed);
      spec = seed % 5 != 4 ? spec : test::on_a_floor(std::move(spec), true);
      const auto robot = model::Robot::create(test::with_last_planned(std::move(spec), seed % 4));
      if (!robot) {
        continue;  // Nothing else of it is held.
      }
      const auto comparison = test::compare(robot.value(), {.seed = seed, .method = kFronts});
      EXPECT_TRUE(comparison.result.all_agree) << comparison.text();
      EXPECT_LT(comparison.ratio_error(), 1) << comparison.text();
      expect_exact_method(comparison);
      if (comparison.exact == verdict::Verdict::kUndecided) {
        safe_alone += comparison.is_undecided() ? 0 : 1;
        continue;
      }
      EXPECT_FALSE(comparison.is_wrong()) << comparison.text();
      ++decided;
      undecided_alone += comparison.is_undecided() ? 1 : 0;
    }
  }
  EXPECT_GE(decided, test::least(250, 10));
  EXPECT_LE(100 * undecided_alone, 2 * decided);
  EXPECT_LE(safe_alone, 1);
}

/// These robots are held by the weak springs of one foot: S in single precision would have other
/// states, none of which falls, and the exact law holds the robot.
TEST(Fronts, a_robot_that_hangs_on_weak_springs_is_not_safe) {
  const std::tuple<base::Lattice, std::uint64_t, std::size_t> robots[] = {
      {base::kFaceCentred, 1701, 3},
      {base::kHexagonalPrism, 813, 4},
      {base::kHexagonalPrism, 1144, 2}};
  for (const auto& [lattice, seed, planned] : robots) {
    SCOPED_TRACE(::testing::Message() << lattice.direction_count << " directions, seed " << seed);
    const model::RobotSpec spec = test::general_robot(lattice, seed);
    const auto robot = test::robot_of(
        test::with_last_planned(seed % 2 == 0 ? spec : test::with_laws(spec, seed), planned));
    const auto comparison = test::compare(robot, {.method = kFronts});
    EXPECT_EQ(comparison.exact, verdict::Verdict::kUnstable) << comparison.text();
    EXPECT_EQ(comparison.robot, agent::Verdict::kUnstable) << comparison.text();
    expect_exact_method(comparison);
  }
}

/// Two rows of modules on the ground with rungs between them, and a planned module between two.
TEST(Fronts, a_lying_ladder_with_a_planned_module_takes_few_sweeps) {
  model::RobotSpec ladder;
  constexpr std::int32_t kRungs = 12;
  for (std::int32_t rung = 0; rung < kRungs; ++rung) {
    for (std::int32_t x = 0; x < 2; ++x) {
      ladder.existing.push_back({2 * rung + x, 0, 0});
      ladder.existing.push_back({2 * rung + x, 2, 0});
    }
    ladder.existing.push_back({2 * rung, 1, 0});
  }
  ladder.planned = {{kRungs + 1, 1, 0}};
  const auto comparison = test::compare(test::robot_of(ladder), {.method = kFronts});
  test::expect_right(comparison);
  EXPECT_LE(comparison.sweeps(), 30);
}

/// A frame one module thick whose beam reaches beyond its posts: its feet tilt.
TEST(Fronts, a_frame_that_tilts_on_its_feet_takes_few_sweeps) {
  model::RobotSpec frame;
  constexpr std::int32_t kWidth = 12;
  constexpr std::int32_t kHeight = 8;
  for (std::int32_t z = 0; z < kHeight; ++z) {
    frame.existing.push_back({0, 0, z});
    frame.existing.push_back({kWidth - 1, 0, z});
  }
  for (std::int32_t x = -3; x < kWidth + 1; ++x) {
    if (x != 0 && x != kWidth - 1) {
      frame.existing.push_back({x, 0, kHeight - 1});
    }
  }
  const auto robot = test::robot_of(frame);
  const auto comparison = test::compare(robot, {.method = kFronts});
  test::expect_right(comparison);
  EXPECT_LE(comparison.sweeps(), 30);
}

/// Fixed modules have no rows in a front.
TEST(Fronts, a_fixed_block_with_planned_modules_between_others_is_decided) {
  model::RobotSpec block;
  for (std::int32_t i = 0; i < 36; ++i) {
    const base::Cell cell{i % 3, i / 3 % 3, i / 9};
    if (cell != base::Cell{1, 1, 2} && cell != base::Cell{1, 0, 2}) {
      block.existing.push_back(cell);
    }
    if (cell.z == 1 && cell.x == 0) {
      block.fixed.push_back(cell);
    }
  }
  block.planned = {{1, 1, 2}, {1, 0, 2}, {3, 1, 3}};
  const auto comparison = test::compare(test::robot_of(block), {.method = kFronts});
  test::expect_right(comparison);
  EXPECT_EQ(comparison.result.effort.method, kFronts);
}

/// The fronts of a large block would be the largest there are, and the polynomial is at its best.
TEST(Fronts, a_large_block_is_left_to_the_polynomial) {
  model::RobotSpec block;
  for (std::int32_t i = 0; i < 9 * 9 * 5; ++i) {
    block.existing.push_back({i % 9, i / 9 % 9, i / 81});
  }
  const auto comparison = test::compare(test::robot_of(block), {.method = kFronts});
  test::expect_right(comparison);
  EXPECT_EQ(comparison.result.effort.method, agent::Method::kPolynomial);
}

TEST(Fronts, bad_links_change_no_verdict) {
  for (std::uint64_t seed = 0; seed < 12; ++seed) {
    SCOPED_TRACE(::testing::Message() << "random_robot(" << seed << ")");
    test::expect_right(
        test::compare(test::robot_of(test::random_robot(seed)),
                      {.link = test::noisy_rounds(), .seed = seed + 1, .method = kFronts}));
  }
}

}  // namespace
}  // namespace holdfast
