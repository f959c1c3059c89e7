// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
//
// The rigid body on flat ground. Expected values: closed forms, the margins of the paper's own
// structures as computed independently of this project (six decimals in mm), a brute-force search
// for the lines that support all corners, and the other method of Sec. III-B, safe angles. Lengths
// in mm; a cell is 40 wide and cell (0,0) is centred on the origin.
#include "holdfast/verdict/rigid_body.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <utility>

#include "brute_force.hpp"
#include "general_robot.hpp"
#include "holdfast/mechanics/safe_angles.hpp"
#include "random_robot.hpp"

namespace holdfast::verdict {
namespace {

using namespace holdfast::test;
using base::Cell;
using model::Robot;
using model::RobotSpec;

constexpr double kLengthRounding = 1e-9;  // mm, for lengths up to some thousand

Robot make(const RobotSpec& spec) {
  auto robot = Robot::create(spec);
  EXPECT_TRUE(robot.has_value()) << robot.error().message;
  return std::move(robot).value();
}

RigidBody assess(const RobotSpec& spec) { return assess_rigid_body(make(spec)); }

void expect_edge(const RigidBody& body, const PlanPoint& a, const PlanPoint& b) {
  ASSERT_TRUE(body.edge);
  EXPECT_NEAR((*body.edge)[0].x, a.x, kLengthRounding);
  EXPECT_NEAR((*body.edge)[0].y, a.y, kLengthRounding);
  EXPECT_NEAR((*body.edge)[1].x, b.x, kLengthRounding);
  EXPECT_NEAR((*body.edge)[1].y, b.y, kLengthRounding);
}

/// Three feet in an L, whose polygon has a diagonal edge from (60, 20) to (20, 60), and a tower of
/// eight modules in all whose centre of mass, (9/8, 7/8) cells, lies exactly over it: the sum of
/// x + y is 16 and the edge's line is x + y = 2.
const std::vector<Cell> kDiagonalTie = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 0, 1},
                                        {1, 1, 1}, {2, 1, 1}, {2, 2, 1}, {2, 2, 2}};

std::vector<Cell> with(std::vector<Cell> cells, std::initializer_list<Cell> more) {
  cells.insert(cells.end(), more);
  return cells;
}

TEST(RigidBody, that_is_a_single_module_has_half_a_cell_to_spare) {
  const RigidBody body = assess({.existing = {{3, -2, 0}}});
  EXPECT_TRUE(body.is_stable);
  EXPECT_NEAR(*body.margin_mm, 20, kLengthRounding);
  EXPECT_NEAR(body.centre_of_mass.x, 120, kLengthRounding);
  EXPECT_NEAR(body.centre_of_mass.y, -80, kLengthRounding);
  EXPECT_EQ(body.polygon.size(), 4U);
}

/// The structures of Fig. 6, planned modules included.
TEST(RigidBody, of_the_published_structures_has_the_reference_margins) {
  const RobotSpec arm_a = {
      .existing =
          {{1, 1, 0}, {2, 1, 0}, {1, 1, 1}, {2, 1, 1}, {1, 1, 2}, {2, 1, 2}, {3, 1, 2}, {4, 1, 2}},
      .planned = {{5, 1, 2}}};
  const RobotSpec arm_c = {.existing = with(arm_a.existing, {{5, 1, 2}, {6, 1, 2}})};
  const RobotSpec bush_a = {.existing = {{1, 1, 0},
                                         {2, 1, 0},
                                         {2, 2, 0},
                                         {2, 1, 1},
                                         {2, 1, 2},
                                         {2, 1, 3},
                                         {3, 1, 3},
                                         {3, 2, 3},
                                         {3, 3, 3}},
                            .planned = {{4, 3, 3}}};
  const RobotSpec crane_a = {.existing = {{1, 1, 0},
                                          {1, 2, 0},
                                          {2, 1, 0},
                                          {1, 1, 1},
                                          {1, 1, 2},
                                          {2, 1, 2},
                                          {2, 2, 2},
                                          {3, 2, 2},
                                          {3, 3, 2}},
                             .planned = {{4, 3, 2}}};
  const RobotSpec crane_b = {.existing = with(crane_a.existing, {{4, 3, 2}}),
                             .planned = {{4, 4, 2}}};
  const std::pair<RobotSpec, double> cases[] = {
      {arm_a, 6.666667}, {arm_c, -8}, {bush_a, 4}, {crane_a, 8.485281}, {crane_b, -2.571297}};
  for (const auto& [spec, margin] : cases) {
    const RigidBody body = assess(spec);
    EXPECT_NEAR(*body.margin_mm, margin, 6e-7);
    EXPECT_EQ(body.is_stable, margin > 0);
  }
}

/// One foot with an arm to each side: the centre of mass lies 3/4 cell out, 10 mm beyond the edge.
TEST(RigidBody, names_the_edge_that_it_topples_over_with_the_polygon_on_its_left) {
  const auto arm = [](int x, int y) {
    return assess({.existing = {{0, 0, 0}, {0, 0, 1}, {x, y, 1}, {2 * x, 2 * y, 1}}});
  };
  expect_edge(arm(1, 0), {20, -20}, {20, 20});
  expect_edge(arm(0, 1), {20, 20}, {-20, 20});
  expect_edge(arm(-1, 0), {-20, 20}, {-20, -20});
  expect_edge(arm(0, -1), {-20, -20}, {20, -20});
  for (const auto& [x, y] : {std::pair{1, 0}, {0, 1}, {-1, 0}, {0, -1}}) {
    EXPECT_FALSE(arm(x, y).is_stable);
    EXPECT_NEAR(*arm(x, y).margin_mm, -10, kLengthRounding);
  }
}

/// The mean x is 2/4 = 1/2 cell: exactly over the edge x = 20 mm.
TEST(RigidBody, with_its_mass_exactly_over_an_edge_is_not_stable) {
  const RigidBody body = assess({.existing = {{0, 0, 0}, {0, 0, 1}, {1, 0, 1}, {1, 0, 2}}});
  EXPECT_FALSE(body.is_stable);
  EXPECT_EQ(*body.margin_mm, 0);
  expect_edge(body, {20, -20}, {20, 20});
}

/// The second tower has nine modules at (10/9, 8/9) cells, which double cannot hold. Both also at
/// the far end of the lattice.
TEST(RigidBody, recognises_a_tie_exactly_on_a_diagonal_and_far_away) {
  std::vector<Cell> ninths = with(kDiagonalTie, {{2, 1, 2}, {1, 2, 1}});
  std::erase(ninths, Cell{2, 2, 2});
  for (std::vector<Cell> cells : {kDiagonalTie, ninths}) {
    for (const std::int32_t shift : {0, 999'990}) {
      for (Cell& cell : cells) {
        cell.x += shift;
        cell.y -= shift;
      }
      const RigidBody body = assess({.existing = cells});
      EXPECT_FALSE(body.is_stable);
      EXPECT_EQ(*body.margin_mm, 0);
      const double mm = 40.0 * shift;
      // Doubles near 4e7 mm are 7e-9 apart.
      EXPECT_NEAR((*body.edge)[0].x, 60 + mm, 1e-7);
      EXPECT_NEAR((*body.edge)[1].y, 60 - mm, 1e-7);
    }
  }
}

/// One module more or less shifts the mean of x + y off 2 cells; a diagonal is 1 / sqrt(2) closer.
TEST(RigidBody, measures_its_margin_at_right_angles_to_a_diagonal_edge) {
  const RigidBody beyond = assess({.existing = with(kDiagonalTie, {{3, 2, 1}})});
  EXPECT_FALSE(beyond.is_stable);
  EXPECT_NEAR(*beyond.margin_mm, 40 * (2 - 21.0 / 9) / std::sqrt(2), kLengthRounding);
  expect_edge(beyond, {60, 20}, {20, 60});
  const RigidBody within = assess({.existing = with(kDiagonalTie, {{1, 0, 2}})});
  EXPECT_TRUE(within.is_stable);
  EXPECT_NEAR(*within.margin_mm, 40 * (2 - 17.0 / 9) / std::sqrt(2), kLengthRounding);
  expect_edge(within, {60, 20}, {20, 60});
}

/// Mass at (1, 2/3) cells over a foot of half a cell: 20 mm beyond one edge, 6.7 mm beyond the
/// other, and farther than either from the corner. The weight tips over the first.
TEST(RigidBody, measures_beyond_a_corner_to_the_line_of_the_worse_edge) {
  const RigidBody body =
      assess({.existing = {{0, 0, 0}, {0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {2, 1, 1}, {2, 2, 1}}});
  EXPECT_NEAR(*body.margin_mm, -20, kLengthRounding);
  expect_edge(body, {20, -20}, {20, 20});
}

/// Two arms of a = 60 000 modules in an L. The mean of x is m = a (a - 1) / 2 / (2 a - 1) cells, so
/// the inner edges are m + 1/2 cells away, and nearer than the diagonal. Coordinates times count
/// reach 1.4e10, their products 2e20, beyond 64 bits.
TEST(RigidBody, is_decided_exactly_for_large_robots) {
  const std::int32_t a = 60'000;
  RobotSpec spec = {.existing = {{0, 0, 0}}};
  for (std::int32_t i = 1; i < a; ++i) {
    spec.existing.push_back({i, 0, 0});
    spec.existing.push_back({0, i, 0});
  }
  const RigidBody body = assess(spec);
  EXPECT_TRUE(body.is_stable);
  EXPECT_EQ(body.polygon.size(), 5U);
  const double mean = static_cast<double>(a) * (a - 1) / 2 / (2 * a - 1);
  EXPECT_NEAR(*body.margin_mm, 40 * (mean + 0.5), 1e-9 * 40 * mean);
}

TEST(RigidBody, that_is_fixed_is_stable_without_a_margin) {
  const RigidBody body =
      assess({.existing = {{0, 0, 0}, {0, 0, 1}, {1, 0, 1}, {2, 0, 1}}, .fixed = {{1, 0, 1}}});
  EXPECT_TRUE(body.is_stable);
  EXPECT_FALSE(body.margin_mm);
  EXPECT_FALSE(body.edge);
  EXPECT_EQ(body.polygon.size(), 4U);
}

TEST(RigidBody, that_is_fixed_needs_no_ground) {
  const RigidBody body =
      assess({.existing = {{0, 0, 5}, {2, 0, 5}, {1, 0, 5}}, .fixed = {{0, 0, 5}}});
  EXPECT_TRUE(body.is_stable);
  EXPECT_FALSE(body.margin_mm);
  EXPECT_TRUE(body.polygon.empty());
  EXPECT_NEAR(body.centre_of_mass.x, 40, kLengthRounding);
}

TEST(RigidBody, weighs_planned_modules_and_stands_on_them) {
  const std::vector<Cell> tower = {{0, 0, 0}, {0, 0, 1}, {1, 0, 1}, {2, 0, 1}};
  EXPECT_FALSE(assess({.existing = tower}).is_stable);
  // Mean x is 5/5: the foot at x = 2 widens the polygon to 100 mm.
  const RigidBody body = assess({.existing = tower, .planned = {{2, 0, 0}}});
  EXPECT_TRUE(body.is_stable);
  EXPECT_NEAR(*body.margin_mm, 20, kLengthRounding);
}

TEST(RigidBody, has_the_margin_of_the_nearest_line_that_supports_all_corners) {
  for (std::uint64_t seed = 0; seed < 300; ++seed) {
    const Robot robot = make(random_robot(seed));
    const RigidBody body = assess_rigid_body(robot);
    PlanPoint mass;
    for (const model::Module& module : robot.modules()) {
      mass.x += 40.0 * module.cell.x / static_cast<double>(robot.modules().size());
      mass.y += 40.0 * module.cell.y / static_cast<double>(robot.modules().size());
    }
    EXPECT_NEAR(body.centre_of_mass.x, mass.x, kLengthRounding);
    EXPECT_NEAR(body.centre_of_mass.y, mass.y, kLengthRounding);
    EXPECT_NEAR(*body.margin_mm, margin_by_brute_force(corners_of(robot), mass), kLengthRounding)
        << "seed " << seed;
    const auto& [a, b] = *body.edge;
    EXPECT_NEAR(turn(a, b, mass) / std::hypot(b.x - a.x, b.y - a.y), *body.margin_mm,
                kLengthRounding);
  }
}

/// The hull is counter-clockwise and strictly convex, and has every corner of every foot inside or
/// on it.
TEST(RigidBody, stands_on_the_convex_hull_of_its_feet) {
  for (std::uint64_t seed = 0; seed < 300; ++seed) {
    const Robot robot = make(random_robot(seed));
    const auto polygon = assess_rigid_body(robot).polygon;
    const std::size_t n = polygon.size();
    ASSERT_GE(n, 4U);
    for (std::size_t i = 0; i < n; ++i) {
      const PlanPoint& a = polygon[i];
      const PlanPoint& b = polygon[(i + 1) % n];
      EXPECT_GT(turn(a, b, polygon[(i + 2) % n]), 1) << "seed " << seed;
      for (const PlanPoint& corner : corners_of(robot)) {
        EXPECT_GT(turn(a, b, corner), -1) << "seed " << seed;  // mm^2, of at least 1600
      }
    }
  }
}

/// All coordinates are integers if scaled by twice the number of modules, so ties agree as well.
TEST(RigidBody, agrees_with_the_safe_angles_of_its_feet) {
  int stable_count = 0;
  for (std::uint64_t seed = 0; seed < 2000; ++seed) {
    const Robot robot = make(random_robot(seed));
    const auto n = static_cast<double>(robot.modules().size());
    double mass_x = 0;
    double mass_y = 0;
    for (const model::Module& module : robot.modules()) {
      mass_x += 2 * module.cell.x;
      mass_y += 2 * module.cell.y;
    }
    mechanics::SafeAngles<double> angles;
    for (const model::Module& module : robot.modules()) {
      if (module.support == model::Support::kGround) {
        const mechanics::PlanVector<double> foot = {2 * module.cell.x * n - mass_x,
                                                    2 * module.cell.y * n - mass_y};
        angles = mechanics::merge(angles, mechanics::safe_angles(foot, n));
      }
    }
    const bool is_stable = assess_rigid_body(robot).is_stable;
    EXPECT_EQ(is_stable, angles.range == mechanics::SafeRange::kFull) << "seed " << seed;
    stable_count += is_stable ? 1 : 0;
  }
  EXPECT_GT(stable_count, 500);
  EXPECT_LT(stable_count, 1900);
}

/// A post with an arm to +x whose centre of mass lies `sum` / 8 cells from its foot's middle.
RobotSpec leaning_post(double pitch, double facet) {
  return {
      .existing =
          {{0, 0, 0}, {0, 0, 1}, {0, 0, 2}, {0, 0, 3}, {0, 0, 4}, {1, 0, 4}, {2, 0, 4}, {0, 0, 5}},
      .material = {.pitch_mm = pitch, .facet_mm = facet}};
}

/// The centre of mass is 3/8 of a pitch off the middle, the edge half a facet: with a facet of 3/4
/// of the pitch nothing is left, and one more or less in the last bit of the double decides.
TEST(RigidBody, is_exact_for_facets_that_are_not_as_wide_as_the_pitch) {
  // Of numbers with 24 bits, 4 and 3 times them are doubles without rounding.
  for (const float quarter : {10.0F, 0.1F, 1.0F / 3, 2.5e-4F, 2.5e11F}) {
    const double pitch = 4 * static_cast<double>(quarter);
    const double tie = 3 * static_cast<double>(quarter);
    const RigidBody none = assess(leaning_post(pitch, tie));
    EXPECT_FALSE(none.is_stable) << pitch;
    EXPECT_EQ(*none.margin_mm, 0) << pitch;
    const RigidBody less = assess(leaning_post(pitch, std::nextafter(tie, 0)));
    EXPECT_FALSE(less.is_stable) << pitch;
    EXPECT_LT(*less.margin_mm, 0) << pitch;
    const RigidBody more = assess(leaning_post(pitch, std::nextafter(tie, pitch)));
    EXPECT_TRUE(more.is_stable) << pitch;
    EXPECT_GT(*more.margin_mm, 0) << pitch;
    EXPECT_LT(*more.margin_mm, 1e-15 * pitch) << pitch;
  }
}

/// The facet may be any share of the pitch, such as a third, which is no multiple of a 4096th.
TEST(RigidBody, has_the_margin_of_any_facet_to_the_last_digits) {
  for (const double facet : {10.0, 29.0, 30.0, 31.0, 45.0, 1e-12, 1e12}) {
    const RobotSpec spec{.existing = {{0, 0, 0}, {0, 0, 1}},
                         .material = {.pitch_mm = 30, .facet_mm = facet}};
    const RigidBody body = assess(spec);
    EXPECT_TRUE(body.is_stable);
    EXPECT_NEAR(*body.margin_mm, facet / 2, 1e-15 * facet);
    EXPECT_NEAR(body.polygon[2].x, facet / 2, 1e-15 * facet);
  }
  // Far beyond the 64 bits that quotients of this size once had to fit in.
  const RobotSpec wide{.existing = {{0, 0, 0}, {1, 0, 0}, {1, 0, 1}},
                       .material = {.pitch_mm = 1e-12, .facet_mm = 1e12}};
  EXPECT_TRUE(assess(wide).is_stable);
  EXPECT_NEAR(*assess(wide).margin_mm, 5e11, 1e-3);
}

/// Against a robot that is made without the foot, or without the module.
void expect_margins_without_each(const model::RobotSpec& spec, std::size_t& compared_count) {
  const auto robot = model::Robot::create(spec);
  if (!robot || !is_on_flat_floor(robot.value()) || robot.value().facets().size() < 2) {
    return;
  }
  const ShrinkingRigidBody shrinking(robot.value());
  const auto expect_like = [&](const model::RobotSpec& rest, std::optional<std::size_t> module,
                               const std::vector<std::size_t>& lost) {
    const auto other = model::Robot::create(rest);
    const auto expected = other ? assess_rigid_body(other.value()).margin_mm : std::nullopt;
    if (!expected) {
      return;
    }
    const auto found = shrinking.margin_mm_without(module, lost);
    ASSERT_TRUE(found);
    EXPECT_LE(*found, *expected);
    EXPECT_NEAR(*found, *expected, 2e-6 * robot.value().material().pitch_mm);
    ++compared_count;
  };
  for (std::size_t i = 0; i < robot.value().modules().size(); ++i) {
    const Cell cell = robot.value().modules()[i].cell;
    std::vector<std::size_t> lost;
    for (std::size_t k = 0; k < robot.value().facets().size(); ++k) {
      if (base::at(robot.value().facets()[k].module) == i) {
        lost.push_back(k);
        model::RobotSpec rest = spec;
        rest.lost_facets.push_back({cell, robot.value().facets()[k].direction});
        expect_like(rest, std::nullopt, lost);
      }
    }
    model::RobotSpec rest = spec;
    std::erase(rest.existing, cell);
    std::erase(rest.planned, cell);
    expect_like(rest, i, lost);
  }
}

TEST(ShrinkingRigidBody, has_the_margin_of_the_robot_without_a_foot_or_module) {
  std::size_t compared_count = 0;
  for (std::uint64_t seed = 0; seed < 60; ++seed) {
    expect_margins_without_each(test::random_robot(seed), compared_count);
    expect_margins_without_each(test::general_robot(test::kLattices[seed % 4], seed),
                                compared_count);
  }
  EXPECT_GT(compared_count, 500U);
}

TEST(GrowingRigidBody, is_that_of_the_grown_robot_to_the_last_digit) {
  for (std::uint64_t seed = 0; seed < 40; ++seed) {
    const model::RobotSpec spec = test::random_robot(seed);
    const auto robot = model::Robot::create(spec).value();
    const GrowingRigidBody growing(robot, robot.mass(0));
    for (const model::Module& module : robot.modules()) {
      for (const base::Direction direction : base::directions(robot.lattice())) {
        model::RobotSpec grown = spec;
        grown.planned.push_back(base::neighbour(robot.lattice(), module.cell, direction));
        const auto other = model::Robot::create(grown);
        if (!other) {
          continue;
        }
        const RigidBody expected = assess_rigid_body(other.value());
        const base::Cell& cell = grown.planned.back();
        const RigidBody body = growing.with(cell, cell.z == robot.support_z());
        EXPECT_EQ(body.is_stable, expected.is_stable);
        EXPECT_EQ(body.margin_mm, expected.margin_mm);
      }
    }
  }
}

}  // namespace
}  // namespace holdfast::verdict
