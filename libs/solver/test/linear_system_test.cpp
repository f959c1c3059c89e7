// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
//
// A robot's linear equations, behind the one interface that both solvers have: any loads on any
// contact states against a dense solution that shares no code with them (dense_reference.hpp).
#include "holdfast/solver/linear_system.hpp"

#include <gtest/gtest.h>

#include <random>

#include "dense_reference.hpp"
#include "holdfast/model/families.hpp"
#include "holdfast/solver/equilibrium.hpp"

namespace holdfast::solver {
namespace {

using base::Vec6;
using mechanics::ContactLaw;
using mechanics::ContactState;

/// Rounding times the condition number of some dozen beams.
constexpr double kDirectTolerance = 1e-9;

/// Multigrid's error is asked for in the energy norm; of so small a robot it is about as small a
/// share of the largest displacement.
constexpr double kAskedTolerance = 1e-9;
constexpr double kMultigridTolerance = 1e-6;

/// A table of two feet with an arm that juts out and one module fixed to something: 14 modules.
model::Robot table() {
  return model::Robot::create({.existing = {{0, 0, 0},
                                            {0, 0, 1},
                                            {0, 0, 2},
                                            {1, 0, 2},
                                            {2, 0, 2},
                                            {2, 0, 1},
                                            {2, 0, 0},
                                            {2, 1, 0},
                                            {3, 0, 2},
                                            {4, 0, 2},
                                            {1, 1, 2},
                                            {1, 2, 2},
                                            {1, 2, 1},
                                            {1, 2, 0}}})
      .value();
}

/// Forces and torques on all modules, of a size at which both move them alike.
model::Loads random_loads(std::size_t count, std::uint32_t seed) {
  std::mt19937 random(seed);
  std::vector<Vec6<double>> loads(count);
  for (Vec6<double>& load : loads) {
    for (std::size_t k = 0; k < 6; ++k) {
      load[k] = (static_cast<double>(random()) / 2147483648.0 - 1) * (k < 3 ? 1 : 40);
    }
  }
  return model::Loads(std::move(loads));
}

/// One facet stuck, one on an edge, one on a corner and slipping, one open and slipping.
void put_into_states(LinearSystem& system) {
  ASSERT_EQ(system.facets().size(), 4U);
  system.set_law({.law = ContactLaw::kUnilateral, .gamma = 1e-3});
  EXPECT_TRUE(system.set_facet(1, {.pressed = true, .tilt_x = 1}, true));
  EXPECT_TRUE(system.set_facet(2, {.pressed = true, .tilt_x = -1, .tilt_y = 1}, false));
  EXPECT_TRUE(system.set_facet(3, {.pressed = false}, false));
  EXPECT_FALSE(system.set_facet(3, {.pressed = false}, false));
}

std::vector<Vec6<double>> dense_solution(const LinearSystem& system, const model::Loads& loads) {
  return test::dense_displacement(system.robot(), loads, [&](std::size_t module) {
    const auto facet = std::ranges::find(system.facets(), module, &FacetState::module);
    return test::unilateral_tangent(system.robot().material(), 1e-3, facet->state, facet->is_held);
  });
}

TEST(LinearSystem, of_either_method_solves_like_a_dense_matrix_for_several_loads) {
  const model::Robot robot = table();
  const model::Loads loads[] = {random_loads(robot.modules().size(), 1),
                                model::weight_loads(robot.material()),
                                random_loads(robot.modules().size(), 2)};
  for (const Method method : {Method::kDirect, Method::kMultigrid}) {
    const auto system = make_linear_system(robot, {.method = method});
    ASSERT_TRUE(system);
    put_into_states(*system);
    const auto found = system->solve_each(loads, kAskedTolerance);
    ASSERT_TRUE(found);
    ASSERT_EQ(found->size(), std::size(loads));
    for (std::size_t i = 0; i < std::size(loads); ++i) {
      const auto exact = dense_solution(*system, loads[i]);
      EXPECT_LE(
          test::largest_difference((*found)[i], exact),
          (system->is_exact() ? kDirectTolerance : kMultigridTolerance) * test::largest(exact))
          << i;
    }
  }
}

/// Several at once read the factors once, and do the same arithmetic.
TEST(LinearSystem, solved_directly_has_the_same_bits_for_several_loads_as_one_by_one) {
  const model::Robot robot = table();
  const model::Loads loads[] = {random_loads(robot.modules().size(), 3),
                                random_loads(robot.modules().size(), 4)};
  const auto system = make_linear_system(robot, {.method = Method::kDirect});
  put_into_states(*system);
  const auto together = system->solve_each(loads, 0);
  ASSERT_TRUE(together);
  for (std::size_t i = 0; i < std::size(loads); ++i) {
    system->set_loads(loads[i]);
    ASSERT_EQ(system->solve(0), LinearOutcome::kSolved);
    EXPECT_EQ(system->displacement(), (*together)[i]);
  }
}

/// K is symmetric where the contact is, so u_a . f_b = u_b . f_a [Betti 1872].
TEST(LinearSystem, is_reciprocal_on_a_robot_with_runs_and_hanging_trees) {
  const model::Robot robot =
      model::Robot::create({.existing = model::family_cells(model::Family::kScaffold, 9)}).value();
  const std::size_t count = robot.modules().size();
  const model::Loads loads[] = {random_loads(count, 5), random_loads(count, 6)};
  const auto system =
      make_linear_system(robot, {.method = Method::kMultigrid, .precision = Precision::kDouble});
  system->set_law({.law = ContactLaw::kUnilateral, .gamma = 1e-3});
  const auto u = system->solve_each(loads, 1e-12);
  ASSERT_TRUE(u);
  double work[2] = {0, 0};
  for (std::size_t i = 0; i < count; ++i) {
    work[0] += base::dot((*u)[0][i], loads[1][i]);
    work[1] += base::dot((*u)[1][i], loads[0][i]);
  }
  EXPECT_NEAR(work[0], work[1], 1e-9 * std::abs(work[0]));
}

/// Superposition, for what is on fixed modules, too: it means nothing.
TEST(LinearSystem, doubles_its_displacements_with_the_loads) {
  const model::Robot robot =
      model::Robot::create({.existing = {{0, 0, 0}, {1, 0, 0}, {1, 0, 1}}, .fixed = {{0, 0, 0}}})
          .value();
  const Vec6<double> load = {1, 2, -3, 40, 50, 60};
  Vec6<double> twice = load;
  for (double& component : twice) {
    component *= 2;
  }
  const model::Loads loads[] = {model::Loads(load), model::Loads(twice)};
  const auto system = make_linear_system(robot, {});
  system->set_law({});
  const auto u = system->solve_each(loads, 0);
  ASSERT_TRUE(u);
  EXPECT_EQ((*u)[0][0], Vec6<double>{});
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t k = 0; k < 6; ++k) {
      EXPECT_EQ((*u)[1][i][k], 2 * (*u)[0][i][k]);  // A factor of two rounds nothing.
    }
  }
}

/// What a system has been asked before does not show: loads change on a module or two, and it comes
/// nearer to some of them only.
TEST(LinearSystem, goes_on_from_loads_that_change_to_the_solution_of_the_last) {
  const model::Robot robots[] = {
      table(),
      model::Robot::create({.existing = model::family_cells(model::Family::kScaffold, 9)}).value(),
      model::Robot::create({.existing = model::family_cells(model::Family::kCube, 7)}).value()};
  for (const model::Robot& robot : robots) {
    const std::size_t count = robot.modules().size();
    for (const Method method : {Method::kDirect, Method::kMultigrid}) {
      const auto system = make_linear_system(robot, {.method = method});
      ASSERT_TRUE(system);
      system->set_law({});
      const model::Loads all = random_loads(count, 7);
      std::vector<Vec6<double>> loads;
      for (std::size_t i = 0; i < count; ++i) {
        loads.push_back(all[i]);
      }
      system->set_loads(model::Loads(loads));
      ASSERT_EQ(system->solve(kAskedTolerance), LinearOutcome::kSolved);
      for (std::size_t change = 0; change < 30; ++change) {
        loads[7 * change % count][change % 6] += 3;
        loads[11 * change % count] = {};
        system->change_loads(model::Loads(loads));
        if (change % 3 != 0) {
          ASSERT_EQ(system->approach(), LinearOutcome::kSolved);
        }
      }
      ASSERT_EQ(system->solve(kAskedTolerance), LinearOutcome::kSolved);
      const auto found = system->displacement();
      const auto fresh = make_linear_system(robot, {.method = Method::kDirect});
      fresh->set_law({});
      fresh->set_loads(model::Loads(loads));
      ASSERT_EQ(fresh->solve(0), LinearOutcome::kSolved);
      const auto exact = fresh->displacement();
      EXPECT_LE(
          test::largest_difference(found, exact),
          (system->is_exact() ? kDirectTolerance : kMultigridTolerance) * test::largest(exact))
          << count;
    }
  }
}

/// The steps alone approach it: each of them leaves less than a third of what is missing.
TEST(LinearSystem, approaches_the_solution_step_by_step) {
  const model::Robot robot =
      model::Robot::create({.existing = model::family_cells(model::Family::kCube, 7)}).value();
  const auto direct = make_linear_system(robot, {.method = Method::kDirect});
  const auto system = make_linear_system(robot, {.method = Method::kMultigrid});
  for (LinearSystem* each : {direct.get(), system.get()}) {
    each->set_law({});
    each->set_loads(random_loads(robot.modules().size(), 8));
  }
  ASSERT_EQ(direct->approach(), LinearOutcome::kSolved);
  const auto exact = direct->displacement();
  double before = test::largest(exact);
  for (int step = 0; step < 8; ++step) {
    ASSERT_EQ(system->approach(), LinearOutcome::kSolved);
    const double now = test::largest_difference(system->displacement(), exact);
    EXPECT_LE(now, before / 3) << step;
    before = now;
  }
  EXPECT_EQ(system->report().iteration_count, 8);
}

TEST(LinearSystem, says_what_it_did) {
  const model::Robot robot = table();
  const auto system = make_linear_system(robot, {.method = Method::kDirect});
  put_into_states(*system);
  ASSERT_EQ(system->solve(0), LinearOutcome::kSolved);
  EXPECT_EQ(system->report().made_column_count, robot.modules().size());
  EXPECT_EQ(system->report().solve_count, 1);
  ASSERT_EQ(system->solve(0), LinearOutcome::kSolved);
  EXPECT_EQ(system->report().made_column_count, robot.modules().size());  // Nothing was new.
  const auto multigrid = make_linear_system(robot, {.method = Method::kMultigrid});
  put_into_states(*multigrid);
  ASSERT_EQ(multigrid->solve(1e-3), LinearOutcome::kSolved);
  ASSERT_EQ(multigrid->solve(1e-6), LinearOutcome::kSolved);
  EXPECT_EQ(multigrid->report().solve_count, 1);  // The second went on with the first.
  EXPECT_EQ(multigrid->report().method, Method::kMultigrid);
}

/// Nothing holds a module whose facet is open, without weak springs.
TEST(LinearSystem, says_when_it_is_singular) {
  const model::Robot robot = model::Robot::create({.existing = {{0, 0, 0}}}).value();
  for (const Method method : {Method::kDirect, Method::kMultigrid}) {
    const auto system = make_linear_system(robot, {.method = method});
    system->set_law({.law = ContactLaw::kUnilateral, .gamma = 0});
    system->set_facet(0, {.pressed = false}, false);
    EXPECT_EQ(system->solve(1e-6), LinearOutcome::kSingular);
    system->set_facet(0, {}, true);  // And is none the worse for it.
    EXPECT_EQ(system->solve(1e-6), LinearOutcome::kSolved);
  }
}

}  // namespace
}  // namespace holdfast::solver
