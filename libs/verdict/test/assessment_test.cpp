// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
// Verdicts on robots whose loads follow from statics alone: hanging chains and short arms.
#include "holdfast/verdict/assessment.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "holdfast/mechanics/connector.hpp"

namespace holdfast::verdict {
namespace {

using base::Cell;

constexpr double kWeight = 0.06106 * 9.81;
// Closed forms below hold to rounding: forces are sums of a few dozen terms of size 1.
constexpr double kRounding = 1e-9;

Assessment assess_spec(const model::RobotSpec& spec,
                       const solver::EquilibriumOptions& options = {}) {
  const auto robot = model::Robot::create(spec);
  EXPECT_TRUE(robot) << (robot ? "" : robot.error().message);
  return assess(robot.value(), options);
}

/// One fixed module with `count` modules hanging below it.
model::RobotSpec hanging_chain(int count) {
  model::RobotSpec spec{.existing = {{0, 0, 100}}, .fixed = {{0, 0, 100}}};
  for (int i = 1; i <= count; ++i) {
    spec.existing.push_back({0, 0, 100 - i});
  }
  return spec;
}

/// A foot of two modules, a post of two, and an arm of `length` planned modules to +x.
model::RobotSpec arm(int length) {
  model::RobotSpec spec{.existing = {{0, 0, 0}, {1, 0, 0}, {0, 0, 1}}};
  for (int i = 0; i < length; ++i) {
    spec.planned.push_back({1 + i, 0, 1});
  }
  return spec;
}

TEST(Assessment, counts_the_modules_that_a_vertical_connection_can_hold) {
  // The paper: Fmax = 11.98 N is what twenty modules weigh, so 20 hold and 21 do not.
  const Assessment holds = assess_spec(hanging_chain(20));
  EXPECT_EQ(holds.verdict, Verdict::kSafe);
  EXPECT_NEAR(*holds.load_ratio_max, 20 * kWeight / 11.98, kRounding);
  const Assessment breaks = assess_spec(hanging_chain(21));
  EXPECT_EQ(breaks.verdict, Verdict::kOverload);
  EXPECT_NEAR(*breaks.load_ratio_max, 21 * kWeight / 11.98, kRounding);
  ASSERT_EQ(breaks.broken.size(), 1U);
  EXPECT_EQ(breaks.broken[0], *breaks.worst);
  EXPECT_NEAR(*breaks.weight_factor, 11.98 / (21 * kWeight), kRounding);
  EXPECT_EQ(breaks.contact_model, ContactModel::kNone);
}

/// Loads are compared with the functions of mechanics, one connection at a time, to the last bit. A
/// section with unequal moments tells the axes apart.
TEST(Assessment, says_of_every_connection_what_mechanics_says) {
  model::RobotSpec spec{.fixed = {{0, 0, 0}}, .support_z = -10};
  for (const Cell& cell : {Cell{0, 0, 0}, Cell{1, 0, 0}, Cell{1, 1, 0}, Cell{1, 1, 1},
                           Cell{2, 1, 1}, Cell{2, 0, 1}, Cell{2, -1, 1}, Cell{2, -1, 0}}) {
    spec.existing.push_back(cell);
  }
  spec.material.moment_y_mm4 *= 3;
  const auto robot = model::Robot::create(spec).value();
  const Assessment found = assess(robot);
  const model::Material& material = robot.material();
  const auto beam = mechanics::beam_stiffness(model::beam_section(material));
  ASSERT_EQ(found.connections.size(), robot.connections().size());
  for (std::size_t i = 0; i < found.connections.size(); ++i) {
    const model::Connection& pair = robot.connections()[i];
    const auto middle = mechanics::middle_force(
        beam, pair.direction, found.equilibrium.displacement[static_cast<std::size_t>(pair.a)],
        found.equilibrium.displacement[static_cast<std::size_t>(pair.b)]);
    const auto load = mechanics::connection_load(middle);
    const double strength = base::is_vertical(pair.direction) ? material.strength_vertical_n
                                                              : material.strength_lateral_n;
    EXPECT_EQ(found.connections[i].load_ratio,
              mechanics::load_ratio(load, material.facet_mm, strength));
    EXPECT_EQ(found.connections[i].axial_n, load.axial);
    EXPECT_EQ(found.connections[i].bending_nmm, load.bending);
    EXPECT_DOUBLE_EQ(found.connections[i].shear_n, std::hypot(middle[0], middle[1]));
    EXPECT_EQ(found.connections[i].torsion_nmm, middle[5]);
  }
}

TEST(Assessment, calls_a_load_ratio_of_exactly_one_an_overload) {
  model::RobotSpec spec = hanging_chain(7);
  spec.material.strength_vertical_n = 7 * model::module_weight_n(spec.material);
  EXPECT_EQ(assess_spec(spec).verdict, Verdict::kOverload);
  spec.material.strength_vertical_n *= 1 + 1e-6;
  EXPECT_EQ(assess_spec(spec).verdict, Verdict::kSafe);
}

TEST(Assessment, lists_broken_connections_worst_first) {
  model::RobotSpec spec = hanging_chain(10);
  spec.material.strength_vertical_n = 7.5 * model::module_weight_n(spec.material);
  const Assessment assessment = assess_spec(spec);
  ASSERT_EQ(assessment.broken.size(), 3U);  // They carry 10, 9 and 8 modules.
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_NEAR(assessment.connections[assessment.broken[i]].axial_n,
                (10 - static_cast<double>(i)) * kWeight, kRounding);
  }
}

TEST(Assessment, knows_the_bending_in_a_lateral_connection) {
  // A fixed module with one neighbour: its weight W acts 20 mm beyond the middle of the connection.
  const Assessment assessment =
      assess_spec({.existing = {{0, 0, 5}, {1, 0, 5}}, .fixed = {{0, 0, 5}}});
  ASSERT_EQ(assessment.connections.size(), 1U);
  EXPECT_NEAR(assessment.connections[0].bending_nmm, 20 * kWeight, kRounding);
  EXPECT_NEAR(assessment.connections[0].axial_n, 0, kRounding);
  EXPECT_NEAR(assessment.connections[0].shear_n, kWeight, kRounding);
  EXPECT_NEAR(*assessment.load_ratio_max, kWeight / 14.97, kRounding);
}

TEST(Assessment, topples_when_the_mass_leaves_the_foot) {
  // Feet at x = 0 and 1: the support ends at 60 mm. With n arm modules at x = 1..n the centre of
  // mass is at 40 (0 + 1 + 0 + n (n + 1) / 2) / (3 + n): n = 3 gives 46.7, n = 4 gives 62.9 mm.
  EXPECT_EQ(assess_spec(arm(3)).verdict, Verdict::kSafe);
  const Assessment toppling = assess_spec(arm(4));
  EXPECT_EQ(toppling.verdict, Verdict::kUnstable);
  EXPECT_NEAR(*toppling.simplified.margin_mm, 60 - 440.0 / 7, kRounding);
  EXPECT_DOUBLE_EQ((*toppling.simplified.edge)[0].x, 60);
  EXPECT_DOUBLE_EQ((*toppling.simplified.edge)[1].x, 60);
  EXPECT_FALSE(toppling.model.is_stable);
  EXPECT_FALSE(toppling.connections.empty());
}

TEST(Assessment, gives_nothing_to_spare_to_a_mass_over_the_edge) {
  // One foot at x = 0, mass at x = 0 and 1: the centre is at 20 mm, exactly over the edge.
  const Assessment assessment =
      assess_spec({.existing = {{0, 0, 0}, {0, 0, 1}, {1, 0, 1}, {1, 0, 2}}});
  EXPECT_EQ(*assessment.simplified.margin_mm, 0);
  EXPECT_EQ(assessment.verdict, Verdict::kUnstable);
  EXPECT_EQ(assessment.reasons.front().code, ReasonCode::kNothingToSpare);
}

TEST(Assessment, never_topples_a_robot_with_a_fixed_module) {
  model::RobotSpec spec = arm(8);
  spec.fixed = {{0, 0, 0}};
  const Assessment assessment = assess_spec(spec);
  EXPECT_TRUE(assessment.is_stable);
  EXPECT_TRUE(assessment.model.is_stable);
  EXPECT_FALSE(assessment.simplified.margin_mm.has_value());
}

TEST(Assessment, is_safe_for_a_single_module) {
  const Assessment assessment = assess_spec({.existing = {{5, -3, 0}}});
  EXPECT_EQ(assessment.verdict, Verdict::kSafe);
  EXPECT_FALSE(assessment.load_ratio_max.has_value());
  EXPECT_TRUE(assessment.connections.empty());
}

/// A free column presses on every connection; a plate on the ground leaves them nothing but
/// rounding. Neither has a worst connection, nor a weight at which it breaks.
TEST(Assessment, has_no_worst_connection_where_none_is_pulled_apart) {
  const model::RobotSpec column{.existing = {{0, 0, 0}, {0, 0, 1}, {0, 0, 2}}};
  const model::RobotSpec plate{.existing = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}}};
  for (const model::RobotSpec& spec : {column, plate}) {
    const Assessment assessment = assess_spec(spec);
    EXPECT_EQ(assessment.verdict, Verdict::kSafe);
    EXPECT_LT(*assessment.load_ratio_max, kLoadRatioTie);
    EXPECT_FALSE(assessment.worst.has_value());
    EXPECT_FALSE(assessment.weight_factor.has_value());
    EXPECT_EQ(assessment.reasons.front().code, ReasonCode::kNoTension);
  }
}

/// Down to a billionth of the strength a load counts: a chain of one that holds a billion.
TEST(Assessment, knows_the_worst_connection_of_small_loads) {
  model::RobotSpec spec = hanging_chain(1);
  spec.material.strength_vertical_n = kWeight * 0.99e9;
  EXPECT_NEAR(*assess_spec(spec).weight_factor, 0.99e9, 1);
  spec.material.strength_vertical_n = kWeight * 1.01e9;
  EXPECT_FALSE(assess_spec(spec).weight_factor.has_value());
}

TEST(Assessment, scales_loads_with_the_weight_but_not_the_stability) {
  model::RobotSpec spec = arm(3);
  const Assessment light = assess_spec(spec);
  spec.material.mass_kg *= *light.weight_factor * 1.001;
  EXPECT_EQ(assess_spec(spec).verdict, Verdict::kOverload);
  spec.material.mass_kg *= 0.998;
  EXPECT_EQ(assess_spec(spec).verdict, Verdict::kSafe);
}

TEST(Assessment, is_undecided_when_the_memory_does_not_suffice) {
  // 1 kB holds no factor; that the longer arm topples is certain all the same.
  const solver::EquilibriumOptions tiny{.memory_bytes_max = 1024};
  const Assessment stable = assess_spec(arm(3), tiny);
  EXPECT_EQ(stable.verdict, Verdict::kUndecided);
  EXPECT_EQ(stable.reasons.front().code, ReasonCode::kTooManyModules);
  EXPECT_FALSE(stable.load_ratio_max.has_value());
  EXPECT_EQ(assess_spec(arm(4), tiny).verdict, Verdict::kUnstable);
}

/// A load that is not a number must not hide behind those that are, wherever it stands.
TEST(Assessment, is_undecided_when_a_load_is_not_a_number) {
  const auto robot = model::Robot::create(hanging_chain(4)).value();
  const solver::Equilibrium sound = solver::EquilibriumSolver(robot).solve({});
  EXPECT_EQ(assess_equilibrium(robot, sound).verdict, Verdict::kSafe);
  for (const auto displacement :
       {&solver::Equilibrium::displacement, &solver::Equilibrium::alternative}) {
    for (std::size_t module = 0; module < robot.modules().size(); ++module) {
      for (const std::size_t component : {2U, 3U, 4U}) {  // uz pulls, tx and ty bend.
        solver::Equilibrium spoilt = sound;
        (spoilt.*displacement)[module][component] = std::numeric_limits<double>::quiet_NaN();
        const Assessment assessment = assess_equilibrium(robot, spoilt);
        EXPECT_EQ(assessment.verdict, Verdict::kUndecided) << module << ", " << component;
        EXPECT_EQ(assessment.reasons.front().code, ReasonCode::kLoadNotANumber);
        EXPECT_FALSE(assessment.load_ratio_max.has_value());
        EXPECT_FALSE(assessment.worst.has_value());
        EXPECT_FALSE(assessment.weight_factor.has_value());
      }
    }
  }
}

TEST(Assessment, of_an_equilibrium_is_that_of_the_robot) {
  const auto robot = model::Robot::create(arm(3)).value();
  const Assessment whole = assess(robot);
  const Assessment assessment = assess_equilibrium(robot, whole.equilibrium);
  EXPECT_EQ(assessment.verdict, whole.verdict);
  EXPECT_EQ(assessment.reasons, whole.reasons);
  EXPECT_EQ(assessment.load_ratio_max, whole.load_ratio_max);
  EXPECT_EQ(assessment.contact_model, whole.contact_model);
  EXPECT_EQ(assessment.model.is_stable, whole.model.is_stable);
}

TEST(Assessment, does_not_depend_on_the_order_of_modules) {
  model::RobotSpec spec = arm(3);
  const Assessment forward = assess_spec(spec);
  std::ranges::reverse(spec.existing);
  std::ranges::reverse(spec.planned);
  const Assessment backward = assess_spec(spec);
  EXPECT_EQ(forward.verdict, backward.verdict);
  EXPECT_NEAR(*forward.load_ratio_max, *backward.load_ratio_max, kRounding);
}

/// A corkscrew that is held by one module carries what statics says, however soft torsion is: with
/// usual beams, and with 1e-12 of their torsion.
TEST(Assessment, has_the_truth_in_its_range_where_beams_are_very_soft_one_way) {
  model::RobotSpec spec;
  Cell cell = {0, 0, 0};
  for (int i = 0; i < 130; ++i) {
    spec.existing.push_back(cell);
    const int turn = i / 2 % 4;
    cell.x += turn == 0 ? 1 : 0;
    cell.y += turn % 2 == 1 ? 1 : 0;
    cell.z += turn == 2 ? 1 : 0;
  }
  spec.fixed = {spec.existing.front()};
  const Assessment usual = assess_spec(spec);
  spec.material.torsion_mm4 = 1e-7;
  const Assessment soft = assess_spec(spec);
  ASSERT_TRUE(usual.load_ratio_max.has_value());
  EXPECT_LE(soft.load_ratio_range.low, *usual.load_ratio_max);
  EXPECT_GE(soft.load_ratio_range.high, *usual.load_ratio_max);
}

TEST(Assessment, counts_a_planned_module_on_the_ground_as_a_support) {
  // An arm that topples alone stands once its far end gets a leg: one planned module at z = 0.
  model::RobotSpec spec = arm(4);
  spec.planned.push_back({4, 0, 0});
  EXPECT_EQ(assess_spec(spec).verdict, Verdict::kSafe);
}

TEST(Assessment, uses_the_width_of_the_facet_for_both_stability_checks) {
  // The centre of mass is 40 / 3 mm out: within a facet of 40 mm, beyond one of 20 mm.
  model::RobotSpec spec{.existing = {{0, 0, 0}, {0, 0, 1}, {1, 0, 1}}};
  EXPECT_NEAR(*assess_spec(spec).simplified.margin_mm, 20 - 40.0 / 3, kRounding);
  spec.material.facet_mm = 20;
  const Assessment narrow = assess_spec(spec);
  EXPECT_EQ(narrow.verdict, Verdict::kUnstable);
  EXPECT_NEAR(*narrow.simplified.margin_mm, 10 - 40.0 / 3, kRounding);
  EXPECT_FALSE(narrow.model.is_stable);
}

/// Blocks that stand on the ground press every connection but those of their lowest layers, where
/// there is nothing but the solver's error: no digit of a true zero is reported.
TEST(Assessment, tells_nothing_of_a_load_below_its_own_uncertainty) {
  model::RobotSpec tower;
  for (std::int32_t i = 0; i < 3 * 3 * 60; ++i) {
    tower.existing.push_back({i % 3, i / 3 % 3, i / 9});
  }
  const Assessment assessment = assess_spec(tower);
  ASSERT_EQ(assessment.equilibrium.method, solver::Method::kMultigrid);
  EXPECT_EQ(assessment.verdict, Verdict::kSafe);
  EXPECT_FALSE(assessment.worst.has_value());
  EXPECT_FALSE(assessment.weight_factor.has_value());
  const ReasonCode code = assessment.reasons.front().code;
  EXPECT_TRUE(code == ReasonCode::kNoTension || code == ReasonCode::kNoKnownTension);
  // The same tower with an arm has a load, and it is told.
  for (std::int32_t x = 3; x < 8; ++x) {
    tower.existing.push_back({x, 1, 30});
  }
  const Assessment loaded = assess_spec(tower);
  ASSERT_TRUE(loaded.worst.has_value());
  EXPECT_GT(*loaded.load_ratio_max, 0.1);
}

}  // namespace
}  // namespace holdfast::verdict
