// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0

// Answers of a part of a robot: those of a column are known in closed form, those of larger robots
// are where the direct solver finds them, within the error that is said.

#include "equilibria/stuck_core.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "equilibria/carried_force.hpp"
#include "family_spec.hpp"
#include "holdfast/model/material.hpp"

namespace holdfast::plan {
namespace {

using base::Vec6;

ElementSet first_modules(std::size_t all, std::size_t count) {
  ElementSet modules(all);
  for (std::size_t i = 0; i < count; ++i) {
    modules.insert(static_cast<Element>(i));
  }
  return modules;
}

TEST(StuckCore, shortens_a_fixed_column_by_one_beam_for_each_module) {
  model::RobotSpec spec{.existing = {{0, 0, 0}, {0, 0, 1}, {0, 0, 2}, {0, 0, 3}, {0, 0, 4}},
                        .fixed = {{0, 0, 0}}};
  const auto core = StuckCore::make(spec, first_modules(5, 4), solver::Precision::kSingle);
  ASSERT_TRUE(core);
  ASSERT_EQ(core->robot().modules().size(), 4U);
  std::vector<Vec6<double>> loads(4);
  loads[3][2] = -7;
  const auto answer = core->answer(loads, 1e-6);
  ASSERT_TRUE(answer);
  const double axial = model::LatticeBeam<double>(model::beam_section(spec.material), spec.lattice)
                           .stiffness(base::Direction::kPlusZ)
                           .axial;
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_NEAR(answer->displacement[i][2], -7 / axial * static_cast<double>(i), 1e-12) << i;
  }
  EXPECT_NEAR(work_of(loads, answer->displacement), 49 * 3 / axial, 1e-10);
}

TEST(StuckCore, is_off_by_its_error_at_most) {
  const model::RobotSpec spec = holdfast::test::family_spec("growth", 300);
  const auto core = StuckCore::make(spec, first_modules(300, 300), solver::Precision::kSingle);
  ASSERT_TRUE(core);
  std::vector<Vec6<double>> loads(300);
  loads[299] = {1, 2, -3, 40, 50, 60};
  const auto system = solver::make_linear_system(
      core->robot(), {.method = solver::Method::kDirect, .thread_count = 1});
  system->set_law({});
  system->set_loads(model::Loads(loads));
  ASSERT_EQ(system->solve(0), solver::LinearOutcome::kSolved);
  const auto exact = system->displacement();
  // As K u* = f, the works differ by f (u - u*) = u* K (u - u*) <= |u*| |u - u*|.
  for (const double tolerance : {1e-1, 1e-2, 1e-3}) {
    const auto answer = core->answer(loads, tolerance);
    ASSERT_TRUE(answer);
    const double norm = std::sqrt(work_of(loads, exact));
    EXPECT_LE(std::abs(work_of(loads, answer->displacement) - norm * norm), norm * answer->error)
        << tolerance;
    EXPECT_LE(answer->error, 10 * tolerance * norm) << tolerance;
  }
}

TEST(StuckCore, is_none_of_modules_that_are_no_robot) {
  const model::RobotSpec spec{.existing = {{0, 0, 0}, {0, 0, 1}, {0, 0, 2}}};
  ElementSet apart(3);
  apart.insert(0);
  apart.insert(2);
  EXPECT_FALSE(StuckCore::make(spec, apart, solver::Precision::kSingle));
}

}  // namespace
}  // namespace holdfast::plan
