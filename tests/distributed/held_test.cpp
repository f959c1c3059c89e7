// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
// Robots of which all or many modules are fixed, with planned ones on them, against the exact
// solver. `./dev bench distributed general 0 1000 held near LATTICE` runs more.
#include <gtest/gtest.h>

#include "campaign.hpp"
#include "expectations.hpp"
#include "general_robot.hpp"
#include "holdfast/distributed.hpp"
#include "seeds.hpp"

namespace holdfast {
namespace {

using agent::Method;

/// No force is left on a robot whose existing modules cannot move before planned ones have moved; a
/// verdict then would rest on contact states of planned feet that nobody has looked up.
TEST(Held, planned_modules_bear_what_the_exact_solver_says_whatever_is_fixed) {
  constexpr Method kMethods[] = {Method::kElimination, Method::kPolynomial, Method::kFronts};
  int count = 0;
  for (const base::Lattice& lattice : test::kLattices) {
    for (const test::Fixed fixed : test::kFixed) {
      for (std::uint64_t seed = 0; seed < test::campaign(24U, 12U); ++seed) {
        const auto robot = test::near_limit(test::held_robot(lattice, seed, fixed), seed);
        if (!robot) {
          continue;
        }
        for (const Method method : kMethods) {
          SCOPED_TRACE(::testing::Message()
                       << "held_robot of " << lattice.direction_count << " directions, seed "
                       << seed << ", " << static_cast<int>(fixed) << ", " << name(method));
          const auto comparison = test::compare(*robot, {.seed = seed, .method = method});
          if (comparison.exact != verdict::Verdict::kUndecided) {
            test::expect_right(comparison);
            ++count;
          }
        }
      }
    }
  }
  EXPECT_GE(count, test::least(1000, 12));
}

/// A foot of a planned cube beside three fixed ones tilts (moments of inertia ten times those of
/// Table I). By an independent solver, which forms the whole matrix, the largest load ratio is
/// 1.0500.
TEST(Held, a_planned_foot_that_tilts_beside_fixed_modules_breaks_its_connection) {
  model::RobotSpec spec{.existing = {{0, 0, 0}, {0, -1, 0}, {-1, 0, 0}}};
  spec.fixed = spec.existing;
  spec.planned = {{-1, -1, 0}, {1, 0, 0}};
  spec.material.moment_x_mm4 = 2133333;
  spec.material.moment_y_mm4 = 2133333;
  spec.material.strength_lateral_n = 0.32671704945255964;
  spec.material.strength_vertical_n = 0.261460938706858;
  const model::Robot robot = test::robot_of(spec);
  for (const Method method : {Method::kElimination, Method::kPolynomial, Method::kFronts}) {
    sim::Simulation simulation(robot, {.method = method});
    simulation.run();
    const agent::Answer answer = simulation.result().answer;
    EXPECT_EQ(answer.verdict, agent::Verdict::kOverload) << name(method);
    EXPECT_NEAR(static_cast<double>(answer.load_ratio_max), 1.05, 1e-4) << name(method);
  }
}

}  // namespace
}  // namespace holdfast
