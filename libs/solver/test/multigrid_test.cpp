// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
// Multigrid against the direct solver, the second method: every load ratio of every connection, on
// all families and on random robots, with every kind of support.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "holdfast/mechanics/connector.hpp"
#include "holdfast/model/families.hpp"
#include "holdfast/solver/equilibrium.hpp"
#include "random_robot.hpp"

namespace holdfast::solver {
namespace {

using base::Vec6;
using mechanics::ContactLaw;
using model::Family;

/// What multigrid promises of every load ratio, as a share of the largest one or of 1.
constexpr double kRatioTolerance = 1e-4;

std::vector<double> load_ratios(const model::Robot& robot, const std::vector<Vec6<double>>& u) {
  const model::Material& material = robot.material();
  const auto beam = mechanics::beam_stiffness(model::beam_section(material));
  std::vector<double> ratios;
  for (const model::Connection& pair : robot.connections()) {
    const auto load = mechanics::connection_load(
        mechanics::middle_force(beam, pair.direction, u[static_cast<std::size_t>(pair.a)],
                                u[static_cast<std::size_t>(pair.b)]));
    ratios.push_back(mechanics::load_ratio(load, material.facet_mm,
                                           base::is_vertical(pair.direction)
                                               ? material.strength_vertical_n
                                               : material.strength_lateral_n));
  }
  return ratios;
}

double largest_difference(const std::vector<double>& a, const std::vector<double>& b) {
  double scale = 1;
  double difference = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    scale = std::max(scale, std::abs(a[i]));
    difference = std::max(difference, std::abs(a[i] - b[i]));
  }
  return difference / scale;
}

model::Robot family(Family family, std::size_t size) {
  return model::Robot::create({.existing = model::family_cells(family, size)}).value();
}

void expect_equal(const model::Robot& robot, const ContactOptions& contact, bool is_bonded,
                  const std::string& what) {
  EquilibriumSolver direct(robot, {.method = Method::kDirect, .is_bonded = is_bonded});
  EquilibriumSolver multigrid(robot, {.method = Method::kMultigrid, .is_bonded = is_bonded});
  const Equilibrium a = direct.solve(contact);
  const Equilibrium b = multigrid.solve(contact);
  EXPECT_EQ(a.outcome, b.outcome) << what;
  if (a.outcome != Outcome::kSettled || b.outcome != Outcome::kSettled) {
    return;
  }
  const auto exact = load_ratios(robot, a.displacement);
  const auto found = load_ratios(robot, b.displacement);
  const double error = largest_difference(exact, found);
  EXPECT_LE(error, kRatioTolerance) << what;
  std::printf("%s error %.2g estimate %.2g its %d steps %d (direct %d)\n", what.c_str(), error,
              largest_difference(found, load_ratios(robot, b.alternative)), b.iteration_count,
              b.steps, a.steps);
}

TEST(Multigrid, agrees_with_the_direct_solver_on_all_families) {
  const std::pair<Family, std::size_t> robots[] = {
      {Family::kArm, 60},   {Family::kCube, 8},    {Family::kTower, 60},  {Family::kScaffold, 13},
      {Family::kShell, 12}, {Family::kPortal, 40}, {Family::kBridge, 30}, {Family::kGrowth, 600}};
  for (const auto& [name, size] : robots) {
    const model::Robot robot = family(name, size);
    const std::string what = std::string(model::families()[static_cast<std::size_t>(name)].name);
    expect_equal(robot, {}, true, what + " bonded");
    expect_equal(robot, {}, false, what + " regularised");
    expect_equal(robot, {.law = ContactLaw::kUnilateral, .gamma = 1e-9}, false,
                 what + " unilateral");
  }
}

TEST(Multigrid, agrees_with_the_direct_solver_on_random_robots) {
  for (std::uint64_t seed = 0; seed < 60; ++seed) {
    const auto robot = model::Robot::create(test::random_robot(seed)).value();
    expect_equal(robot, {}, true, "seed " + std::to_string(seed) + " bonded");
    expect_equal(robot, {}, false, "seed " + std::to_string(seed));
    expect_equal(robot, {.law = ContactLaw::kUnilateral, .gamma = 1e-9}, false,
                 "seed " + std::to_string(seed) + " unil");
  }
}

}  // namespace
}  // namespace holdfast::solver
