// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
// Proofs against closed forms: n modules that stick out from a fixed one carry W L n^2 / (a Fmax)
// in the first connection. And against what must not be proved: other contact states than those
// that the solution prescribes.
#include "holdfast/proof/proof.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "random_robot.hpp"

namespace holdfast::proof {
namespace {

using model::Robot;
using verdict::Assessment;
using verdict::Verdict;

model::RobotSpec cantilever(std::int32_t count) {
  model::RobotSpec spec;
  for (std::int32_t x = 0; x <= count; ++x) {
    spec.existing.push_back({x, 0, 1});
  }
  spec.fixed = {{0, 0, 1}};
  return spec;
}

/// A cantilever with the strength that gives it this load ratio.
Robot cantilever_at(std::int32_t count, double ratio) {
  model::RobotSpec spec = cantilever(count);
  const double load_n = model::module_weight_n(spec.material) * count * count;
  spec.material.strength_lateral_n = load_n / ratio;
  return Robot::create(spec).value();
}

/// Feet along x, some of them lifted or tilted, that carry an arm: the paper's arm with its plan.
Robot arm() {
  model::RobotSpec spec;
  spec.existing = {{1, 1, 0}, {2, 1, 0}, {3, 1, 0}, {1, 1, 1}, {2, 1, 1}, {1, 1, 2},
                   {2, 1, 2}, {3, 1, 2}, {4, 1, 2}, {5, 1, 2}, {6, 1, 2}};
  spec.planned = {{6, 0, 2}, {6, 2, 2}};
  return Robot::create(spec).value();
}

TEST(Proof, holds_the_closed_form_of_cantilevers) {
  for (const std::int32_t count : {1, 5, 28, 127, 128, 500, 3000}) {
    const auto robot = Robot::create(cantilever(count));
    const Proof proof = prove(robot.value(), verdict::assess(robot.value()));
    ASSERT_TRUE(proof.is_proved()) << proof.verification.reason;
    const double exact = model::module_weight_n(robot.value().material()) * count * count / 14.97;
    // Four roundings of what is compared with.
    const certificate::Verification& found = proof.verification;
    EXPECT_LE(found.ratio_low, exact * (1 + 1e-15));
    EXPECT_GE(found.ratio_high, exact * (1 - 1e-15));
    EXPECT_LT(found.ratio_high - found.ratio_low, 1e-12 * exact) << count;
  }
}

/// The cell level 0 is like any other where there is no floor.
TEST(Proof, knows_no_floor_where_there_is_none) {
  for (const std::int32_t level : {-1, 0, 1}) {
    const Robot robot = Robot::create({.existing = {{0, 0, level}, {1, 0, level}},
                                       .fixed = {{0, 0, level}},
                                       .support_z = std::nullopt})
                            .value();
    const Proof proof = prove(robot, verdict::assess(robot));
    ASSERT_TRUE(proof.is_proved()) << proof.verification.reason;
    const double exact = model::module_weight_n(robot.material()) / 14.97;
    EXPECT_NEAR(proof.verification.ratio_low, exact, 1e-12) << "level " << level;
    EXPECT_NEAR(proof.verification.ratio_high, exact, 1e-12) << "level " << level;
  }
}

/// The proof certifies no other robot than the one that was asked about.
TEST(Proof, leaves_a_robot_with_released_pairs_undecided) {
  const Robot robot = Robot::create({.existing = {{0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}},
                                     .fixed = {{0, 0, 1}},
                                     .released = {{base::Cell{0, 1, 1}, base::Cell{0, 0, 1}}}})
                          .value();
  Assessment assessment = verdict::assess(robot);
  EXPECT_EQ(assessment.verdict, Verdict::kSafe);
  const Proof proof = prove(robot, assessment);
  EXPECT_FALSE(proof.is_proved());
  EXPECT_TRUE(proof.certificate.modules.empty());
  apply(robot, proof, assessment);
  EXPECT_EQ(assessment.verdict, Verdict::kUndecided);
  EXPECT_NE(assessment.reasons.front().quoted.find("not connected"), std::string::npos);
}

TEST(Proof, decides_near_the_limit) {
  // The ratio is known to three roundings; beyond 1e-9 below 1 it counts as 1.
  for (const std::int32_t count : {3, 28, 140, 600}) {
    for (const double off : {1e-9, 1e-8, 1e-6}) {
      for (const double ratio : {1 - 1.1 * off, 1 + off}) {
        const Robot robot = cantilever_at(count, ratio);
        Assessment assessment = verdict::assess(robot);
        const Proof proof = prove(robot, assessment);
        apply(robot, proof, assessment);
        ASSERT_TRUE(proof.is_proved());
        EXPECT_LT(std::abs(proof.verification.ratio_low - ratio), 1e-11);
        EXPECT_LT(std::abs(proof.verification.ratio_high - ratio), 1e-11);
        EXPECT_EQ(assessment.verdict, ratio < 1 ? Verdict::kSafe : Verdict::kOverload);
        EXPECT_NEAR(*assessment.load_ratio_max, ratio, 1e-9);
      }
    }
  }
}

TEST(Proof, leaves_undecided_what_the_range_leaves_open) {
  const Robot robot = cantilever_at(28, 1 - verdict::kLoadRatioTie);
  Assessment assessment = verdict::assess(robot);
  apply(robot, prove(robot, assessment), assessment);
  EXPECT_EQ(assessment.verdict, Verdict::kUndecided);
}

TEST(Proof, refuses_other_contact_states) {
  const Robot robot = arm();
  const Assessment right = verdict::assess(robot);
  ASSERT_TRUE(prove(robot, right).is_proved());
  int refused = 0;
  for (std::size_t facet = 0; facet < robot.facets().size(); ++facet) {
    for (int tilt = -1; tilt < 9; ++tilt) {
      Assessment wrong = right;
      mechanics::ContactState& state = wrong.equilibrium.contact[facet];
      state = {.pressed = tilt >= 0,
               .tilt_x = static_cast<std::int8_t>(tilt < 0 ? 0 : tilt / 3 - 1),
               .tilt_y = static_cast<std::int8_t>(tilt < 0 ? 0 : tilt % 3 - 1)};
      if (state == right.equilibrium.contact[facet]) {
        continue;
      }
      const Proof proof = prove(robot, wrong);
      EXPECT_FALSE(proof.is_proved()) << facet << ' ' << tilt;
      apply(robot, proof, wrong);
      EXPECT_EQ(wrong.verdict, Verdict::kUndecided);
      ++refused;
    }
  }
  EXPECT_EQ(refused, 27);
}

TEST(Proof, refuses_displacements_that_are_not_those_of_its_states) {
  const Robot robot = arm();
  Proof proof = prove(robot, verdict::assess(robot));
  ASSERT_TRUE(proof.is_proved());
  certificate::Six& foot = proof.certificate.fields[0][0];
  foot[2] = -foot[2];
  EXPECT_FALSE(certificate::verify(proof.certificate).is_proved);
}

TEST(Proof, survives_writing_and_reading) {
  for (const std::uint64_t seed : {1U, 2U, 3U, 5U, 17U}) {
    const auto robot = Robot::create(test::random_robot(seed));
    const Proof proof = prove(robot.value(), verdict::assess(robot.value()));
    const certificate::Reading reading = certificate::read(certificate::write(proof.certificate));
    if (!proof.is_proved()) {
      continue;
    }
    ASSERT_EQ(reading.fault, "");
    const certificate::Verification again = certificate::verify(reading.certificate);
    EXPECT_EQ(again.ratio_low, proof.verification.ratio_low);
    EXPECT_EQ(again.ratio_high, proof.verification.ratio_high);
  }
}

/// Mirroring at the plane x = 0 changes no load: the two ranges must have a number in common.
TEST(Proof, agrees_with_that_of_the_mirrored_robot) {
  int proved = 0;
  for (std::uint64_t seed = 0; seed < 60; ++seed) {
    model::RobotSpec spec = test::random_robot(seed);
    const auto robot = Robot::create(spec);
    for (auto* cells : {&spec.existing, &spec.planned, &spec.fixed}) {
      for (base::Cell& cell : *cells) {
        cell.x = -cell.x;
      }
    }
    const auto mirrored = Robot::create(spec);
    const Proof one = prove(robot.value(), verdict::assess(robot.value()));
    const Proof other = prove(mirrored.value(), verdict::assess(mirrored.value()));
    EXPECT_EQ(one.is_proved(), other.is_proved()) << seed;
    if (one.is_proved() && other.is_proved()) {
      EXPECT_LE(one.verification.ratio_low, other.verification.ratio_high) << seed;
      EXPECT_LE(other.verification.ratio_low, one.verification.ratio_high) << seed;
      ++proved;
    }
  }
  EXPECT_GT(proved, 40);
}

/// Under the unilateral law the solver leaves weak springs of 1e-9 of the contact's stiffness,
/// which change no load ratio by more than about 1e-8; the proof has none.
TEST(Proof, holds_the_exact_law_without_weak_springs) {
  int proved = 0;
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    const auto robot = Robot::create(test::random_robot(seed));
    if (!verdict::assess_rigid_body(robot.value()).is_stable) {
      continue;
    }
    solver::EquilibriumSolver solver(robot.value());
    const Assessment assessment = verdict::assess_equilibrium(
        robot.value(), solver.solve({.law = mechanics::ContactLaw::kUnilateral, .gamma = 1e-9}));
    const Proof proof = prove(robot.value(), assessment);
    if (proof.is_proved()) {
      EXPECT_LE(proof.verification.ratio_low, *assessment.load_ratio_max + 1e-7) << seed;
      EXPECT_GE(proof.verification.ratio_high, *assessment.load_ratio_max - 1e-7) << seed;
      EXPECT_LT(proof.verification.ratio_high - proof.verification.ratio_low, 1e-7) << seed;
      ++proved;
    }
  }
  EXPECT_GT(proved, 100);
}

/// The checker shares no code with the program, so it names the numbers of a material by itself: as
/// files do, all of them but E, on which no load ratio depends.
TEST(Proof, names_the_material_as_files_do) {
  model::RobotSpec spec = cantilever(3);
  double factor = 1;
  for (const model::MaterialParameter& parameter : model::kMaterialParameters) {
    spec.material.*parameter.value *= factor += 0.01;
  }
  const Robot robot = Robot::create(spec).value();
  const std::string text = certificate::write(prove(robot, verdict::assess(robot)).certificate);
  for (const model::MaterialParameter& parameter : model::kMaterialParameters) {
    const std::string name = '\n' + std::string(parameter.key) + ' ';
    const std::size_t at = text.find(name);
    if (parameter.value == &model::Material::elastic_modulus_mpa) {
      EXPECT_EQ(at, std::string::npos);
    } else {
      ASSERT_NE(at, std::string::npos) << parameter.key;
      EXPECT_EQ(std::stod(text.substr(at + name.size())), spec.material.*parameter.value);
    }
  }
}

TEST(Proof, says_why_there_is_none) {
  model::RobotSpec spec;
  spec.existing = {{0, 0, 0}, {0, 0, 1}, {1, 0, 1}, {2, 0, 1}};
  const auto robot = Robot::create(spec);
  Assessment assessment = verdict::assess(robot.value());
  const Proof proof = prove(robot.value(), assessment);
  EXPECT_FALSE(proof.is_proved());
  EXPECT_TRUE(proof.certificate.modules.empty());
  EXPECT_EQ(proof.verification.reason,
            "the robot topples, which the rigid body decides in integers");
  apply(robot.value(), proof, assessment);
  EXPECT_EQ(assessment.verdict, Verdict::kUnstable);
}

}  // namespace
}  // namespace holdfast::proof
