// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
// What holds for the facade whatever the robot: cells and a file of the same cells are the same
// robot, a report says what the rows say, the ground carries the weight, errors name the cell.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <nlohmann/json.hpp>

#include "holdfast/holdfast.hpp"
#include "random_robot.hpp"

namespace holdfast {
namespace {

using Json = nlohmann::json;

constexpr std::uint64_t kRobotCount = 40;

/// The file of a robot, written here.
std::string file_of(const model::RobotSpec& spec) {
  const auto add = [](Json& list, const base::Cell& cell, bool is_fixed) {
    const Json place = {cell.x, cell.y, cell.z};
    is_fixed ? list.push_back({{"cell", place}, {"fixed", true}}) : list.push_back(place);
  };
  Json file = {{"format", "holdfast-structure"}, {"version", 1}, {"modules", Json::array()}};
  for (const base::Cell& cell : spec.existing) {
    add(file["modules"], cell, std::ranges::count(spec.fixed, cell) > 0);
  }
  for (const base::Cell& cell : spec.planned) {
    add(file["planned"], cell, false);
  }
  return file.dump();
}

base::Result<model::Robot> robot_of(const model::RobotSpec& spec) {
  return make_robot({.existing = spec.existing,
                     .planned = spec.planned,
                     .fixed = spec.fixed,
                     .support_z = spec.support_z.value_or(0),
                     .material = spec.material});
}

std::vector<double> numbers(const Rows& rows) { return {rows.numbers.begin(), rows.numbers.end()}; }

std::array<double, 2> pair(const verdict::LoadRange& range) { return {range.low, range.high}; }

void expect_same_rigid_body(const verdict::RigidBody& a, const verdict::RigidBody& b) {
  EXPECT_EQ(a.is_stable, b.is_stable);
  EXPECT_EQ(a.margin_mm, b.margin_mm);
  EXPECT_EQ(a.centre_of_mass.x, b.centre_of_mass.x);
  EXPECT_EQ(a.centre_of_mass.y, b.centre_of_mass.y);
  ASSERT_EQ(a.edge.has_value(), b.edge.has_value());
  for (std::size_t i = 0; a.edge && i < 2; ++i) {
    EXPECT_EQ((*a.edge)[i].x, (*b.edge)[i].x);
    EXPECT_EQ((*a.edge)[i].y, (*b.edge)[i].y);
  }
  ASSERT_EQ(a.polygon.size(), b.polygon.size());
  for (std::size_t i = 0; i < a.polygon.size(); ++i) {
    EXPECT_EQ(a.polygon[i].x, b.polygon[i].x);
    EXPECT_EQ(a.polygon[i].y, b.polygon[i].y);
  }
}

void expect_same_several(const std::optional<verdict::SeveralSolutions>& a,
                         const std::optional<verdict::SeveralSolutions>& b) {
  ASSERT_EQ(a.has_value(), b.has_value());
  if (!a) {
    return;
  }
  EXPECT_EQ(a->found_count, b->found_count);
  EXPECT_EQ(pair(a->regularised), pair(b->regularised));
  EXPECT_EQ(a->error, b->error);
  ASSERT_EQ(a->unilateral.has_value(), b->unilateral.has_value());
  if (a->unilateral) {
    EXPECT_EQ(pair(*a->unilateral), pair(*b->unilateral));
  }
}

void expect_same_equilibrium(const solver::Equilibrium& a, const solver::Equilibrium& b) {
  EXPECT_EQ(a.outcome, b.outcome);
  EXPECT_EQ(a.law, b.law);
  EXPECT_EQ(a.displacement, b.displacement);
  EXPECT_EQ(a.displacement_low, b.displacement_low);
  EXPECT_EQ(a.alternative, b.alternative);
  EXPECT_EQ(a.gamma, b.gamma);
  EXPECT_EQ(a.energy_error, b.energy_error);
  EXPECT_EQ(a.facet_force, b.facet_force);
  EXPECT_EQ(a.contact, b.contact);
  EXPECT_EQ(a.open_but_held_count, b.open_but_held_count);
  EXPECT_EQ(a.free_gamma, b.free_gamma);
  EXPECT_EQ(a.method, b.method);
  EXPECT_EQ(a.precision, b.precision);
  EXPECT_EQ(a.steps, b.steps);
  EXPECT_EQ(a.iteration_count, b.iteration_count);
  EXPECT_EQ(a.made_column_count, b.made_column_count);
  EXPECT_EQ(a.attempts.size(), b.attempts.size());
  ASSERT_EQ(a.others.size(), b.others.size());
  for (std::size_t i = 0; i < a.others.size(); ++i) {
    EXPECT_EQ(a.others[i].displacement, b.others[i].displacement);
  }
}

void expect_same(const CheckResult& one, const CheckResult& other) {
  const verdict::Assessment& a = one.assessment;
  const verdict::Assessment& b = other.assessment;
  EXPECT_EQ(a.verdict, b.verdict);
  EXPECT_EQ(a.reasons, b.reasons);
  expect_same_rigid_body(a.simplified, b.simplified);
  EXPECT_EQ(a.model.is_stable, b.model.is_stable);
  EXPECT_EQ(a.model.is_settled, b.model.is_settled);
  EXPECT_EQ(a.is_stable, b.is_stable);
  EXPECT_EQ(numbers(connection_rows(one)), numbers(connection_rows(other)));
  EXPECT_EQ(a.load_ratio_max, b.load_ratio_max);
  EXPECT_EQ(a.worst, b.worst);
  EXPECT_EQ(a.broken, b.broken);
  EXPECT_EQ(a.weight_factor, b.weight_factor);
  EXPECT_EQ(pair(a.load_ratio_range), pair(b.load_ratio_range));
  EXPECT_EQ(a.load_ratio_change, b.load_ratio_change);
  EXPECT_EQ(a.contact_model, b.contact_model);
  expect_same_several(a.several, b.several);
  expect_same_equilibrium(a.equilibrium, b.equilibrium);
}

TEST(FacadeProperties, a_robot_of_cells_is_checked_as_the_same_of_a_file_in_every_field) {
  for (std::uint64_t seed = 0; seed < kRobotCount; ++seed) {
    const model::RobotSpec spec = test::random_robot(seed);
    const auto robot = robot_of(spec);
    const auto structure = load_text(file_of(spec));
    ASSERT_TRUE(robot) << robot.error().message;
    ASSERT_TRUE(structure) << structure.error().message;
    SCOPED_TRACE(seed);
    expect_same(check(robot.value()), check(structure.value()));
    expect_same(check(robot.value(), {.is_bonded = true, .thread_count = 2}),
                check(structure.value(), {.is_bonded = true, .thread_count = 1}));
  }
}

TEST(FacadeProperties, a_report_has_the_rows_of_the_check_digit_by_digit) {
  constexpr std::array<const char*, 5> kKeys = {"load_ratio", "axial_n", "bending_nmm", "shear_n",
                                                "torsion_nmm"};
  for (std::uint64_t seed = 0; seed < kRobotCount; ++seed) {
    const auto structure = load_text(file_of(test::random_robot(seed)));
    ASSERT_TRUE(structure) << structure.error().message;
    const CheckResult result = check(structure.value());
    const Json report = Json::parse(report_json(structure.value(), result));
    const Rows rows = connection_rows(result);
    ASSERT_EQ(report["connections"].size(), rows.count());
    for (std::size_t i = 0; i < rows.count(); ++i) {
      const auto [a, b] = model::ends(structure.value().robot, i);
      EXPECT_EQ(report["connections"][i]["a"], Json({a.x, a.y, a.z}));
      EXPECT_EQ(report["connections"][i]["b"], Json({b.x, b.y, b.z}));
      for (std::size_t k = 0; k < kKeys.size(); ++k) {
        EXPECT_EQ(report["connections"][i][kKeys[k]], rows.row(i)[k]) << kKeys[k];
      }
    }
  }
}

/// Statics: forces of the ground and weight cancel, and so do their moments about the x and y axes.
/// Robots here are small, so the direct solver's balance is that of rounding and weak springs,
/// which are springs to the ground as well and part of its forces.
TEST(FacadeProperties, the_ground_carries_the_weight_where_it_is) {
  int seen = 0;
  for (std::uint64_t seed = 0; seed < kRobotCount; ++seed) {
    const auto robot = robot_of(test::random_robot(seed));
    ASSERT_TRUE(robot) << robot.error().message;
    const CheckResult result = check(robot.value());
    const bool is_known = result.assessment.is_stable && result.assessment.model.is_settled;
    if (!is_known || robot.value().fixed_count() > 0) {
      continue;
    }
    ++seen;
    const double pitch = robot.value().material().pitch_mm;
    const double weight = model::module_weight_n(robot.value().material());
    std::array<double, 5> left{};  // Forces along x, y, z, moments about x, y.
    const auto ground = ground_forces(robot.value(), result);
    ASSERT_EQ(ground.size(), robot.value().modules().size());
    for (std::size_t i = 0; i < ground.size(); ++i) {
      const base::Cell& cell = robot.value().modules()[i].cell;
      const base::Vec6<double>& force = ground[i];
      const double up = force[2] - weight;
      left[0] += force[0];
      left[1] += force[1];
      left[2] += up;
      left[3] += force[3] + pitch * (cell.y * up - cell.z * force[1]);
      left[4] += force[4] + pitch * (cell.z * force[0] - cell.x * up);
    }
    const double all = weight * static_cast<double>(ground.size());
    for (std::size_t k = 0; k < left.size(); ++k) {
      EXPECT_NEAR(left[k], 0, 1e-6 * all * (k < 3 ? 1 : 10 * pitch)) << seed << ", " << k;
    }
  }
  EXPECT_GT(seen, 10);
}

struct Fault {
  std::vector<base::Cell> existing;
  std::vector<base::Cell> planned;
  std::vector<base::Cell> fixed;
  const char* cell;  ///< That the error must name.
  const char* rule;
};

TEST(FacadeProperties, an_error_names_the_cell_and_the_rule) {
  const std::vector<Fault> faults = {
      {{{0, 0, 0}, {1, 0, 0}, {1, 0, 0}}, {}, {}, "(1,0,0)", "listed twice"},
      {{{0, 0, 0}, {5, 0, 0}}, {}, {}, "(5,0,0)", "not connected"},
      {{{0, 0, 0}, {3'000'000, 0, 0}}, {}, {}, "(3000000,0,0)", "outside the lattice"},
      {{{0, 0, 0}, {0, 0, 1}}, {{0, 0, 1}}, {}, "(0,0,1)", "occupied by an existing module"},
      {{{0, 0, 0}}, {{0, 0, 1}, {0, 0, 1}}, {}, "(0,0,1)", "planned twice"},
      {{{0, 0, 0}}, {{0, 0, 1}, {0, 4, 2}}, {}, "(0,4,2)", "is not next to the robot"},
      {{{0, 0, 0}}, {}, {{0, 0, 1}}, "(0,0,1)", "holds no existing module"},
      {{{0, 0, 4}, {0, 0, 3}}, {}, {}, "(0,0,3)", "nothing holds the robot"},
      {{{0, 0, 0}, {0, 0, -1}}, {}, {}, "(0,0,-1)", "below the ground"}};
  for (const Fault& fault : faults) {
    const auto robot =
        make_robot({.existing = fault.existing, .planned = fault.planned, .fixed = fault.fixed});
    ASSERT_FALSE(robot) << fault.rule;
    EXPECT_EQ(robot.error().code, base::ErrorCode::kBadInput);
    const std::string& message = robot.error().message;
    EXPECT_NE(message.find(fault.cell), std::string::npos) << message;
    EXPECT_NE(message.find(fault.rule), std::string::npos) << message;
  }
}

}  // namespace
}  // namespace holdfast
