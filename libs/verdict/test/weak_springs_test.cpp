// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
// A long arm, held at its root, with a foot at its tip, which a pull lifts off the floor: a weak
// spring beside the contact pulls the foot down, and the arm is so soft that it carries a share of
// the load. The truth is statics: the arm is a cantilever.
#include <gtest/gtest.h>

#include "holdfast/verdict/assessment.hpp"

namespace holdfast::verdict {
namespace {

constexpr double kArmWeight = 0.06106 * 9.81;

/// Modules along x, the first one fixed, the last one on a foot, with a pull that is what all of
/// them weigh. With w a module's weight, in the middle of the connection at the root, 20 mm from
/// the fixed module, acts
///   M = F (40 l - 20) - sum over the arm of w (40 i - 20) - w (40 l - 20),   F = w (l + 1).
model::RobotSpec lifted_arm(int length, double load_ratio) {
  model::RobotSpec spec{.existing = {{0, 0, 1}}, .fixed = {{0, 0, 1}}};
  for (int x = 1; x <= length; ++x) {
    spec.existing.push_back({x, 0, 1});
  }
  spec.existing.push_back({length, 0, 0});
  spec.payloads.push_back({.cell = {length, 0, 1}, .force_n = {0, 0, (length + 1) * kArmWeight}});
  const double moment = kArmWeight * (length * (40.0 * length - 20) - 20.0 * length * length);
  spec.material.strength_lateral_n = moment / 20 / load_ratio;
  return spec;
}

Assessment by_exact_law(const model::Robot& robot, solver::Method method, double gamma) {
  solver::EquilibriumSolver solver(robot, {.method = method, .thread_count = 1});
  return assess_equilibrium(
      robot, solver.solve({.law = mechanics::ContactLaw::kUnilateral, .gamma = gamma}), 1);
}

TEST(WeakSprings, of_open_facets_do_not_bear_load) {
  for (const int length : {20, 60, 150}) {
    const model::Robot robot = model::Robot::create(lifted_arm(length, 1)).value();
    for (const solver::Method method : {solver::Method::kDirect, solver::Method::kMultigrid}) {
      for (const double gamma : {1e-7, 1e-8, 1e-9}) {
        SCOPED_TRACE(::testing::Message() << length << ", gamma " << gamma);
        const Assessment found = by_exact_law(robot, method, gamma);
        ASSERT_EQ(found.equilibrium.outcome, solver::Outcome::kSettled);
        EXPECT_LE(found.load_ratio_range.low, 1);
        EXPECT_GE(found.load_ratio_range.high, 1);
        if (found.equilibrium.gamma == 0) {
          EXPECT_NEAR(*found.load_ratio_max, 1, method == solver::Method::kDirect ? 1e-6 : 1e-3);
        }
        if (length == 20 || gamma < 1e-7) {
          EXPECT_EQ(found.equilibrium.gamma, 0);
        }
      }
    }
  }
}

/// The springs take more load than that by which the limit is passed.
TEST(WeakSprings, make_no_robot_safe_that_breaks) {
  for (const int length : {20, 60, 100}) {
    for (const double load_ratio : {1 + 1e-5, 1 + 1e-4, 1 + 1e-3}) {
      const model::Robot robot = model::Robot::create(lifted_arm(length, load_ratio)).value();
      EXPECT_NE(verdict::assess(robot, {.thread_count = 1}).verdict, Verdict::kSafe)
          << length << ' ' << load_ratio;
      EXPECT_NE(
          verdict::assess(robot, {.method = solver::Method::kMultigrid, .thread_count = 1}).verdict,
          Verdict::kSafe)
          << length << ' ' << load_ratio;
    }
  }
}

}  // namespace
}  // namespace holdfast::verdict
