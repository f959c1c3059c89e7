// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
//
// Buckling factors against Euler and Greenhill (theory of elastic stability), against all
// eigenvalues of K and K_G by Eigen, and their invariances; second-order displacements against the
// shortening of an arm.
#include "holdfast/solver/second_order.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <numbers>

#include "factorization/stressed_beams.hpp"
#include "general_robot.hpp"
#include "holdfast/base/rng.hpp"
#include "holdfast/solver/equilibrium.hpp"
#include "second_order/subspace.hpp"
#include "second_order/tree_bound.hpp"
#include "seeds.hpp"

namespace holdfast::solver {
namespace {

constexpr SecondOrderOptions kFactor = {.is_factor_wanted = true};
constexpr double kNoWeight = 1e-9;

model::RobotSpec column(std::int32_t count) {
  model::RobotSpec spec{.fixed = {{0, 0, 0}}};
  for (std::int32_t z = 0; z <= count; ++z) {
    spec.existing.push_back({0, 0, z});
  }
  return spec;
}

struct Solved {
  Equilibrium equilibrium;
  SecondOrder second;
};

Solved solved(const model::RobotSpec& spec, const SecondOrderOptions& options = kFactor,
              const EquilibriumOptions& how = {}) {
  const auto robot = model::Robot::create(spec);
  EXPECT_TRUE(robot) << robot.error().message;
  EquilibriumSolver solver(robot.value(), how);
  Solved result{solver.solve({.law = mechanics::ContactLaw::kUnilateral, .gamma = 1e-9}), {}};
  EXPECT_EQ(result.equilibrium.outcome, Outcome::kSettled);
  result.second = solver.find_second_order(result.equilibrium, options);
  return result;
}

double factor_of(const model::RobotSpec& spec) {
  const Buckling buckling = solved(spec).second.buckling;
  EXPECT_EQ(buckling.answer, BucklingAnswer::kFactor);
  return buckling.factor;
}

/// E I of one module's beams, and its weight.
double stiffness_nmm2(const model::Material& m) { return m.elastic_modulus_mpa * m.moment_x_mm4; }

/// Euler's cantilever, pi^2 E I / (4 l^2). Hermite's cubics converge with the fourth power of the
/// number of elements; 32 of them are within 8e-9.
TEST(BucklingFactor, is_eulers_of_a_column_that_is_fixed_at_its_foot) {
  model::RobotSpec spec = column(32);
  spec.gravity_m_s2 = {0, 0, -kNoWeight};
  spec.payloads = {{.cell = {0, 0, 32}, .force_n = {0, 0, -2.5}}};
  const double length = 32 * spec.material.pitch_mm;
  const double euler =
      std::numbers::pi * std::numbers::pi * stiffness_nmm2(spec.material) / (4 * length * length);
  EXPECT_NEAR(2.5 * factor_of(spec) / euler, 1, 2e-8);
}

/// One beam, whose determinant is a polynomial: with p = P l^2 / (E I),
/// (12 - 6p/5)(4 - 2p/15) - (6 - p/10)^2 = 3p^2/20 - 26p/5 + 12 = 0.
TEST(BucklingFactor, is_that_of_hermites_cubics_with_one_beam) {
  model::RobotSpec spec = column(1);
  spec.gravity_m_s2 = {0, 0, -kNoWeight};
  spec.payloads = {{.cell = {0, 0, 1}, .force_n = {0, 0, -1}}};
  const double p = (5.2 - std::sqrt(5.2 * 5.2 - 4 * 0.15 * 12)) / (2 * 0.15);
  const double length = spec.material.pitch_mm;
  EXPECT_NEAR(factor_of(spec) * length * length / stiffness_nmm2(spec.material), p, 1e-8);
}

/// A column that is held in the middle of its length and pressed at both ends buckles as each of
/// its halves does: two modes with the same factor.
TEST(BucklingFactor, is_that_of_one_half_of_a_column_that_is_fixed_in_its_middle) {
  model::RobotSpec spec;
  for (std::int32_t z = -16; z <= 16; ++z) {
    spec.existing.push_back({0, 0, z});
  }
  spec.fixed = {{0, 0, 0}};
  spec.support_z = {};
  spec.gravity_m_s2 = {0, 0, -kNoWeight};
  spec.payloads = {{.cell = {0, 0, 16}, .force_n = {0, 0, -1}},
                   {.cell = {0, 0, -16}, .force_n = {0, 0, 1}}};
  const double length = 16 * spec.material.pitch_mm;
  const double euler =
      std::numbers::pi * std::numbers::pi * stiffness_nmm2(spec.material) / (4 * length * length);
  EXPECT_NEAR(factor_of(spec) / euler, 1, 3e-7);
}

/// Greenhill's column: q l^3 / (E I) = 7.837347. Masses at the nodes, half of one at the top, are
/// the trapezoidal rule: second order.
TEST(BucklingFactor, is_greenhills_of_a_tower_under_its_own_weight) {
  const auto normalised = [](std::int32_t count) {
    model::RobotSpec spec = column(count);
    const model::Material& m = spec.material;
    spec.own_masses = {{.cell = {0, 0, count}, .mass_kg = m.mass_kg / 2}};
    const double length = count * m.pitch_mm;
    const double q = model::module_weight_n(m) / m.pitch_mm;
    return factor_of(spec) * q * length * length * length / stiffness_nmm2(m);
  };
  const double coarse = normalised(32);
  const double fine = normalised(64);
  EXPECT_NEAR(fine, 7.837347, 1e-3);
  EXPECT_NEAR(fine + (fine - coarse) / 3, 7.837347, 2e-6);
}

TEST(BucklingFactor, does_not_exist_where_nothing_is_pressed) {
  model::RobotSpec spec = column(5);
  spec.fixed = {{0, 0, 5}};
  spec.support_z = {};
  EXPECT_EQ(solved(spec).second.buckling.answer, BucklingAnswer::kNone);
  EXPECT_EQ(solved(spec, {}).second.buckling.answer, BucklingAnswer::kAbove);
}

/// Whether it is above ten is decided by one factorization; and below, the factor is found.
TEST(BucklingFactor, is_sought_only_where_it_is_below_the_bound) {
  const model::RobotSpec spec = column(20);
  const double factor = factor_of(spec);
  const auto answer = [&](double bound) {
    return solved(spec, {.factor_max = bound}).second.buckling;
  };
  EXPECT_EQ(answer(factor * (1 - 1e-9)).answer, BucklingAnswer::kAbove);
  EXPECT_EQ(answer(factor * (1 + 1e-9)).answer, BucklingAnswer::kFactor);
  EXPECT_NEAR(answer(factor * 2).factor / factor, 1, 1e-10);
}

/// A column with a load on its end: the bound's sum is P l^2 / (2 k_psi L) where Euler has
/// 4 P l^2 / (pi^2 E I), 0.81 of it, torsion is softer than bending, 0.65, and of one beam the
/// products with shear are as large.
TEST(BucklingFactor, is_bounded_from_below_without_a_factorization) {
  for (const std::int32_t count : {1, 4, 16, 64}) {
    model::RobotSpec spec = column(count);
    spec.gravity_m_s2 = {0, 0, -kNoWeight};
    spec.payloads = {{.cell = {0, 0, count}, .force_n = {0, 0, -2.5}}};
    const double factor = factor_of(spec);
    const auto robot = model::Robot::create(spec);
    ASSERT_TRUE(robot);
    const auto system = make_linear_system(robot.value(), {});
    system->set_law({.law = mechanics::ContactLaw::kUnilateral, .gamma = 0});
    ASSERT_EQ(system->solve(0), LinearOutcome::kSolved);
    const auto displacement = system->displacement();
    const double bound = buckling_factor_at_least(StressedBeams(*system, displacement, 1));
    EXPECT_LE(bound, factor) << count;
    EXPECT_GE(bound, 0.25 * factor) << count;
  }
}

/// All eigenvalues, of matrices made column by column.
double dense_factor(const model::Robot& robot, const Equilibrium& equilibrium,
                    LinearSystem& system) {
  StressedBeams beams(system, equilibrium.displacement, 1);
  std::vector<std::size_t> free;
  for (std::size_t i = 0; i < robot.modules().size(); ++i) {
    if (robot.modules()[i].support != model::Support::kFixed) {
      free.push_back(i);
    }
  }
  const auto size = static_cast<Eigen::Index>(6 * free.size());
  Eigen::MatrixXd k(size, size);
  Eigen::MatrixXd soft(size, size);
  for (Eigen::Index column = 0; column < size; ++column) {
    std::vector<base::Vec6<double>> x(robot.modules().size());
    x[free[static_cast<std::size_t>(column / 6)]][static_cast<std::size_t>(column % 6)] = 1;
    const auto forces = beams.stiffness_times(x);
    const auto softening = beams.softening(x);
    for (Eigen::Index row = 0; row < size; ++row) {
      const std::size_t module = free[static_cast<std::size_t>(row / 6)];
      k(row, column) = forces[module][static_cast<std::size_t>(row % 6)];
      soft(row, column) = softening[module][static_cast<std::size_t>(row % 6)];
    }
  }
  EXPECT_LT((soft - soft.transpose()).norm(), 1e-9 * soft.norm() + 1e-15);
  const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd> solver(
      (soft + soft.transpose()) / 2, (k + k.transpose()) / 2, Eigen::EigenvaluesOnly);
  return 1 / solver.eigenvalues()(size - 1);
}

TEST(BucklingFactor, is_the_least_of_all_eigenvalues) {
  int compared = 0;
  int bounded = 0;
  for (const base::Lattice& lattice : test::kLattices) {
    for (std::uint64_t seed = 0; seed < test::campaign(40U); ++seed) {
      const auto robot = model::Robot::create(test::general_robot(lattice, seed));
      ASSERT_TRUE(robot);
      EquilibriumSolver solver(robot.value());
      const Equilibrium found =
          solver.solve({.law = mechanics::ContactLaw::kUnilateral, .gamma = 1e-9});
      if (found.outcome != Outcome::kSettled || found.gamma > 0 ||
          robot.value().connections().size() == 0) {
        continue;
      }
      const SecondOrder second = solver.find_second_order(found, kFactor);
      if (second.buckling.answer == BucklingAnswer::kNoStiffness) {
        continue;
      }
      const auto system = make_linear_system(robot.value(), {});
      system->set_law({.law = mechanics::ContactLaw::kUnilateral, .gamma = 0});
      for (std::size_t i = 0; i < found.contact.size(); ++i) {
        system->set_facet(i, found.contact[i], found.contact[i].pressed);
      }
      const double dense = dense_factor(robot.value(), found, *system);
      ++compared;
      const double bound = buckling_factor_at_least(StressedBeams(*system, found.displacement, 1));
      bounded += bound > 0 ? 1 : 0;
      EXPECT_TRUE(dense < 0 || bound <= dense * (1 + 1e-9)) << bound << " " << dense;
      if (second.buckling.answer == BucklingAnswer::kFactor) {
        EXPECT_NEAR(second.buckling.factor / dense, 1, 1e-7) << seed;
      } else {
        EXPECT_EQ(second.buckling.answer, BucklingAnswer::kNone);
        EXPECT_TRUE(dense < 0 || dense > 1e10) << dense;
      }
    }
  }
  EXPECT_GE(compared, static_cast<int>(test::least(60U)));
  EXPECT_GE(6 * bounded, compared);
}

/// Under weight alone forces do not depend on E, and K is proportional to it.
TEST(BucklingFactor, is_proportional_to_the_elastic_modulus) {
  model::RobotSpec spec = column(12);
  spec.existing.push_back({1, 0, 12});
  const double factor = factor_of(spec);
  spec.material.elastic_modulus_mpa *= 10;
  EXPECT_NEAR(factor_of(spec) / factor, 10, 1e-6);
}

TEST(BucklingFactor, does_not_depend_on_how_the_robot_lies) {
  for (const base::Lattice& lattice : test::kLattices) {
    for (std::uint64_t seed = 0; seed < 3; ++seed) {
      const model::RobotSpec spec = test::general_robot(lattice, seed);
      const auto robot = model::Robot::create(spec);
      ASSERT_TRUE(robot);
      const Solved one = solved(spec);
      for (const test::Symmetry& symmetry : test::symmetries(lattice)) {
        const Solved other = solved(test::turned(spec, symmetry));
        EXPECT_EQ(other.second.buckling.answer, one.second.buckling.answer);
        EXPECT_NEAR(other.second.buckling.factor, one.second.buckling.factor,
                    1e-6 * one.second.buckling.factor);
      }
    }
  }
}

/// Multigrid knows an upper bound, which is near where the factor is low.
TEST(BucklingFactor, is_bounded_from_above_by_iteration) {
  model::RobotSpec spec;
  for (std::int32_t z = 0; z < 40; ++z) {
    for (std::int32_t i = 0; i < 4; ++i) {
      spec.existing.push_back({i % 2, i / 2, z});
    }
  }
  const double factor = factor_of(spec);
  const Buckling bound =
      solved(spec, {.factor_max = 10 * factor}, {.method = Method::kMultigrid}).second.buckling;
  EXPECT_EQ(bound.answer, BucklingAnswer::kAtMost);
  EXPECT_GE(bound.factor, factor * (1 - 1e-6));
  EXPECT_LE(bound.factor, factor * 1.05);
}

/// A bent arm is shorter seen from above, by what its cubic's slope takes.
TEST(SecondOrderDisplacement, shortens_an_arm_by_what_its_bending_takes) {
  model::RobotSpec spec = column(1);
  spec.existing[1] = {1, 0, 0};
  spec.support_z = {};
  spec.material.section_area_mm2 = 1e10;  // Its length does not change.
  const Solved one = solved(spec);
  const model::Material& m = spec.material;
  // w' = W (L x - x^2 / 2) / (E I); half the integral of w'^2 is W^2 L^5 / (15 E^2 I^2).
  const double ratio = model::module_weight_n(m) / stiffness_nmm2(m);
  const double l = m.pitch_mm;
  const double expected = -ratio * ratio * l * l * l * l * l / 15;
  EXPECT_NEAR(one.second.displacement[1][0] / expected, 1, 1e-6);
}

TEST(LargestEigenpair, is_eigens) {
  base::Rng rng(7);
  for (Eigen::Index n = 1; n < 12; ++n) {
    Eigen::MatrixXd dense(n, n);
    std::vector<std::vector<double>> rows;
    for (Eigen::Index i = 0; i < n; ++i) {
      rows.emplace_back();
      for (Eigen::Index k = 0; k <= i; ++k) {
        dense(i, k) = dense(k, i) = static_cast<double>(rng.below(2001)) - 1000;
        rows.back().push_back(dense(i, k));
      }
    }
    const Eigenpair pair = largest_eigenpair(rows);
    const Eigen::VectorXd vector =
        Eigen::Map<const Eigen::VectorXd>(pair.vector.data(), static_cast<Eigen::Index>(n));
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(dense);
    EXPECT_NEAR(pair.value, solver.eigenvalues()(n - 1), 1e-9);
    EXPECT_LT((dense * vector - pair.value * vector).norm(), 1e-9);
    EXPECT_NEAR(vector.norm(), 1, 1e-12);
  }
}

}  // namespace
}  // namespace holdfast::solver
