// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
//
// Robots on level floors with friction: how far gravity may turn, what slips, and what leans.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <set>

#include "general_robot.hpp"
#include "holdfast/base/rng.hpp"
#include "holdfast/model/lattice_beam.hpp"
#include "holdfast/model/mass.hpp"
#include "holdfast/verdict/assessment.hpp"
#include "seeds.hpp"

namespace holdfast::verdict {
namespace {

using base::Cell;
using model::RobotSpec;

constexpr double kDegree = std::numbers::pi / 180;

/// The robot under gravity that is turned out of straight down, towards a direction in plan.
RobotSpec tilted(RobotSpec spec, double degrees, double towards) {
  const double g = spec.material.gravity_m_s2;
  const double across = g * std::sin(degrees * kDegree);
  spec.gravity_m_s2 = {across * std::cos(towards), across * std::sin(towards),
                       -g * std::cos(degrees * kDegree)};
  return spec;
}

bool holds(const RobotSpec& spec) {
  return assess_rigidly(model::Robot::create(spec).value(), false).rigid.holds();
}

double tilt_of(const RobotSpec& spec) {
  return *assess_rigidly(model::Robot::create(spec).value()).rigid.tilt_margin_deg;
}

RobotSpec tower(int height, double friction) {
  RobotSpec spec{.floor = {.friction = friction}};
  for (int z = 0; z < height; ++z) {
    spec.existing.push_back({0, 0, z});
  }
  return spec;
}

/// A cube slides at atan(mu), a tower of n tips at atan(1 / n).
TEST(TiltOnAFloor, is_the_smaller_of_sliding_and_tipping) {
  for (const double friction : {0.0, 0.1, 0.3, 1.0, 5.0}) {
    for (const int height : {1, 2, 5, 20}) {
      const double expected = std::atan(std::min(friction, 1.0 / height)) / kDegree;
      EXPECT_NEAR(tilt_of(tower(height, friction)), expected, 1e-9) << friction << ' ' << height;
    }
  }
  const RobotSpec on_obstacle{
      .existing = {{0, 0, 0}},
      .support_z = std::nullopt,
      .obstacles = {{.from = {}, .to = {}, .cells = {{0, 0, -1}}, .touch = {.friction = 0.3}}}};
  EXPECT_NEAR(tilt_of(on_obstacle), std::atan(0.3) / kDegree, 1e-9);
}

/// The cone of contact forces knows no polygon: tilted by a hair less in any direction the robot
/// holds; by a hair more it falls, over its edge or, as it slides, in every direction.
TEST(TiltOnAFloor, is_where_contact_forces_end) {
  constexpr double kHair = 1e-4;  // So near to a cone's side its margin is known.
  int count = 0;
  for (int seed = 0; seed < test::campaign(40); ++seed) {
    for (const base::Lattice& lattice : test::kLattices) {
      RobotSpec spec =
          test::on_a_floor(test::general_robot(lattice, static_cast<std::uint64_t>(seed)), false);
      const double friction = seed % 2 == 0 ? 0.3 : 0.5;
      spec.floor.friction = friction;
      const Assessment found = assess_rigidly(model::Robot::create(spec).value());
      if (!found.rigid.holds()) {
        continue;
      }
      SCOPED_TRACE(::testing::Message() << lattice.direction_count << ", seed " << seed);
      ++count;
      const double tilt = *found.rigid.tilt_margin_deg;
      EXPECT_LE(tilt, std::atan(friction) / kDegree * (1 + 1e-15));
      const auto& [a, b] = *found.simplified.edge;
      const double over_edge = std::atan2(a.x - b.x, b.y - a.y);
      for (int i = 0; i < 8; ++i) {
        EXPECT_TRUE(holds(tilted(spec, tilt * (1 - kHair), over_edge + i * 45 * kDegree))) << i;
      }
      EXPECT_FALSE(holds(tilted(spec, tilt * (1 + kHair), over_edge)));
    }
  }
  EXPECT_GE(count, test::least(10));
}

/// The tilt of feet that differ in friction lies between those of the least and the most, and is no
/// more than what holds.
TEST(TiltOnAFloor, of_several_frictions_is_no_more_than_what_holds) {
  RobotSpec spec{.support_z = std::nullopt};
  for (int x = 0; x < 3; ++x) {
    spec.existing.push_back({x, 0, 0});
    spec.existing.push_back({x, 1, 0});
  }
  spec.obstacles = {
      {.from = {}, .to = {}, .cells = {{0, 0, -1}, {0, 1, -1}}, .touch = {.friction = 0.1}},
      {.from = {}, .to = {}, .cells = {{2, 0, -1}, {2, 1, -1}}, .touch = {.friction = 0.5}}};
  const double tilt = tilt_of(spec);
  EXPECT_GT(tilt, std::atan(0.1) / kDegree * 1.01);
  EXPECT_LT(tilt, std::atan(0.5) / kDegree * 0.99);
  bool does_any_fall = false;
  for (int i = 0; i < 72; ++i) {
    EXPECT_TRUE(holds(tilted(spec, tilt * (1 - 1e-8), 5 * i * kDegree))) << i;
    does_any_fall = does_any_fall || !holds(tilted(spec, tilt * 1.02, 5 * i * kDegree));
  }
  EXPECT_TRUE(does_any_fall);
}

RobotSpec with_all_friction(RobotSpec spec, double friction) {
  for (model::Obstacle& obstacle : spec.obstacles) {
    obstacle.touch.friction = friction;
  }
  return spec;
}

/// The friction needed holds, what is smaller by more than its accuracy does not, and the order of
/// modules changes it by no more than that.
TEST(FrictionNeeded, is_enough_and_hardly_more) {
  int count = 0;
  for (int seed = 0; seed < test::campaign(200); ++seed) {
    for (const base::Lattice& lattice : test::kLattices) {
      RobotSpec spec = test::general_robot(lattice, static_cast<std::uint64_t>(seed));
      const auto robot = model::Robot::create(spec);
      if (!robot || robot.value().fixed_count() > 0 || robot.value().has_bonded_facets()) {
        continue;
      }
      SCOPED_TRACE(::testing::Message() << lattice.direction_count << ", seed " << seed);
      const auto needed = assess_rigidly(robot.value()).rigid.friction_needed;
      std::ranges::reverse(spec.existing);
      const auto turned = assess_rigidly(model::Robot::create(spec).value()).rigid.friction_needed;
      EXPECT_EQ(needed.has_value(), turned.has_value());
      if (!needed || !turned) {
        continue;
      }
      EXPECT_NEAR(*needed, *turned, 2 * limit::kFrictionAccuracy * *needed);
      std::ranges::reverse(spec.existing);
      EXPECT_TRUE(*needed == 0 || holds(with_all_friction(spec, *needed)));
      if (*needed > limit::kFrictionLeast * 1.01) {
        ++count;
        const double less = *needed * (1 - 2 * limit::kFrictionAccuracy);
        EXPECT_FALSE(holds(with_all_friction(spec, less)));
      }
    }
  }
  EXPECT_GE(count, test::least(5));
}

/// Two wedges of the file that gave 2.2e-5 or 1.3e-4 by the order of modules.
TEST(FrictionNeeded, between_what_is_pressed_apart_does_not_depend_on_order) {
  RobotSpec spec{
      .existing = {{11, 5, -12}, {11, 5, -13}, {11, 5, -14}},
      .support_z = std::nullopt,
      .lattice = base::kHexagonal,
      .obstacles = {{.from = {}, .to = {}, .cells = {{10, 5, -12}}, .touch = {.friction = 0.4}},
                    {.from = {}, .to = {}, .cells = {{12, 5, -13}}, .touch = {.friction = 0.4}},
                    {.from = {}, .to = {}, .cells = {{12, 5, -12}}, .touch = {.friction = 0.2}},
                    {.from = {}, .to = {}, .cells = {{10, 5, -14}}, .touch = {}}}};
  std::set<double> found;
  do {
    const auto needed = assess_rigidly(model::Robot::create(spec).value()).rigid.friction_needed;
    ASSERT_TRUE(needed);
    EXPECT_TRUE(holds(with_all_friction(spec, *needed)));
    found.insert(*needed);
  } while (std::ranges::next_permutation(spec.existing).found);
  EXPECT_LE(*found.rbegin(), *found.begin() * (1 + 2 * limit::kFrictionAccuracy));
}

/// A layer of modules that all stand, grown at random: each carries its own weight down.
RobotSpec layer(const base::Lattice& lattice, std::uint64_t seed, std::size_t count) {
  base::Rng rng(seed);
  RobotSpec spec{.existing = {{0, 0, 0}}, .lattice = lattice};
  std::set<Cell> taken = {{0, 0, 0}};
  while (spec.existing.size() < count) {
    const Cell from = spec.existing[rng.below(spec.existing.size())];
    const Cell cell = base::neighbour(lattice, from,
                                      static_cast<base::Direction>(rng.below(
                                          static_cast<std::uint64_t>(lattice.direction_count))));
    if (cell.z == 0 && taken.insert(cell).second) {
      spec.existing.push_back(cell);
    }
  }
  return spec;
}

/// Nothing pushes sideways, whatever the scale: what a solver leaves is rounding, and no slip.
TEST(SmoothFloor, holds_what_nothing_pushes_sideways) {
  for (int seed = 0; seed < test::campaign(10); ++seed) {
    for (const base::Lattice& lattice : test::kLattices) {
      for (const double pitch : {1.0, 40.0, 1000.0}) {
        const std::size_t count = seed == 0 ? 150 : 2 + static_cast<std::size_t>(seed);
        RobotSpec spec = layer(lattice, static_cast<std::uint64_t>(seed), count);
        spec.material.pitch_mm = pitch;
        spec.material.facet_mm = pitch;
        for (const double friction : {0.0, 1e-12}) {
          spec.floor.friction = friction;
          const Assessment found = assess(model::Robot::create(spec).value());
          EXPECT_EQ(found.verdict, Verdict::kSafe)
              << lattice.direction_count << ", seed " << seed << ", pitch " << pitch << ", "
              << friction << ' ' << name(found.reasons.front().code);
        }
      }
    }
  }
}

RobotSpec portal(double friction, std::int32_t x, std::int32_t y) {
  RobotSpec spec;
  for (int i = 0; i <= 6; ++i) {
    for (int z = i % 6 == 0 ? 0 : 3; z <= 3; ++z) {
      spec.existing.push_back({x * i, y * i, z});
    }
  }
  spec.floor.friction = friction;
  return spec;
}

/// The slab of a portal whose feet slip: the thrust is mu times half the weight, and by statics of
/// the left half the moment in the connection at 2.5 pitches follows from that, from the foot's own
/// moment and from weights. The verdict changes where it reaches the strength, however the portal
/// is turned.
TEST(SlipperyFloor, leaves_a_portal_the_thrust_of_its_friction) {
  for (const double friction : {0.0, 0.03, 0.1}) {
    RobotSpec spec = portal(friction, 1, 0);
    const double weight = model::module_weight_n(spec.material);
    const double pitch = spec.material.pitch_mm;
    const double thrust = friction * 6.5 * weight;
    const Assessment weak = assess(model::Robot::create(spec).value());
    const auto& foot = weak.equilibrium.facet_force.front();
    EXPECT_NEAR(foot[0], thrust, 1e-9);
    const double moment =
        foot[4] + pitch * weight * (6.5 * 2.5 - 3 * 2.5 - 2.5 - 1.5 - 0.5) - 3 * pitch * thrust;
    const double strength = 2 * std::abs(moment) / spec.material.facet_mm - thrust;
    spec.material.strength_vertical_n = 1e3;
    for (const auto& [x, y] :
         {std::pair(1, 0), std::pair(-1, 0), std::pair(0, 1), std::pair(0, -1)}) {
      spec.existing = portal(friction, x, y).existing;
      for (const double share : {1.001, 0.999}) {
        spec.material.strength_lateral_n = strength * share;
        const Assessment found = assess(model::Robot::create(spec).value());
        EXPECT_EQ(found.verdict, share > 1 ? Verdict::kSafe : Verdict::kOverload) << friction;
        EXPECT_NEAR(*found.load_ratio_max, 1 / share, 1e-9);
        EXPECT_EQ(std::ranges::count(found.reasons, ReasonCode::kFeetSlip, &Reason::code), 1);
        EXPECT_FALSE(found.equilibrium.slip.empty());
      }
    }
  }
}

/// A portal thrusts with 0.1237 of its pressure without slip: more friction changes nothing.
TEST(SlipperyFloor, that_holds_changes_nothing) {
  const Assessment rough = assess(model::Robot::create(portal(0.13, 1, 0)).value());
  RobotSpec spec = portal(0, 1, 0);
  spec.floor.friction = std::nullopt;
  const Assessment without = assess(model::Robot::create(spec).value());
  EXPECT_EQ(rough.equilibrium.displacement, without.equilibrium.displacement);
  EXPECT_TRUE(rough.equilibrium.slip.empty());
  EXPECT_EQ(rough.reasons, without.reasons);
}

/// A bar of two that is pushed slides at mu times its weight; below that it is safe, though its
/// elastic feet share the push unevenly, and they carry it together.
TEST(SlipperyFloor, holds_what_is_pushed_by_less_than_friction) {
  for (const double share : {0.5, 0.8, 0.95, 0.99, 1.01}) {
    RobotSpec bar{.existing = {{0, 0, 0}, {1, 0, 0}}};
    bar.floor.friction = 0.2;
    const double push = share * 0.2 * 2 * model::module_weight_n(bar.material);
    bar.payloads = {{.cell = {0, 0, 0}, .force_n = {push, 0, 0}}};
    const Assessment found = assess(model::Robot::create(bar).value());
    EXPECT_EQ(found.verdict, share < 1 ? Verdict::kSafe : Verdict::kUnstable) << share;
    if (share < 1) {
      const auto& forces = found.equilibrium.facet_force;
      EXPECT_NEAR(forces[0][0] + forces[1][0], -push, 1e-9) << share;
    }
  }
}

/// Expects that displacements, slips and forces of the feet are a solution: every module is in
/// balance, a foot's force is that of its spring less the slip, and Coulomb's law holds.
void expect_solution(const model::Robot& robot, const solver::Equilibrium& found) {
  const model::LatticeBeam<double> beam(model::beam_section(robot.material()), robot.lattice());
  const auto springs = mechanics::beam_stiffness(model::beam_section(robot.material()));
  const double weight = model::mass_of(robot).kg * -robot.gravity()[2];
  const double lever = robot.material().pitch_mm / 2;
  const double tie = 1e-8 * weight;
  std::vector<base::Vec6<double>> left(robot.modules().size());
  for (std::size_t i = 0; i < left.size(); ++i) {
    base::add_times(left[i], -1.0, robot.loads()[i]);
    for (const base::Direction direction : base::directions(robot.lattice())) {
      const std::int32_t other =
          robot.connected()[i][static_cast<std::size_t>(base::index(direction))];
      if (other != model::Robot::kNoNeighbour) {
        base::add_to(left[i], beam.end_force(direction, found.displacement[i],
                                             found.displacement[base::at(other)]));
      }
    }
  }
  for (std::size_t i = 0; i < robot.facets().size(); ++i) {
    const std::size_t module = base::at(robot.facets()[i].module);
    const auto& force = found.facet_force[i];
    const auto& u = found.displacement[module];
    const auto& slip = found.slip[i];
    base::add_times(left[module], -1.0, force);
    if (!found.contact[i].pressed) {
      continue;
    }
    EXPECT_NEAR(-force[0], springs.shear_x * (u[0] - lever * u[4] - slip[0]), tie);
    EXPECT_NEAR(-force[1], springs.shear_y * (u[1] + lever * u[3] - slip[1]), tie);
    const double sideways = std::hypot(force[0], force[1]);
    const double most = *robot.facets()[i].touch.friction * force[2];
    const double way = std::hypot(slip[0], slip[1]);
    EXPECT_LE(sideways, most + tie);
    if (way > 0) {
      EXPECT_NEAR(sideways, most, tie);
      EXPECT_NEAR(-force[0] * slip[0] - force[1] * slip[1], most * way, tie * way);
    }
  }
  for (const auto& rest : left) {
    for (std::size_t k = 0; k < 6; ++k) {
      EXPECT_NEAR(rest[k], 0, tie * (k < 3 ? 1 : robot.material().pitch_mm));
    }
  }
}

/// Random robots slip by Coulomb's law, and at most one in a hundred is undecided for that.
TEST(SlipperyFloor, decides_random_robots_by_coulombs_law) {
  int slip_count = 0;
  int open_count = 0;
  int count = 0;
  for (int seed = 0; seed < test::campaign(300); ++seed) {
    for (const base::Lattice& lattice : test::kLattices) {
      RobotSpec spec =
          test::on_a_floor(test::general_robot(lattice, static_cast<std::uint64_t>(seed)), false);
      spec.fixed.clear();
      spec.floor.friction = std::array{1.0, 0.5, 0.3, 0.1}[static_cast<std::size_t>(seed % 4)];
      const auto robot = model::Robot::create(spec);
      if (!robot) {
        continue;
      }
      const Assessment found = assess(robot.value());
      ++count;
      open_count += found.reasons.front().code == ReasonCode::kMaySlip ? 1 : 0;
      if (found.equilibrium.slip.empty()) {
        continue;
      }
      ++slip_count;
      expect_solution(robot.value(), found.equilibrium);
    }
  }
  EXPECT_GE(slip_count, test::least(50));
  EXPECT_LE(100 * open_count, count);
}

/// The robot of 21 modules whose centre of mass the displacements take from 19.05 to 20.06 mm: the
/// edge is at 20.
RobotSpec leaning(double stiffness) {
  RobotSpec spec;
  for (int z = 0; z < 15; ++z) {
    spec.existing.push_back({0, 0, z});
  }
  for (const Cell& cell :
       std::vector<Cell>{{1, 0, 14}, {1, 0, 13}, {2, 0, 13}, {1, 0, 12}, {2, 0, 12}, {3, 0, 12}}) {
    spec.existing.push_back(cell);
  }
  spec.material.elastic_modulus_mpa *= stiffness;
  return spec;
}

TEST(DisplacedMass, over_the_edge_is_not_safe) {
  const Assessment found = assess(model::Robot::create(leaning(1)).value());
  EXPECT_EQ(found.verdict, Verdict::kUndecided);
  ASSERT_EQ(found.reasons.front().code, ReasonCode::kDisplacedMass);
  EXPECT_NEAR(found.reasons.front().numbers[0], 20.06 - 19.05, 0.01);
  EXPECT_NEAR(found.reasons.front().numbers[1], 20 - 19.05, 0.005);
  EXPECT_NEAR(found.reasons.front().numbers[2], 20.06 - 20, 0.005);
  EXPECT_FALSE(known_stability(found).has_value());
  const auto has_warning = [](const Assessment& assessment) {
    return std::ranges::count(assessment.reasons, ReasonCode::kMassMoves, &Reason::code);
  };
  // Half as far leaves some of the margin, a hundredth as far nearly all.
  const Assessment stiffer = assess(model::Robot::create(leaning(2)).value());
  EXPECT_EQ(stiffer.verdict, Verdict::kSafe);
  EXPECT_EQ(has_warning(stiffer), 1);
  const Assessment stiff = assess(model::Robot::create(leaning(100)).value());
  EXPECT_EQ(stiff.verdict, Verdict::kSafe);
  EXPECT_EQ(has_warning(stiff), 0);
}

/// Multigrid that stops early finds the mass where the direct solver finds it, within an error that
/// is taken off its margin, so it never calls a robot safe whose mass is beyond the edge. The
/// margin of the leaning robot without bending, less what bending takes of it, which goes as 1 / E,
/// is nothing at some E.
TEST(DisplacedMass, is_over_its_polygon_by_more_than_the_solver_may_be_off) {
  const Assessment soft = assess(model::Robot::create(leaning(1)).value());
  const double margin = *soft.simplified.margin_mm;
  const double edge = soft.lean->shift_mm / margin;
  for (const double share : {-0.5, -1e-2, -1e-4, -1e-6, 1e-6, 1e-4, 1e-2, 0.5}) {
    const model::Robot robot = model::Robot::create(leaning(edge * (1 + share))).value();
    const Assessment direct = assess(robot, {.method = solver::Method::kDirect});
    EXPECT_NEAR(direct.lean->margin_mm, margin * share / (1 + share), 1e-7) << share;
    EXPECT_EQ(direct.verdict, share > 0 ? Verdict::kSafe : Verdict::kUndecided) << share;
    for (const double tolerance : {1e-1, 1e-2, 1e-3, 1e-5, 1e-8}) {
      const Assessment rough =
          assess(robot, {.method = solver::Method::kMultigrid, .tolerance = tolerance});
      ASSERT_TRUE(rough.lean) << tolerance;
      EXPECT_LE(rough.lean->margin_mm, direct.lean->margin_mm) << share << " " << tolerance;
      EXPECT_TRUE(share > 0 || rough.verdict != Verdict::kSafe) << share << " " << tolerance;
    }
    const Assessment fine =
        assess(robot, {.method = solver::Method::kMultigrid, .tolerance = 1e-8});
    EXPECT_TRUE(share < 1e-3 || fine.verdict == Verdict::kSafe) << share;
  }
}

/// A random soft robot is never safe if its displaced mass is outside its polygon.
TEST(DisplacedMass, of_a_safe_robot_is_over_its_polygon) {
  int left_count = 0;
  for (int seed = 0; seed < test::campaign(60); ++seed) {
    for (const base::Lattice& lattice : test::kLattices) {
      RobotSpec spec =
          test::on_a_floor(test::general_robot(lattice, static_cast<std::uint64_t>(seed)), false);
      spec.material.elastic_modulus_mpa = seed % 3 == 0 ? 0.05 : 1;
      spec.material.strength_vertical_n = 1e6;
      spec.material.strength_lateral_n = 1e6;
      const model::Robot robot = model::Robot::create(spec).value();
      const Assessment found = assess(robot);
      if (!found.rigid.holds() || found.equilibrium.outcome != solver::Outcome::kSettled) {
        continue;
      }
      PlanPoint mass = found.simplified.centre_of_mass;
      double kg = 0;
      for (std::size_t i = 0; i < robot.modules().size(); ++i) {
        kg += robot.mass(i);
      }
      for (std::size_t i = 0; i < robot.modules().size(); ++i) {
        mass.x += robot.mass(i) / kg * found.equilibrium.displacement[i][0];
        mass.y += robot.mass(i) / kg * found.equilibrium.displacement[i][1];
      }
      bool is_inside = true;
      const auto& polygon = found.simplified.polygon;
      for (std::size_t i = 0; i < polygon.size(); ++i) {
        const auto& a = polygon[i];
        const auto& b = polygon[(i + 1) % polygon.size()];
        is_inside &= (b.x - a.x) * (mass.y - a.y) > (b.y - a.y) * (mass.x - a.x);
      }
      left_count += is_inside ? 0 : 1;
      EXPECT_TRUE(is_inside || found.verdict != Verdict::kSafe) << seed;
    }
  }
  EXPECT_GT(left_count, 0);
}

}  // namespace
}  // namespace holdfast::verdict
