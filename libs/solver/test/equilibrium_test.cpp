// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
//
// Equilibrium of whole robots against closed forms: the column, the cantilever (the beams are
// exact, so the sums over point loads of Euler and Bernoulli hold without any error of
// discretisation) and two modules on one foot; and the outcomes. Tolerance, unless stated
// otherwise: 1e-9 relative, rounding times the condition number of some dozen beams.
#include "holdfast/solver/equilibrium.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "holdfast/mechanics/connector.hpp"

namespace holdfast::solver {
namespace {

using base::Cell;
using base::Direction;
using base::Vec6;
using mechanics::ContactLaw;
using mechanics::ContactState;
using model::Material;
using model::Robot;
using model::RobotSpec;

constexpr double kEquilibriumTolerance = 1e-9;
constexpr ContactLaw kLaws[] = {ContactLaw::kRegularised, ContactLaw::kUnilateral};
constexpr Direction kLateral[] = {Direction::kPlusX, Direction::kMinusX, Direction::kPlusY,
                                  Direction::kMinusY};

Robot made(const RobotSpec& spec) {
  auto robot = Robot::create(spec);
  EXPECT_TRUE(robot.has_value()) << robot.error().message;
  return std::move(robot).value();
}

/// `count` cells in a row from `first`.
std::vector<Cell> row(Cell first, Direction direction, int count) {
  std::vector<Cell> cells;
  for (int i = 0; i < count; ++i) {
    cells.push_back(first);
    first = base::neighbour(first, direction);
  }
  return cells;
}

Material lopsided() {
  Material material;
  material.moment_x_mm4 = 150'000;
  material.moment_y_mm4 = 400'000;
  material.facet_mm = 30;
  return material;
}

Equilibrium settle(const Robot& robot, const ContactOptions& contact = {}) {
  Equilibrium result = EquilibriumSolver(robot).solve(contact);
  EXPECT_EQ(result.outcome, Outcome::kSettled);
  return result;
}

/// Eq. (16) for the connection between the modules i and i + 1 of a row.
Vec6<double> middle(const Robot& robot, const Equilibrium& result, Direction direction,
                    std::size_t i) {
  return mechanics::middle_force(mechanics::beam_stiffness(model::beam_section(robot.material())),
                                 direction, result.displacement[i], result.displacement[i + 1]);
}

TEST(Equilibrium, of_a_standing_column_carries_the_weight_above_each_connection) {
  const std::size_t n = 12;
  const Robot robot = made({.existing = row({}, Direction::kPlusZ, 12), .fixed = {{0, 0, 0}}});
  const Equilibrium result = settle(robot);
  const double weight = model::module_weight_n(robot.material());
  double settlement = 0;
  for (std::size_t i = 0; i + 1 < n; ++i) {
    const double above = static_cast<double>(n - 1 - i) * weight;
    EXPECT_NEAR(middle(robot, result, Direction::kPlusZ, i)[2], -above,
                kEquilibriumTolerance * above);
    settlement -= above * 40 / (100.0 * 1600);  // N L / (E A)
    EXPECT_NEAR(result.displacement[i + 1][2], settlement, -kEquilibriumTolerance * settlement);
  }
  EXPECT_EQ(result.displacement[0], Vec6<double>{});
}

TEST(Equilibrium, of_a_hanging_column_pulls_with_the_weight_below_each_connection) {
  const Robot robot =
      made({.existing = row({0, 0, 9}, Direction::kMinusZ, 5), .fixed = {{0, 0, 9}}});
  const Equilibrium result = settle(robot);
  const double weight = model::module_weight_n(robot.material());
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_NEAR(middle(robot, result, Direction::kMinusZ, i)[2],
                static_cast<double>(4 - i) * weight, kEquilibriumTolerance * weight);
  }
}

/// One more beam, to the ground: all n modules press on it.
TEST(Equilibrium, of_a_free_column_settles_on_the_ground_too) {
  const int n = 7;
  const Robot robot = made({.existing = row({}, Direction::kPlusZ, n)});
  const double weight = model::module_weight_n(robot.material());
  for (const ContactLaw law : kLaws) {
    const Equilibrium result = settle(robot, {.law = law});
    double settlement = 0;
    for (int i = 0; i < n; ++i) {
      settlement -= (n - i) * weight * 40 / (100.0 * 1600);
      EXPECT_NEAR(result.displacement[static_cast<std::size_t>(i)][2], settlement,
                  -kEquilibriumTolerance * settlement);
    }
    EXPECT_EQ(result.contact[0], mechanics::kStuck);
    EXPECT_EQ(result.contact.size(), 1U);
    EXPECT_NEAR(ground_forces(robot, result)[0][2], n * weight, kEquilibriumTolerance * weight);
    EXPECT_EQ(result.steps, 1);
  }
}

/// Loads W at a_j = j L from the clamp: at x = (n - 1) L the sum of W a^2 (3x - a) / (6 E Ix). In
/// the middle of connection i the levers are (j - i - 1/2) L.
TEST(Equilibrium, of_a_cantilever_is_that_of_euler_and_bernoulli) {
  const int n = 9;
  for (const Direction direction : kLateral) {
    const Robot robot = made(
        {.existing = row({0, 0, 1}, direction, n), .fixed = {{0, 0, 1}}, .material = lopsided()});
    const Equilibrium result = settle(robot);
    const double weight = model::module_weight_n(robot.material());
    const double tip = (n - 1) * 40;
    double deflection = 0;
    for (int j = 1; j < n; ++j) {
      const double a = j * 40;
      deflection -= weight * a * a * (3 * tip - a) / (6 * 100.0 * 150'000);
    }
    EXPECT_NEAR(result.displacement.back()[2], deflection, -kEquilibriumTolerance * deflection);
    for (int i = 0; i + 1 < n; ++i) {
      double bending = 0;
      for (int j = i + 1; j < n; ++j) {
        bending += weight * (j - i - 0.5) * 40;
      }
      const auto force = middle(robot, result, direction, static_cast<std::size_t>(i));
      const auto load = mechanics::connection_load(force);
      EXPECT_NEAR(load.bending, bending, kEquilibriumTolerance * n * n * 40 * weight);
      EXPECT_NEAR(load.axial, 0, kEquilibriumTolerance * n * weight);
      EXPECT_NEAR(std::hypot(force[0], force[1]), (n - 1 - i) * weight,
                  kEquilibriumTolerance * n * weight);
    }
  }
}

/// The arms of Fig. 6 #4a and #1a: four and three modules beyond the worst connection; the ratio
/// by hand is 2 k^2 W / Fmax, and 0.6402 and 0.3601 are the published reference (four digits).
TEST(Equilibrium, of_the_published_arms_loads_them_as_published) {
  for (const auto& [overhang, ratio] : {std::pair{4, 0.6402}, {3, 0.3601}}) {
    const Robot robot =
        made({.existing = row({0, 0, 1}, Direction::kPlusX, overhang + 1), .fixed = {{0, 0, 1}}});
    const auto load =
        mechanics::connection_load(middle(robot, settle(robot), Direction::kPlusX, 0));
    const double found = mechanics::load_ratio(load, 40.0, 14.97);
    EXPECT_NEAR(found, overhang * overhang * model::module_weight_n(robot.material()) / 14.97,
                kEquilibriumTolerance);
    EXPECT_NEAR(found, ratio, 5e-5);
  }
}

/// A foot, a module on it and an arm of `reach` modules beside that, all of weight W. Their weight
/// acts (1 + ... + reach) / (reach + 2) pitches off the foot: 13.3 mm for 1, within the facet of 40
/// mm; 30 mm for 2, beyond its edge at 20 mm. The ground carries the weight and, at the foot's
/// node, its torque.
TEST(Equilibrium, of_an_arm_on_one_foot_presses_what_the_weight_lies_over) {
  for (const ContactLaw law : kLaws) {
    for (const Direction direction : kLateral) {
      for (const int reach : {1, 2}) {
        RobotSpec spec = {.existing = row({0, 0, 1}, direction, reach + 1)};
        spec.existing.insert(spec.existing.begin(), Cell{0, 0, 0});
        const Robot robot = made(spec);
        const Equilibrium result = settle(robot, {.law = law});
        const Cell q = base::neighbour({}, direction);
        const ContactState tips = {.tilt_x = static_cast<std::int8_t>(-q.y),
                                   .tilt_y = static_cast<std::int8_t>(q.x)};
        EXPECT_EQ(result.contact[0], reach == 1 ? mechanics::kStuck : tips);
        const double weight = model::module_weight_n(robot.material());
        const double torque = weight * 40 * reach * (reach + 1) / 2;
        const Vec6<double> expected = {0, 0, (reach + 2) * weight, q.y * torque, -q.x * torque, 0};
        for (std::size_t i = 0; i < 6; ++i) {
          // Springs of 1e-4 hold a robot that tips: as many digits are lost.
          EXPECT_NEAR(ground_forces(robot, result)[0][i], expected[i],
                      1e4 * kEquilibriumTolerance * torque);
        }
      }
    }
  }
}

TEST(Equilibrium, is_none_for_modules_that_are_all_fixed) {
  const Robot robot = made({.existing = {{0, 0, 0}, {1, 0, 0}}, .fixed = {{0, 0, 0}, {1, 0, 0}}});
  for (const ContactLaw law : kLaws) {
    const Equilibrium result = settle(robot, {.law = law});
    EXPECT_EQ(result.displacement, std::vector<Vec6<double>>(2));
    EXPECT_EQ(ground_forces(robot, result), std::vector<Vec6<double>>(2));
  }
}

TEST(Equilibrium, does_not_depend_on_what_is_planned_and_what_exists) {
  const std::vector<Cell> cells = {{0, 0, 0}, {0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {1, 0, 0}};
  const Robot whole = made({.existing = cells});
  const Robot planned = made({.existing = {cells.begin(), cells.begin() + 2},
                              .planned = {cells.begin() + 2, cells.end()}});
  EXPECT_EQ(settle(whole).displacement, settle(planned).displacement);
}

TEST(Equilibrium, says_when_the_factorization_does_not_fit) {
  const Robot robot = made({.existing = row({}, Direction::kPlusX, 3)});
  // Three nodes of 984 bytes, two edges of 352; a row makes two blocks of 600 bytes of them.
  EquilibriumSolver fits(robot, {.memory_bytes_max = 4856});
  EXPECT_EQ(fits.solve({}).outcome, Outcome::kSettled);
  EquilibriumSolver exceeds(robot, {.memory_bytes_max = 4855});
  const Equilibrium result = exceeds.solve({});
  EXPECT_EQ(result.outcome, Outcome::kTooLarge);
  EXPECT_TRUE(result.displacement.empty());
}

/// A tipping robot needs a second step, for the state that the first one found.
TEST(Equilibrium, says_when_the_steps_do_not_suffice) {
  const Robot robot = made({.existing = {{0, 0, 0}, {0, 0, 1}, {1, 0, 1}, {2, 0, 1}}});
  for (const ContactLaw law : kLaws) {
    EXPECT_EQ(EquilibriumSolver(robot, {.step_count_max = 1}).solve({.law = law}).outcome,
              Outcome::kNotSettled);
    EXPECT_EQ(EquilibriumSolver(robot, {.step_count_max = 2}).solve({.law = law}).outcome,
              Outcome::kSettled);
  }
}

}  // namespace
}  // namespace holdfast::solver
