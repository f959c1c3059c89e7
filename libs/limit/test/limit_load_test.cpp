// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
// Limit loads against closed forms: columns, cantilevers, strings, magnets on a wall; and the
// balance of power of the mechanism.
#include "holdfast/limit/limit_load.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "holdfast/limit/robot.hpp"

namespace holdfast::limit {
namespace {

using model::BendingLaw;
using model::ConnectorLaw;

/// What a solution has to prove of itself.
constexpr double kExact = 1e-6;

/// Cubes fixed at the first cell, all connectors alike.
model::Robot robot_of(std::vector<base::Cell> cells, const ConnectorLaw& law,
                      std::vector<base::Cell> fixed, std::vector<model::Payload> payloads = {}) {
  model::RobotSpec spec = {.existing = std::move(cells),
                           .fixed = std::move(fixed),
                           .support_z = std::nullopt,
                           .payloads = std::move(payloads)};
  spec.kinds = {model::default_kind(spec.material, spec.lattice)};
  spec.kinds[0].connectors.assign(6, law);
  auto robot = model::Robot::create(spec);
  EXPECT_TRUE(robot) << robot.error().message;
  return std::move(robot).value();
}

double weight() { return model::module_weight_n(model::Material{}); }

std::vector<base::Cell> row(int count, base::Cell step) {
  std::vector<base::Cell> cells;
  for (int i = 0; i < count; ++i) {
    cells.push_back({i * step.x, i * step.y, i * step.z});
  }
  return cells;
}

TEST(LimitLoad, AHangingColumnBreaksAtItsTop) {
  const model::Robot robot =
      robot_of(row(6, {0, 0, -1}), {.strength_n = 12, .lever_mm = 20}, {{0, 0, 0}});
  const LimitLoad found = limit_load(structure_of(robot));
  EXPECT_EQ(found.outcome, LimitLoad::Outcome::kFound);
  EXPECT_NEAR(found.low, 12 / (5 * weight()), kExact * found.low);
  EXPECT_LE(found.high - found.low, kExact * found.high);
  // All five fall together.
  ASSERT_EQ(found.mechanism.yields.size(), 1);
  EXPECT_EQ(found.mechanism.yields[0].limit, model::Limit::kOpens);
  EXPECT_EQ(ends_text(robot, found.mechanism.yields[0].joint), "(0,0,-1)-(0,0,0)");
  EXPECT_NEAR(found.mechanism.velocities[5][2], -1, kExact);
}

// n modules beyond a fixed one: the moment in the first connection is n^2 L w / 2.
TEST(LimitLoad, ACantileverBreaksAtItsRoot) {
  for (const int n : {1, 4, 9}) {
    const model::Robot robot =
        robot_of(row(n + 1, {1, 0, 0}), {.strength_n = 14, .lever_mm = 20}, {{0, 0, 0}});
    const LimitLoad found = limit_load(structure_of(robot));
    EXPECT_NEAR(found.low, 14 * 20 / (weight() * 40 * n * n / 2), kExact * found.low);
    // Power: the factor times what the loads do is what the opening takes.
    const Structure structure = structure_of(robot);
    double power = 0;
    for (std::size_t i = 0; i < structure.bodies.size(); ++i) {
      power += found.mechanism.velocities[i][2] * -weight();
    }
    const double turn = found.mechanism.velocities[1][4];
    EXPECT_NEAR(found.low * power, 14 * 20 * std::abs(turn), 1e-5 * power);
  }
}

TEST(LimitLoad, LatchesThatShearLimitTheSame) {
  const model::Robot robot = robot_of(
      row(5, {1, 0, 0}), {.strength_n = 1e3, .lever_mm = 20, .shear_strength_n = 3}, {{0, 0, 0}});
  const LimitLoad found = limit_load(structure_of(robot));
  EXPECT_NEAR(found.low, 3 / (4 * weight()), kExact * found.low);
  EXPECT_LE(found.low, 3 / (4 * weight()) * (1 + kExact));
  EXPECT_GE(found.high, 3 / (4 * weight()) * (1 - kExact));
  ASSERT_EQ(found.mechanism.yields.size(), 1);
  EXPECT_EQ(found.mechanism.yields[0].limit, model::Limit::kShears);
}

// A magnet that is drawn to a wall by 10 N and carries one module: it opens by the moment w L / 2,
// or slips by w.
TEST(LimitLoad, AMagnetOnAWallOpensOrSlips) {
  for (const double friction : {0.1, 0.9, 3.0}) {
    const model::Robot robot = robot_of(
        row(2, {1, 0, 0}), {.strength_n = 10, .lever_mm = 20, .friction = friction}, {{0, 0, 0}});
    const LimitLoad found = limit_load(structure_of(robot));
    const double expected = std::min(10 * 20 / (weight() * 20), 10 * friction / weight());
    EXPECT_NEAR(found.low, expected, kExact * expected);
    EXPECT_LE(found.low, expected * (1 + kExact));
    EXPECT_GE(found.high, expected * (1 - kExact));
    ASSERT_FALSE(found.mechanism.yields.empty());
    EXPECT_EQ(found.mechanism.yields[0].limit,
              friction < 1 ? model::Limit::kSlips : model::Limit::kOpens);
  }
}

// A moment of 100 N mm about an axis that is no axis of the facet; weight is too small to count.
TEST(LimitLoad, RoundConnectorsBendAlikeInAllDirections) {
  const double angle = 0.37;
  for (const BendingLaw bending : {BendingLaw::kRound, BendingLaw::kSquare}) {
    Structure structure = {
        .bodies = {{.load = {0, 0, 0, 100 * std::cos(angle), 100 * std::sin(angle), 0}}},
        .length_mm = 20};
    structure.joints = {{.a = 0,
                         .frame = {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}},
                         .law = {.strength_n = 10, .lever_mm = 15, .bending = bending}}};
    const LimitLoad found = limit_load(structure);
    const double moment = bending == BendingLaw::kRound ? 100 : 100 * std::cos(angle);
    EXPECT_LE(found.low, 150 / moment * (1 + kExact));
    EXPECT_GE(found.high, 150 / moment * (1 - kExact));
    EXPECT_LE(found.high - found.low, kExact * found.high);
  }
}

// A bar on three strings of 5 N at -1, 0 and 1 with its load at 1/2: the middle one and the nearer
// one are full, the other carries what balances.
TEST(LimitLoad, StringsShareWhatIsBeyondTheFirst) {
  Structure structure = {.bodies = {{.centre_mm = {0.5, 0, 0}, .load = {0, 0, -8, 0, 0, 0}}}};
  for (const double x : {-1.0, 0.0, 1.0}) {
    structure.joints.push_back({.a = 0,
                                .place_mm = {x, 0, 0},
                                .frame = {{{1, 0, 0}, {0, -1, 0}, {0, 0, -1}}},
                                .law = {.strength_n = 5},
                                .carries = kCarriesAxial});
  }
  const LimitLoad found = limit_load(structure);
  EXPECT_NEAR(found.low, 2 * 5 / 8.0, kExact);
}

// Between two fixed modules an arch forms, and nothing limits its thrust.
TEST(LimitLoad, ABeamBetweenTwoFixedEndsHasNone) {
  const model::Robot robot =
      robot_of(row(6, {1, 0, 0}), {.strength_n = 14, .lever_mm = 20}, {{0, 0, 0}, {5, 0, 0}});
  const LimitLoad found = limit_load(structure_of(robot));
  EXPECT_EQ(found.outcome, LimitLoad::Outcome::kUnbounded);
  EXPECT_TRUE(found.mechanism.velocities.empty());
}

TEST(LimitLoad, WithoutLoadsThereIsNone) {
  Structure structure = {.bodies = {{}}};
  EXPECT_EQ(limit_load(structure).outcome, LimitLoad::Outcome::kUnbounded);
}

TEST(LimitLoad, WhatTopplesHoldsNoShareOfItsLoads) {
  const auto robot =
      model::Robot::create({.existing = {{0, 0, 0}, {0, 0, 1}, {1, 0, 1}, {2, 0, 1}}});
  const LimitLoad found = limit_load(structure_of(robot.value()));
  EXPECT_EQ(found.outcome, LimitLoad::Outcome::kFound);
  EXPECT_NEAR(found.high, 0, 1e-9);
}

// A block on a slope of 30 degrees: within the cone whatever the factor, or not at all.
TEST(LimitLoad, FrictionOnASlopeKnowsNoFactor) {
  for (const double friction : {0.5, 0.6}) {
    const auto robot = model::Robot::create(
        {.existing = {{0, 0, 0}},
         .floor = {.friction = friction},
         .gravity_m_s2 = std::array{9.81 * 0.5, 0.0, -9.81 * std::sqrt(0.75)}});
    const LimitLoad found = limit_load(structure_of(robot.value()));
    if (friction > std::tan(std::numbers::pi / 6)) {
      EXPECT_EQ(found.outcome, LimitLoad::Outcome::kUnbounded);
    } else {
      EXPECT_NEAR(found.high, 0, 1e-9);
    }
  }
}

}  // namespace
}  // namespace holdfast::limit
