// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
//
// What must hold of any robot, tried on random ones of all lattices, with obstacles, bonded and
// not, masses, payloads and gravity in any direction: stiff robots have the linear solution, turned
// and mirrored ones the same path, loads and stiffness times the same the same shape, and loads
// just below the critical ones are held.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "general_robot.hpp"
#include "holdfast/large/follow.hpp"
#include "holdfast/solver/equilibrium.hpp"
#include "seeds.hpp"

namespace holdfast::large {
namespace {

constexpr double kSoft = 0.3;  ///< MPa: most of these robots bend much, some buckle.

model::RobotSpec soft_robot(const base::Lattice& lattice, std::uint64_t seed) {
  model::RobotSpec spec = test::general_robot(lattice, seed);
  spec.material.elastic_modulus_mpa = kSoft;
  return spec;
}

/// The robot with all its loads times a factor.
model::RobotSpec with_loads_times(model::RobotSpec spec, double factor) {
  auto gravity =
      spec.gravity_m_s2.value_or(std::array<double, 3>{0, 0, -spec.material.gravity_m_s2});
  for (double& part : gravity) {
    part *= factor;
  }
  spec.gravity_m_s2 = gravity;
  for (model::Payload& load : spec.payloads) {
    for (std::size_t k = 0; k < 3; ++k) {
      load.force_n[k] *= factor;
      load.torque_nmm[k] *= factor;
    }
  }
  return spec;
}

std::optional<Path> path_of(const model::RobotSpec& spec, double factor_max) {
  const auto robot = model::Robot::create(spec, 1);
  if (!robot) {
    return std::nullopt;
  }
  Path path = follow(robot.value(), {.factor_max = factor_max, .thread_count = 1});
  return path.outcome == Outcome::kNoStart ? std::nullopt : std::optional(std::move(path));
}

/// Calls test(lattice, spec, seed) for robots of all lattices.
template <class Test>
void for_each_robot(std::uint64_t count, const Test& test) {
  for (const base::Lattice& lattice : test::kLattices) {
    for (std::uint64_t seed = 0; seed < test::campaign(count); ++seed) {
      SCOPED_TRACE(seed);
      test(lattice, soft_robot(lattice, seed), seed);
    }
  }
}

double largest_displacement(const std::vector<base::Vec6<double>>& u) {
  double largest = 0;
  for (const auto& one : u) {
    largest = std::max(largest, std::hypot(one[0], one[1], one[2]));
  }
  return largest;
}

TEST(invariants, stiff_robots_have_the_linear_solution) {
  int count = 0;
  for_each_robot(20, [&](const base::Lattice&, model::RobotSpec spec, std::uint64_t) {
    spec.material.elastic_modulus_mpa = 1e6;
    const auto robot = model::Robot::create(spec, 1);
    if (!robot) {
      return;
    }
    const auto path = follow(robot.value(), {.factor_max = 1, .thread_count = 1});
    solver::EquilibriumSolver solver(robot.value(), {.thread_count = 1});
    const auto linear = solver.solve({.law = mechanics::ContactLaw::kUnilateral, .gamma = 1e-9});
    if (!path.loaded || linear.outcome != solver::Outcome::kSettled ||
        linear.open_but_held_count > 0) {
      return;
    }
    ++count;
    const double largest = largest_displacement(linear.displacement);
    for (std::size_t i = 0; i < linear.displacement.size(); ++i) {
      for (std::size_t k = 0; k < 3; ++k) {
        EXPECT_NEAR(path.loaded->poses[i].displacement[k], linear.displacement[i][k],
                    1e-4 * largest);
      }
    }
  });
  EXPECT_GE(count, test::least(40));
}

TEST(invariants, turned_and_mirrored_robots_have_the_same_path) {
  int count = 0;
  for_each_robot(
      6, [&](const base::Lattice& lattice, const model::RobotSpec& spec, std::uint64_t seed) {
        const auto path = path_of(spec, 2);
        const auto symmetries = test::symmetries(lattice);
        const test::Symmetry& symmetry = symmetries[(7 * seed + 5) % symmetries.size()];
        if (!path || !test::keeps_frames(lattice, symmetry)) {
          return;
        }
        ++count;
        const auto other = path_of(test::turned(spec, symmetry), 2);
        ASSERT_TRUE(other);
        ASSERT_EQ(other->critical.has_value(), path->critical.has_value());
        if (path->critical) {
          EXPECT_NEAR(other->critical->factor, path->critical->factor, 4e-6);
          EXPECT_EQ(other->critical->loss, path->critical->loss);
        }
        ASSERT_EQ(other->loaded.has_value(), path->loaded.has_value());
        if (!path->loaded) {
          return;
        }
        EXPECT_NEAR(other->loaded->displacement_max_mm, path->loaded->displacement_max_mm,
                    1e-7 * (1 + path->loaded->displacement_max_mm));
        for (std::size_t i = 0; i < path->loaded->poses.size(); ++i) {
          const auto& u = path->loaded->poses[i].displacement;
          const auto image = symmetry(base::Vec6<double>{u[0], u[1], u[2], 0, 0, 0});
          for (std::size_t k = 0; k < 3; ++k) {
            EXPECT_NEAR(other->loaded->poses[i].displacement[k], image[k],
                        1e-6 * (1 + path->loaded->displacement_max_mm));
          }
        }
      });
  EXPECT_GE(count, test::least(8));
}

TEST(invariants, loads_and_stiffness_times_the_same_are_the_same_shape) {
  int count = 0;
  for_each_robot(10, [&](const base::Lattice&, const model::RobotSpec& spec, std::uint64_t) {
    const auto path = path_of(spec, 1);
    model::RobotSpec heavy = with_loads_times(spec, 8);
    heavy.material.elastic_modulus_mpa *= 8;
    const auto other = path_of(heavy, 1);
    ASSERT_EQ(other.has_value(), path.has_value());
    if (!path) {
      return;
    }
    ASSERT_EQ(other->loaded.has_value(), path->loaded.has_value());
    if (path->loaded) {
      ++count;
      EXPECT_NEAR(other->loaded->displacement_max_mm, path->loaded->displacement_max_mm,
                  1e-8 * (1 + path->loaded->displacement_max_mm));
    }
  });
  EXPECT_GE(count, test::least(15));
}

TEST(invariants, loads_just_below_the_critical_ones_are_held) {
  int count = 0;
  for_each_robot(12, [&](const base::Lattice&, model::RobotSpec spec, std::uint64_t) {
    spec.material.elastic_modulus_mpa = kSoft / 6;
    const auto path = path_of(spec, 2);
    if (!path || !path->critical) {
      return;
    }
    ++count;
    const double below = path->critical->factor * (1 - 1e-3);
    const auto other = path_of(with_loads_times(spec, below), 1);
    ASSERT_TRUE(other);
    EXPECT_EQ(other->outcome, Outcome::kReached) << path->critical->factor;
  });
  EXPECT_GE(count, test::least(4));
}

}  // namespace
}  // namespace holdfast::large
