// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
// Robots of every lattice, supported anywhere and loaded in any way, that nobody has looked at: an
// answer always comes, forces balance, and turning the world with the robot turns the answer.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "general_robot.hpp"
#include "holdfast/verdict/assessment.hpp"

namespace holdfast {
namespace {

using base::Vec6;
using verdict::Assessment;

constexpr std::uint64_t kRobotCount = 120;

class GeneralRobots : public testing::TestWithParam<base::Lattice> {};

INSTANTIATE_TEST_SUITE_P(Lattices, GeneralRobots, testing::ValuesIn(test::kLattices));

double largest(const std::vector<Vec6<double>>& vectors) {
  double size = 1e-12;
  for (const Vec6<double>& vector : vectors) {
    for (const double component : vector) {
      size = std::max(size, std::abs(component));
    }
  }
  return size;
}

bool has_loads(const Assessment& assessment) {
  return assessment.equilibrium.outcome == solver::Outcome::kSettled && assessment.is_stable &&
         assessment.equilibrium.open_but_held_count == 0;
}

/// Every module: what its loads, its connections and its facets do to it adds up to nothing, on the
/// robot as a whole, about the origin.
void expect_balance(const model::Robot& robot, const Assessment& assessment) {
  Vec6<double> sum{};
  double size = 0;
  for (std::size_t i = 0; i < robot.modules().size(); ++i) {
    auto place = base::node_place(robot.lattice(), robot.modules()[i].cell);
    std::ranges::for_each(place, [&](double& x) { x *= robot.material().pitch_mm; });
    for (const Vec6<double>& f : {robot.loads()[i], assessment.equilibrium.ground_force[i]}) {
      base::add_to(sum, {f[0], f[1], f[2], f[3] + place[1] * f[2] - place[2] * f[1],
                         f[4] + place[2] * f[0] - place[0] * f[2],
                         f[5] + place[0] * f[1] - place[1] * f[0]});
      size += std::hypot(f[0], f[1], f[2]);
    }
  }
  for (std::size_t k = 0; k < 6; ++k) {
    EXPECT_NEAR(sum[k], 0, 1e-6 * size * (k < 3 ? 1 : 100));
  }
}

TEST_P(GeneralRobots, are_answered_with_reasons_and_balance) {
  int settled_count = 0;
  int undecided_count = 0;
  for (std::uint64_t seed = 0; seed < kRobotCount; ++seed) {
    SCOPED_TRACE(::testing::Message() << "general_robot " << seed);
    const auto robot = model::Robot::create(test::general_robot(GetParam(), seed));
    ASSERT_TRUE(robot) << robot.error().message;
    const Assessment assessment = verdict::assess(robot.value());
    ASSERT_FALSE(assessment.reasons.empty());
    if (assessment.verdict == verdict::Verdict::kSafe) {
      EXPECT_TRUE(assessment.rigid.holds());
      EXPECT_TRUE(assessment.model.is_settled && assessment.model.is_stable);
    }
    undecided_count += assessment.verdict == verdict::Verdict::kUndecided ? 1 : 0;
    if (has_loads(assessment) && robot.value().fixed_count() == 0) {
      expect_balance(robot.value(), assessment);
      ++settled_count;
    }
  }
  // The generator must reach robots that stand, or the test above says little.
  EXPECT_GT(settled_count, 15);
  EXPECT_LT(undecided_count, static_cast<int>(kRobotCount) / 20);
}

/// Doubling is exact in binary, so nothing but the size may change, to the last bit.
TEST_P(GeneralRobots, double_their_answer_when_all_loads_double) {
  for (std::uint64_t seed = 0; seed < kRobotCount; seed += 4) {
    SCOPED_TRACE(::testing::Message() << "general_robot " << seed);
    model::RobotSpec spec = test::general_robot(GetParam(), seed);
    spec.gravity_m_s2 = {1, -2, -9};
    const Assessment once = verdict::assess(model::Robot::create(spec).value());
    std::ranges::for_each(*spec.gravity_m_s2, [](double& g) { g *= 2; });
    for (model::Payload& payload : spec.payloads) {
      std::ranges::for_each(payload.force_n, [](double& f) { f *= 2; });
      std::ranges::for_each(payload.torque_nmm, [](double& m) { m *= 2; });
    }
    Assessment twice = verdict::assess(model::Robot::create(spec).value());
    EXPECT_EQ(once.is_stable, twice.is_stable);
    ASSERT_EQ(once.equilibrium.outcome, twice.equilibrium.outcome);
    EXPECT_EQ(once.equilibrium.contact, twice.equilibrium.contact);
    for (Vec6<double>& u : twice.equilibrium.displacement) {
      std::ranges::for_each(u, [](double& component) { component /= 2; });
    }
    EXPECT_EQ(once.equilibrium.displacement, twice.equilibrium.displacement);
  }
}

/// Space has no direction but what gravity and supports give it. Facets are squares whose sides
/// know what is up, so robots in contact may be turned only by symmetries that keep their frames.
TEST_P(GeneralRobots, have_the_same_answer_when_all_is_turned) {
  const auto turns = test::symmetries(GetParam());
  int compared_count = 0;
  for (std::uint64_t seed = 0; seed < kRobotCount; ++seed) {
    const model::RobotSpec spec = test::general_robot(GetParam(), seed);
    const auto robot = model::Robot::create(spec);
    const test::Symmetry& turn = turns[1 + seed % (turns.size() - 1)];
    SCOPED_TRACE(::testing::Message()
                 << "general_robot " << seed << " turned by " << 1 + seed % (turns.size() - 1));
    const bool has_contact = std::ranges::any_of(
        robot.value().facets(), [](const model::Facet& facet) { return !facet.is_bonded(); });
    if (has_contact && !test::keeps_frames(GetParam(), turn)) {
      continue;
    }
    const auto other = model::Robot::create(test::turned(spec, turn));
    ASSERT_TRUE(other) << other.error().message;
    const Assessment a = verdict::assess(robot.value());
    const Assessment b = verdict::assess(other.value());
    EXPECT_EQ(a.rigid.answer, b.rigid.answer);
    EXPECT_EQ(a.is_stable, b.is_stable);
    if (!has_loads(a) || !has_loads(b)) {
      continue;
    }
    ++compared_count;
    const double size = largest(a.equilibrium.displacement);
    for (std::size_t i = 0; i < a.equilibrium.displacement.size(); ++i) {
      const Vec6<double> expected = turn(a.equilibrium.displacement[i]);
      for (std::size_t k = 0; k < 6; ++k) {
        EXPECT_NEAR(b.equilibrium.displacement[i][k], expected[k], 1e-7 * size) << "module " << i;
      }
    }
  }
  EXPECT_GT(compared_count, 10);
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
    model::RobotSpec spec = test::general_robot(base::kCubic, seed);
    spec.obstacles.clear();
    spec.payloads.clear();
    spec.own_masses.clear();
    spec.gravity_m_s2.reset();
    const auto lowest = std::ranges::min_element(spec.existing, {}, &base::Cell::z)->z;
    spec.support_z = lowest;
    const Assessment floor = verdict::assess(model::Robot::create(spec).value());
    spec.support_z.reset();
    spec.obstacles = {{.from = {-100, -100, lowest - 1}, .to = {100, 100, lowest - 1}}};
    const Assessment obstacle = verdict::assess(model::Robot::create(spec).value());
    EXPECT_EQ(floor.verdict, obstacle.verdict);
    EXPECT_EQ(floor.simplified.margin_mm, obstacle.simplified.margin_mm);
    EXPECT_EQ(floor.load_ratio_max, obstacle.load_ratio_max);
    EXPECT_EQ(floor.equilibrium.displacement, obstacle.equilibrium.displacement);
  }
}

}  // namespace
}  // namespace holdfast
