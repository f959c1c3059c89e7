// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
// Cone programs of structures: their linear systems beside what they are to solve, bounds of the
// interior-point method beside closed forms and each other, on structures made of bodies and joints
// by hand; forces by statics alone.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "../src/program/interior_point.hpp"
#include "../src/program/kkt_system.hpp"
#include "../src/statics/determinate.hpp"

namespace holdfast::limit {
namespace {

using Eigen::VectorXd;

constexpr double kWeight = 0.6;
constexpr double kStep = 40;
constexpr std::array<Vector3, 3> kUpwards = {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};

const model::ConnectorLaw kLaw = {.strength_n = 12, .lever_mm = 20};

/// A joint half a step below body `a`, to body `b` or the ground.
Joint joint_below(std::int32_t a, std::int32_t b, const Vector3& centre,
                  const model::ConnectorLaw& law) {
  return {.a = a,
          .b = b,
          .place_mm = {centre[0], centre[1], centre[2] - kStep / 2},
          .frame = kUpwards,
          .law = law};
}

/// `count` bodies in a column, the first on the ground; `load` on each.
Structure column(int count, const model::ConnectorLaw& law, const base::Vec6<double>& load) {
  Structure structure{.length_mm = kStep};
  for (int i = 0; i < count; ++i) {
    structure.bodies.push_back({.centre_mm = {0, 0, kStep * i}, .load = load});
    structure.joints.push_back(
        joint_below(i, i == 0 ? Joint::kGround : i - 1, structure.bodies.back().centre_mm, law));
  }
  return structure;
}

ProgramBounds bounds_of(const Structure& structure, int thread_count = 1) {
  return maximise_factor(ConeProgram(structure, whole(structure)), {.thread_count = thread_count},
                         [] { return false; });
}

/// The interior point's tolerance.
void expect_factor(const Structure& structure, double factor) {
  const ProgramBounds bounds = bounds_of(structure);
  EXPECT_NEAR(bounds.low, factor, 1e-6 * factor);
  EXPECT_NEAR(bounds.high, factor, 1e-6 * factor);
  EXPECT_LE(bounds.low, bounds.high);
  EXPECT_LT(bounds.iteration_count, 30);
}

TEST(InteriorPoint, a_column_that_is_pulled_breaks_at_its_foot) {
  for (const int count : {1, 3, 20}) {
    expect_factor(column(count, kLaw, {0, 0, kWeight, 0, 0, 0}), 12 / (count * kWeight));
  }
}

// The moment at the foot: loads at heights of 1/2, 3/2, ... steps.
TEST(InteriorPoint, a_column_that_is_pushed_sideways_opens_at_its_foot) {
  for (const int count : {1, 4, 15}) {
    const double moment = kWeight * kStep * count * count / 2;
    expect_factor(column(count, kLaw, {kWeight, 0, 0, 0, 0, 0}), 12 * 20 / moment);
  }
}

TEST(InteriorPoint, shear_and_torsion_have_limits_of_their_own) {
  const model::ConnectorLaw law = {
      .strength_n = 1e3, .lever_mm = 1e3, .shear_strength_n = 3, .torsion_strength_nmm = 50};
  expect_factor(column(5, law, {0, kWeight, 0, 0, 0, 0}), 3 / (5 * kWeight));
  expect_factor(column(5, law, {0, 0, 0, 0, 0, 2}), 50 / (5 * 2.0));
}

/// Friction holds while V <= mu (strength - N); N < 0 is the compression by what is above.
TEST(InteriorPoint, a_stack_slips_where_friction_ends) {
  const model::ConnectorLaw contact = {.strength_n = 0, .lever_mm = 1e4, .friction = 0.4};
  // Loads grow together, so that a stack holds whatever its weight is, or nothing.
  const ProgramBounds holds = bounds_of(column(4, contact, {0.39, 0, -1, 0, 0, 0}));
  EXPECT_GE(holds.low, 0.999 * kFactorMax);
  const ProgramBounds slips = bounds_of(column(4, contact, {0.41, 0, -1, 0, 0, 0}));
  EXPECT_LT(slips.high, 1e-6);
}

/// Two feet share a load as strength allows, whatever their stiffness is: the sum of both.
TEST(InteriorPoint, joints_side_by_side_share_what_they_hold) {
  Structure structure{.length_mm = kStep};
  structure.bodies.push_back({.load = {0, 0, kWeight, 0, 0, 0}});
  for (const double x : {-10.0, 10.0}) {
    structure.joints.push_back(joint_below(0, Joint::kGround, {x, 0, 0}, kLaw));
  }
  expect_factor(structure, 2 * 12 / kWeight);
}

TEST(InteriorPoint, has_the_same_bits_on_all_threads) {
  const Structure structure = column(12, kLaw, {kWeight, 0.1, 0.2, 0, 0, 3});
  const ProgramBounds one = bounds_of(structure, 1);
  const ProgramBounds several = bounds_of(structure, 4);
  EXPECT_EQ(one.low, several.low);
  EXPECT_EQ(one.high, several.high);
  EXPECT_EQ(one.velocities, several.velocities);
}

/// The mechanism proves the upper bound: its factor times the loads' power is what joints take.
TEST(InteriorPoint, velocities_are_those_of_the_opening_joint) {
  const Structure structure = column(3, kLaw, {0, 0, kWeight, 0, 0, 0});
  const ProgramBounds bounds = bounds_of(structure);
  ASSERT_EQ(bounds.velocities.size(), 18);
  for (int body = 1; body < 3; ++body) {  // All rise together.
    EXPECT_NEAR(bounds.velocities[6 * body + 2] / bounds.velocities[2], 1, 1e-5);
  }
}

/// Points within the cones: centres and a little more.
VectorXd point_within(const KktSystem& system, std::mt19937_64& random, double share) {
  std::uniform_real_distribution<double> between(-1, 1);
  VectorXd u = system.centre();
  for (double& number : u) {
    number += share * between(random);
  }
  return 3 * u;
}

/// What solve() returns fulfils all three lines of the system, W from the scaled vectors.
TEST(KktSystem, solutions_fulfil_their_equations) {
  model::ConnectorLaw law = kLaw;
  law.bending = model::BendingLaw::kRound;
  law.shear_strength_n = 4;
  const Structure structure = column(6, law, {0.1, 0, kWeight, 0, 0, 0});
  const ConeProgram program(structure, whole(structure));
  KktSystem system(program, 1e-12, 1);
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> between(-1, 1);
  ASSERT_TRUE(system.factor(point_within(system, random, 0.4), point_within(system, random, 0.4)));
  const auto any = [&](Eigen::Index size) {
    return VectorXd::NullaryExpr(size, [&] { return between(random); }).eval();
  };
  const KktVector right_side = {.x = any(system.force_count()),
                                .y = any(program.loads.size()),
                                .z = any(system.centre().size())};
  const KktVector found = system.solve(right_side);
  EXPECT_LT((system.transposed_times(found.y, found.z) - right_side.x).lpNorm<Eigen::Infinity>(),
            1e-10);
  EXPECT_LT((system.balance(found.x) - right_side.y).lpNorm<Eigen::Infinity>(), 1e-10);
  EXPECT_LT((system.rows_times(found.x) - system.scaled(system.scaled(found.z)) - right_side.z)
                .lpNorm<Eigen::Infinity>(),
            1e-10);
}

/// (A x) . y and x . (A'y): the balance and its transpose are each other's.
TEST(KktSystem, balance_and_rows_are_transposed_to_prices) {
  const Structure structure = column(4, kLaw, {0.3, 0, kWeight, 0, 0, 0});
  const ConeProgram program(structure, whole(structure));
  const KktSystem system(program, 1e-12, 1);
  const VectorXd x = VectorXd::LinSpaced(system.force_count(), -1, 2);
  const VectorXd y = VectorXd::LinSpaced(program.loads.size(), 1, -3);
  const VectorXd z = VectorXd::LinSpaced(system.centre().size(), 0.5, 4);
  const double work = system.balance(x).dot(y) + system.rows_times(x).dot(z);
  EXPECT_NEAR(work, x.dot(system.transposed_times(y, z)), 1e-12 * std::abs(work));
}

TEST(KktSystem, points_outside_the_cones_are_not_factored) {
  const Structure structure = column(2, kLaw, {0, 0, kWeight, 0, 0, 0});
  const ConeProgram program(structure, whole(structure));
  KktSystem system(program, 1e-12, 1);
  VectorXd outside = system.centre();
  outside[0] = -1;
  EXPECT_FALSE(system.factor(outside, system.centre()));
  EXPECT_FALSE(system.factor(system.centre(), outside));
  EXPECT_GT(system.outside(outside).maxCoeff(), 0.9);
}

/// Each joint carries what stands above it, with its moment about the joint.
TEST(DeterminateForces, are_those_of_statics) {
  const Structure structure = column(4, kLaw, {0.2, 0, -kWeight, 0, 0, 0});
  const std::vector<base::Vec6<double>> known(structure.joints.size());
  const auto forces = determinate_forces(structure, known);
  ASSERT_EQ(forces.size(), 4);
  for (int i = 0; i < 4; ++i) {
    const int above = 4 - i;
    EXPECT_NEAR(forces[base::at(i)][2], -kWeight * above, 1e-12);
    EXPECT_NEAR(std::abs(forces[base::at(i)][0]), 0.2 * above, 1e-12);
    EXPECT_NEAR(std::abs(forces[base::at(i)][4]), 0.2 * kStep * above * above / 2, 1e-9);
  }
}

TEST(DeterminateForces, are_none_where_a_joint_would_carry_what_it_does_not) {
  Structure structure = column(3, kLaw, {0.2, 0, -kWeight, 0, 0, 0});
  structure.joints[1].carries = kCarriesForce;
  const std::vector<base::Vec6<double>> known(structure.joints.size());
  EXPECT_TRUE(determinate_forces(structure, known).empty());
  structure.joints[1].carries = kCarriesAll;
  structure.joints.erase(structure.joints.begin());  // No tree reaches the ground.
  EXPECT_TRUE(determinate_forces(structure, known).empty());
}

/// Rigid joints make one body of two: fewer groups, the same loads about their centre.
TEST(Part, joints_that_hold_join_bodies_to_groups) {
  const Structure structure = column(4, kLaw, {0.2, 0, -kWeight, 0, 0, 0});
  const Part part = with_rigid_groups(structure, {1, 0, 1, 0});
  ASSERT_EQ(part.centres.size(), 2);
  EXPECT_EQ(part.group, (std::vector<int>{0, 0, 1, 1}));
  EXPECT_EQ(part.joints, (std::vector<std::size_t>{0, 2}));
  EXPECT_NEAR(part.loads[0][2], -2 * kWeight, 1e-15);
  // The upper body's push about the lower one's centre.
  EXPECT_NEAR(part.loads[0][4], 0.2 * kStep, 1e-12);
}

/// Upper and lower bound of parts hold around the whole: fewer free joints, wider brackets.
TEST(Part, bounds_of_parts_hold_the_whole_between_them) {
  const Structure structure = column(6, kLaw, {0.2, 0, kWeight, 0, 0, 0});
  const ProgramBounds all = bounds_of(structure);
  std::vector<base::Vec6<double>> known =
      determinate_forces(structure, std::vector<base::Vec6<double>>(structure.joints.size()));
  ASSERT_FALSE(known.empty());
  for (const std::vector<char>& is_free :
       {std::vector<char>{1, 0, 0, 0, 0, 0}, {1, 1, 0, 0, 0, 0}, {0, 1, 0, 1, 0, 0}}) {
    const auto solve = [&](const Part& part) {
      return maximise_factor(ConeProgram(structure, part), {.thread_count = 1},
                             [] { return false; });
    };
    EXPECT_GE(solve(with_rigid_groups(structure, is_free)).high, all.low * (1 - 1e-6));
    EXPECT_LE(solve(with_known_forces(structure, is_free, known)).low, all.high * (1 + 1e-6));
  }
}

}  // namespace
}  // namespace holdfast::limit
