// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
//
// Neighbours that are not connected pass no force. Both methods against statics, where releases
// leave a chain or a tree, and against a dense matrix (dense_reference.hpp) where loops remain.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "dense_reference.hpp"
#include "holdfast/mechanics/connector.hpp"
#include "holdfast/model/families.hpp"
#include "holdfast/solver/equilibrium.hpp"
#include "holdfast/solver/linear_system.hpp"
#include "seeds.hpp"

namespace holdfast::solver {
namespace {

using base::Cell;
using model::Robot;
using model::RobotSpec;

constexpr Method kMethods[] = {Method::kDirect, Method::kMultigrid};

/// Rounding times the condition number of some dozen beams; what hangs has the loads of statics
/// with multigrid, too.
constexpr double kReleasedTolerance = 1e-9;

/// What multigrid's displacements are asked for, in the energy norm, and found to.
constexpr double kAskedTolerance = 1e-9;
constexpr double kMultigridTolerance = 1e-6;

Robot make(const RobotSpec& spec) {
  auto robot = Robot::create(spec);
  EXPECT_TRUE(robot.has_value()) << robot.error().message;
  return std::move(robot).value();
}

/// The bending moment in the middle of every connection, N mm.
std::vector<double> bending_moments(const Robot& robot, Method method) {
  const Equilibrium found = EquilibriumSolver(robot, {.method = method}).solve({});
  EXPECT_EQ(found.outcome, Outcome::kSettled);
  EXPECT_EQ(found.method, method);
  const auto beam = mechanics::beam_stiffness(model::beam_section(robot.material()));
  std::vector<double> bending;
  for (const model::Connection& pair : robot.connections()) {
    bending.push_back(
        mechanics::connection_load(mechanics::middle_force(beam, pair.direction,
                                                           found.displacement[base::at(pair.a)],
                                                           found.displacement[base::at(pair.b)]))
            .bending);
  }
  return bending;
}

/// A ring of 8 modules in one layer whose last is not connected to its first, which is fixed: an
/// open chain. The weight of what comes behind a connection bends it by its levers along the
/// connection; those across twist it.
TEST(ReleasedPair, opens_a_ring_to_a_chain_with_the_loads_of_statics) {
  const std::vector<Cell> ring = {{0, 0, 1}, {1, 0, 1}, {2, 0, 1}, {2, 1, 1},
                                  {2, 2, 1}, {1, 2, 1}, {0, 2, 1}, {0, 1, 1}};
  const Robot robot =
      make({.existing = ring, .fixed = {ring.front()}, .released = {{ring.back(), ring.front()}}});
  ASSERT_EQ(robot.connections().size(), ring.size() - 1);
  const double weight_pitch = model::module_weight_n(robot.material()) * robot.material().pitch_mm;
  for (const Method method : kMethods) {
    const std::vector<double> found = bending_moments(robot, method);
    for (std::size_t i = 0; i < found.size(); ++i) {
      const auto& [low, high, direction] = robot.connections()[i];
      const auto first_behind = base::at(std::max(low, high));
      const Cell& a = ring[first_behind - 1];
      const Cell& b = ring[first_behind];
      double lever = 0;  // Of all modules behind, in pitches.
      for (std::size_t j = first_behind; j < ring.size(); ++j) {
        lever += (ring[j].x - 0.5 * (a.x + b.x)) * (b.x - a.x) +
                 (ring[j].y - 0.5 * (a.y + b.y)) * (b.y - a.y);
      }
      EXPECT_NEAR(found[i], std::abs(lever) * weight_pitch,
                  8 * 8 * kReleasedTolerance * weight_pitch)
          << model::ends_text(robot, i) << ", method " << static_cast<int>(method);
    }
  }
}

/// Two rows side by side from two fixed modules, connected only there: each is a cantilever by
/// itself, bent by k^2 W L / 2 where k modules stick out.
TEST(ReleasedPair, leaves_rows_side_by_side_cantilevers_of_their_own_length) {
  const std::int32_t lengths[] = {40, 17};
  RobotSpec spec = {.fixed = {{0, 0, 1}, {0, 1, 1}}};
  for (std::int32_t y = 0; y < 2; ++y) {
    for (std::int32_t x = 0; x <= lengths[y]; ++x) {
      spec.existing.push_back({x, y, 1});
    }
  }
  for (std::int32_t x = 1; x <= lengths[1]; ++x) {
    spec.released.push_back({Cell{x, 0, 1}, Cell{x, 1, 1}});
  }
  const Robot robot = make(spec);
  const double weight_pitch = model::module_weight_n(robot.material()) * robot.material().pitch_mm;
  for (const Method method : kMethods) {
    const std::vector<double> found = bending_moments(robot, method);
    for (std::size_t i = 0; i < found.size(); ++i) {
      const auto [a, b] = model::ends(robot, i);
      const double count = a.y == b.y ? lengths[a.y] - a.x : 0;
      EXPECT_NEAR(found[i], count * count / 2 * weight_pitch,
                  40 * 40 * kReleasedTolerance * weight_pitch)
          << model::ends_text(robot, i) << ", method " << static_cast<int>(method);
    }
  }
}

/// A solid cube with as many of every third pair released as keep it in one piece.
RobotSpec perforated_cube(std::size_t size, std::uint32_t seed) {
  RobotSpec spec = {.existing = model::family_cells(model::Family::kCube, size)};
  const Robot whole = make(spec);
  std::mt19937 random(seed);
  for (std::size_t i = 0; i < whole.connections().size(); ++i) {
    if (random() % 3 == 0) {
      spec.released.push_back(model::ends(whole, i));
      if (!Robot::create(spec)) {
        spec.released.pop_back();
      }
    }
  }
  return spec;
}

TEST(ReleasedPair, passes_no_force_by_either_method_where_loops_remain) {
  for (std::uint32_t seed = 1; seed <= test::campaign(3U); ++seed) {
    const Robot robot = make(perforated_cube(4, seed));
    ASSERT_GT(robot.released_count(), 30U);
    ASSERT_EQ(robot.released_count() + robot.connections().size(), 144U);
    const model::Loads loads[] = {model::weight_loads(robot.material()),
                                  model::Loads({1, -2, 0.5, 40, 10, -30})};
    for (const Method method : kMethods) {
      const auto system = make_linear_system(robot, {.method = method});
      ASSERT_TRUE(system);
      system->set_law({.law = mechanics::ContactLaw::kUnilateral, .gamma = 1e-3});
      const auto found = system->solve_each(loads, kAskedTolerance);
      ASSERT_TRUE(found);
      for (std::size_t i = 0; i < std::size(loads); ++i) {
        const auto exact = test::dense_displacement(robot, loads[i], [&](std::size_t) {
          return test::unilateral_tangent(robot.material(), 1e-3, {}, true);
        });
        EXPECT_LE(
            test::largest_difference((*found)[i], exact),
            (system->is_exact() ? kReleasedTolerance : kMultigridTolerance) * test::largest(exact))
            << "seed " << seed << ", load " << i;
      }
    }
  }
}

/// Large enough for coarse levels. Multigrid promises load ratios to 1e-4 of the largest or of 1.
TEST(ReleasedPair, passes_no_force_on_multigrids_coarse_levels) {
  const Robot robot = make(perforated_cube(8, 7));
  ASSERT_GT(robot.released_count(), 300U);
  const std::vector<double> exact = bending_moments(robot, Method::kDirect);
  const std::vector<double> found = bending_moments(robot, Method::kMultigrid);
  const model::Material& material = robot.material();
  const double limit_nmm = material.strength_vertical_n * material.facet_mm / 2;
  for (std::size_t i = 0; i < exact.size(); ++i) {
    EXPECT_NEAR(found[i], exact[i], 1e-4 * limit_nmm) << model::ends_text(robot, i);
  }
}

}  // namespace
}  // namespace holdfast::solver
