// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
//
// Behind the loss of stability: the buckled column against the elastica in closed form, a tower
// that tips over its foot against statics, a flat arch that snaps through, and the equilibria found
// on random robots of all lattices against the sum of forces and the least energy.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include "general_robot.hpp"
#include "holdfast/base/rng.hpp"
#include "holdfast/large/follow.hpp"
#include "holdfast/model/large_beams.hpp"
#include "holdfast/model/lattice_beam.hpp"
#include "seeds.hpp"

namespace holdfast::large {
namespace {

constexpr double kCubePitch = 40;

model::Robot made(const model::RobotSpec& spec) {
  auto robot = model::Robot::create(spec, 1);
  EXPECT_TRUE(robot) << (robot ? "" : robot.error().message);
  return std::move(robot).value();
}

Path beyond(const model::RobotSpec& spec, double factor_max = 2) {
  return follow(made(spec),
                {.factor_max = factor_max, .is_followed_behind = true, .thread_count = 1});
}

/// A column without weight on a fixed module, that is not shortened, under `share` times Euler's
/// load.
model::RobotSpec loaded_column(int count, double share) {
  model::RobotSpec spec;
  for (int i = 0; i <= count; ++i) {
    spec.existing.push_back({0, 0, i});
  }
  spec.fixed = {spec.existing.front()};
  spec.support_z = {};
  spec.material.mass_kg = 1e-12;
  spec.material.section_area_mm2 *= 1e4;
  const double length = count * kCubePitch;
  const double load = share * std::numbers::pi * std::numbers::pi / 4 *
                      spec.material.elastic_modulus_mpa * spec.material.moment_y_mm4 /
                      (length * length);
  spec.payloads = {{.cell = spec.existing.back(), .force_n = {0, 0, -load}}};
  return spec;
}

/// The complete elliptic integrals K(k) and E(k), by the arithmetic-geometric mean.
std::pair<double, double> elliptic(double k) {
  double a = 1;
  double b = std::sqrt(1 - k * k);
  double c = k;
  double sum = c * c / 2;
  for (double power = 1; std::abs(c) > 1e-16; power *= 2) {
    c = (a - b) / 2;
    const double mean = (a + b) / 2;
    b = std::sqrt(a * b);
    a = mean;
    sum += power * c * c;
  }
  const double first = std::numbers::pi / (2 * a);
  return {first, first * (1 - sum)};
}

// The elastica in closed form, alpha the angle of its end: P / P_E = (2 K / pi)^2 with k =
// sin(alpha / 2); the end is 2 k / K of the length aside and 2 - 2 E / K of it lower.
TEST(behind, leans_as_the_elastica) {
  for (const bool is_stiff_in_one_plane : {true, false}) {
    model::RobotSpec spec = loaded_column(16, 1.25);
    spec.material.moment_x_mm4 *= is_stiff_in_one_plane ? 1e3 : 1;
    const Path path = beyond(spec);
    ASSERT_TRUE(path.critical);
    EXPECT_NEAR(path.critical->factor, 0.8, 1e-5);
    ASSERT_EQ(path.behind.size(), 2U);
    double low = 0;
    double high = 1;
    for (int i = 0; i < 60; ++i) {
      const double middle = (low + high) / 2;
      (std::pow(2 * elliptic(middle).first / std::numbers::pi, 2) < 1.25 ? low : high) = middle;
    }
    const auto [first, second] = elliptic(low);
    const double length = 16 * kCubePitch;
    for (const Branch& branch : path.behind) {
      ASSERT_TRUE(branch.rest);
      EXPECT_EQ(branch.rest->factor, 1);
      const auto& end = branch.rest->poses.back().displacement;
      EXPECT_NEAR(std::hypot(end[0], end[1]) / length, 2 * low / first, 1e-4);
      EXPECT_NEAR(-end[2] / length, 2 - 2 * second / first, 1e-4);
      EXPECT_TRUE(std::ranges::all_of(branch.points, &PathPoint::is_stable));
    }
    const auto& one = path.behind[0].rest->poses.back().displacement;
    const auto& other = path.behind[1].rest->poses.back().displacement;
    EXPECT_NEAR(one[0], -other[0], 1e-3);
    EXPECT_NEAR(one[1], -other[1], 1e-3);
  }
}

// A tower that a load leans tips over its foot. There the foot is free to turn about an edge, and
// statics alone says how far it is turned under whatever loads; where they go back to none nothing
// else is bent. By its kinematics, e2 = 0 and e1 = b phi, the lowest node is at
// (L + b phi) [(1 - cos phi) / phi, sin phi / phi] from the facet's immobile one.
TEST(behind, tips_over_its_foot_at_one_angle) {
  model::RobotSpec spec;
  for (int i = 0; i < 4; ++i) {
    spec.existing.push_back({0, 0, i});
  }
  spec.material.elastic_modulus_mpa = 2;
  const double weight = 4 * spec.material.mass_kg * spec.material.gravity_m_s2;
  spec.payloads = {{.cell = {0, 0, 3}, .force_n = {weight * 0.1, 0, 0}}};
  const model::Robot robot = made(spec);
  const double b = robot.foot_half_width_mm();
  // Place of the node `height` above the lowest one, from the immobile node.
  const auto place = [&](double phi, double height) {
    const double way = (kCubePitch + b * phi) / phi;
    return std::pair{way * (1 - std::cos(phi)) + height * std::sin(phi),
                     way * std::sin(phi) + height * std::cos(phi)};
  };
  const auto work = [&](double phi) {  // Of the weight at its centre, and the load at the top.
    return 0.1 * place(phi, 3 * kCubePitch).first - place(phi, 1.5 * kCubePitch).second;
  };
  double low = 1e-3;
  double high = 0.5;
  for (int i = 0; i < 60; ++i) {
    const double middle = (low + high) / 2;
    (work(middle + 1e-6) < work(middle - 1e-6) ? low : high) = middle;
  }
  const auto [x, z] = place(low, 3 * kCubePitch);
  const Path path = beyond(spec, 50);
  ASSERT_TRUE(path.critical);
  EXPECT_EQ(path.critical->loss, Loss::kLimit);
  EXPECT_TRUE(path.critical->is_by_facets);
  ASSERT_EQ(path.behind.size(), 1U);
  const Branch& branch = path.behind.front();
  EXPECT_EQ(branch.end, End::kUnloaded);
  EXPECT_FALSE(branch.rest);
  EXPECT_TRUE(std::none_of(branch.points.begin(), branch.points.end() - 1,
                           [](const PathPoint& point) { return point.is_stable; }));
  EXPECT_NEAR(branch.last.factor, 0, 1e-4);
  EXPECT_NEAR(branch.points.front().factor, path.critical->factor, 1e-2);
  const auto& end = branch.last.poses.back().displacement;
  EXPECT_NEAR(end[0], x, 1e-3 * x);
  EXPECT_NEAR(end[2], z - 4 * kCubePitch, 1e-3 * x);
}

TEST(behind, is_empty_where_nothing_is_lost_or_nobody_asks) {
  EXPECT_TRUE(beyond(loaded_column(4, 0.4)).behind.empty());
  const Path path = follow(made(loaded_column(4, 1.25)), {.thread_count = 1});
  EXPECT_TRUE(path.critical);
  EXPECT_TRUE(path.behind.empty());
}

/// The energy of a robot without contact, N mm, and the sum of forces on each module as far as it
/// may move: what loads exceed those of beams by. Facets are beams to an immobile node.
struct Balance {
  double energy = 0;
  std::vector<base::Vec6<double>> rest;
};

Balance balance_of(const model::Robot& robot, const std::vector<mechanics::Pose>& poses,
                   double factor) {
  const model::LatticeBeam<double> linear(model::beam_section(robot.material()), robot.lattice());
  const model::LargeBeams beams(linear, robot.lattice());
  Balance balance{.rest = std::vector<base::Vec6<double>>(poses.size())};
  for (std::size_t i = 0; i < poses.size(); ++i) {
    base::add_times(balance.rest[i], factor, robot.loads()[i]);
    for (std::size_t k = 0; k < 3; ++k) {
      balance.energy -= factor * robot.loads()[i][k] * poses[i].displacement[k];
    }
  }
  const auto add = [&](const mechanics::LargeBeam& beam, std::size_t a, const std::size_t* b) {
    const auto bent = beam.deformation(poses[a], b != nullptr ? poses[*b] : mechanics::Pose{});
    const auto forces = beam.end_forces(bent, beam.stress(bent));
    balance.energy += beam.energy(bent);
    base::add_times(balance.rest[a], -1, forces.p);
    if (b != nullptr) {
      base::add_times(balance.rest[*b], -1, forces.q);
    }
  };
  for (const model::Connection pair : robot.connections()) {
    const std::size_t b = base::at(pair.b);
    add(beams[pair.direction], base::at(pair.a), &b);
  }
  for (const model::Facet& facet : robot.facets()) {
    add(beams[facet.direction], base::at(facet.module), nullptr);
  }
  return balance;
}

/// An equilibrium, by the sum of forces, and stable: any small motion takes energy.
void expect_rest(const model::Robot& robot, const State& state) {
  const Balance at_rest = balance_of(robot, state.poses, state.factor);
  double load = 0;
  for (std::size_t i = 0; i < state.poses.size(); ++i) {
    const base::Vec6<double> one = robot.loads()[i];
    load = std::max({load, std::abs(one[0]), std::abs(one[1]), std::abs(one[2])});
  }
  base::Rng random(state.poses.size());
  const auto number = [&] { return static_cast<double>(random.below(2001)) / 1000 - 1; };
  const auto is_fixed = [&](std::size_t i) {
    return robot.modules()[i].support == model::Support::kFixed;
  };
  for (std::size_t i = 0; i < state.poses.size(); ++i) {
    for (std::size_t k = 0; k < 6 && !is_fixed(i); ++k) {
      EXPECT_LE(std::abs(at_rest.rest[i][k]), 1e-5 * state.factor * load * (k < 3 ? 1 : 40));
    }
  }
  for (int trial = 0; trial < 20; ++trial) {
    std::vector<mechanics::Pose> poses = state.poses;
    for (std::size_t i = 0; i < poses.size(); ++i) {
      if (!is_fixed(i)) {
        poses[i] = mechanics::moved(poses[i], {0.4 * number(), 0.4 * number(), 0.4 * number(),
                                               0.01 * number(), 0.01 * number(), 0.01 * number()});
      }
    }
    EXPECT_GT(balance_of(robot, poses, state.factor).energy, at_rest.energy);
  }
}

// A flat bridge, so thin that it goes down at half of its weight, and hangs there.
TEST(behind, snaps_through_and_hangs) {
  model::RobotSpec spec;
  for (int i = -5; i <= 5; ++i) {
    spec.existing.push_back({i, 0, std::abs(i) <= 3 ? 1 : 0});
    if (std::abs(i) == 3) {
      spec.existing.push_back({i, 0, 0});
    }
  }
  spec.fixed = {{-5, 0, 0}, {5, 0, 0}};
  spec.support_z = {};
  spec.material.elastic_modulus_mpa = 1;
  spec.material.moment_x_mm4 /= 20;
  spec.material.moment_y_mm4 *= 50;
  spec.material.torsion_mm4 = 1e6;
  const Path path = beyond(spec);
  ASSERT_TRUE(path.critical);
  EXPECT_EQ(path.critical->loss, Loss::kLimit);
  ASSERT_EQ(path.behind.size(), 1U);
  const Branch& branch = path.behind.front();
  // The loads grow less, then more: stability is lost and found again at turns.
  const auto least = std::ranges::min_element(branch.points, {}, &PathPoint::factor);
  EXPECT_LT(least->factor, path.critical->factor - 0.01);
  EXPECT_FALSE(branch.points[3].is_stable);
  EXPECT_TRUE(branch.points.back().is_stable);
  EXPECT_GT(branch.points.back().factor, path.critical->factor);
  ASSERT_TRUE(branch.rest);
  EXPECT_EQ(branch.rest->factor, 1);
  expect_rest(made(spec), *branch.rest);
}

/// How far modules are moved where branches rest, the least first.
std::vector<double> ways_to_rest(const Path& path) {
  std::vector<double> ways;
  for (const Branch& branch : path.behind) {
    if (branch.rest) {
      ways.push_back(branch.rest->displacement_max_mm);
    }
  }
  std::ranges::sort(ways);
  return ways;
}

// Turned and mirrored ones rest in the same shapes.
TEST(behind, finds_equilibria_that_rest_on_random_robots) {
  int count = 0;
  int turned_count = 0;
  for (const base::Lattice& lattice : test::kLattices) {
    for (std::uint64_t seed = 0; seed < test::campaign(std::uint64_t{40}); ++seed) {
      SCOPED_TRACE(seed);
      model::RobotSpec spec = test::general_robot(lattice, seed);
      spec.material.elastic_modulus_mpa = 0.03;
      std::erase_if(spec.payloads, [](const model::Payload& load) {  // Torques have no energy.
        return load.torque_nmm != std::array<double, 3>{};
      });
      const auto robot = model::Robot::create(spec, 1);
      if (!robot) {
        continue;
      }
      const Path path = follow(
          robot.value(),
          {.factor_max = 3, .is_bonded = true, .is_followed_behind = true, .thread_count = 1});
      EXPECT_EQ(path.behind.empty(), !path.critical.has_value());
      const auto symmetries = test::symmetries(lattice);
      const test::Symmetry& symmetry = symmetries[(7 * seed + 5) % symmetries.size()];
      if (path.critical && test::keeps_frames(lattice, symmetry)) {
        const Path other = follow(
            made(test::turned(spec, symmetry)),
            {.factor_max = 3, .is_bonded = true, .is_followed_behind = true, .thread_count = 1});
        const auto ways = ways_to_rest(path);
        const auto other_ways = ways_to_rest(other);
        ASSERT_EQ(other_ways.size(), ways.size());
        for (std::size_t i = 0; i < ways.size(); ++i) {
          ++turned_count;
          EXPECT_NEAR(other_ways[i], ways[i], 1e-5 * ways[i]);
        }
      }
      for (const Branch& branch : path.behind) {
        if (branch.rest) {
          ++count;
          expect_rest(robot.value(), *branch.rest);
        }
      }
    }
  }
  EXPECT_GE(count, test::least(6));
  EXPECT_GE(turned_count, test::least(2));
}

}  // namespace
}  // namespace holdfast::large
