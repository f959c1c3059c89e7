// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
// Multigrid on every lattice, with supports and loads anywhere: against the direct solver, the
// second method; turned by the lattice's own symmetries; as many iterations as are promised.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <set>
#include <string>
#include <tuple>
#include <utility>

#include "holdfast/model/families.hpp"
#include "holdfast/model/lattice_beam.hpp"
#include "holdfast/solver/equilibrium.hpp"
#include "random_numbers.hpp"
#include "ratio_difference.hpp"
#include "seeds.hpp"

namespace holdfast::solver {
namespace {

using base::Cell;
using base::Lattice;
using base::Vec6;
using mechanics::ContactLaw;

/// What multigrid promises of every load ratio, as a share of the largest one or of 1.
constexpr double kRatioTolerance = 1e-4;

const std::pair<const char*, Lattice> kLattices[] = {{"cubic", base::kCubic},
                                                     {"face-centred", base::kFaceCentred},
                                                     {"hexagonal", base::kHexagonal},
                                                     {"hexagonal-prism", base::kHexagonalPrism}};

struct CellLess {
  bool operator()(const Cell& a, const Cell& b) const {
    return std::tie(a.x, a.y, a.z) < std::tie(b.x, b.y, b.z);
  }
};

using CellSet = std::set<Cell, CellLess>;

std::int32_t draw(base::Rng& rng, std::size_t bound) {
  return static_cast<std::int32_t>(rng.next() % bound);
}

/// Grown at random from one cell, nowhere below it; the larger `straightness`, the more often on
/// from the newest cell in the direction of the step before, which makes arms.
std::vector<Cell> grown(const Lattice& lattice, std::size_t count, int straightness,
                        base::Rng& rng) {
  std::vector<Cell> cells = {{0, 0, 0}};
  CellSet seen(cells.begin(), cells.end());
  int direction = 0;
  while (cells.size() < count) {
    const bool goes_on = draw(rng, 100) < straightness;
    const Cell from =
        goes_on ? cells.back() : cells[static_cast<std::size_t>(draw(rng, cells.size()))];
    direction = goes_on && draw(rng, 10) > 0
                    ? direction
                    : draw(rng, static_cast<std::size_t>(lattice.direction_count));
    const Cell next = base::neighbour(lattice, from, static_cast<base::Direction>(direction));
    if (next.z >= 0 && seen.insert(next).second) {
      cells.push_back(next);
    }
  }
  return cells;
}

/// Some of the empty cells beside a robot.
std::vector<Cell> beside(const Lattice& lattice, const std::vector<Cell>& cells, std::size_t count,
                         base::Rng& rng) {
  CellSet taken(cells.begin(), cells.end());
  std::vector<Cell> found;
  while (found.size() < count) {
    const Cell& from = cells[static_cast<std::size_t>(draw(rng, cells.size()))];
    const auto direction =
        static_cast<base::Direction>(draw(rng, static_cast<std::size_t>(lattice.direction_count)));
    const Cell next = base::neighbour(lattice, from, direction);
    if (taken.insert(next).second) {
      found.push_back(next);
    }
  }
  return found;
}

/// A robot with a floor, obstacles beside it of which one at least is bonded, a fixed module now
/// and then, gravity in any direction, masses and payloads of its own.
model::RobotSpec random_spec(const Lattice& lattice, std::uint64_t seed) {
  base::Rng rng(seed);
  model::RobotSpec spec;
  spec.lattice = lattice;
  const int straightness = seed % 3 == 0 ? 95 : 20;
  spec.existing = grown(lattice, 150 + static_cast<std::size_t>(draw(rng, 150)), straightness, rng);
  if (seed % 2 == 0) {
    spec.support_z = std::nullopt;
  }
  const std::vector<Cell> obstacles = beside(lattice, spec.existing, 12, rng);
  spec.obstacles.resize(2);
  spec.obstacles[0].cells = {obstacles.begin(), obstacles.begin() + 6};
  spec.obstacles[0].touch.hold = model::Hold::kBonded;
  spec.obstacles[1].cells = {obstacles.begin() + 6, obstacles.end()};
  if (seed % 5 == 0) {
    spec.fixed = {spec.existing.back()};
  }
  spec.gravity_m_s2 = {{3 * random_number(rng), 3 * random_number(rng), -9.81}};
  for (int i = 0; i < 20; ++i) {
    const Cell& cell = spec.existing[static_cast<std::size_t>(draw(rng, spec.existing.size()))];
    spec.payloads.push_back(
        {.cell = cell,
         .force_n = {random_number(rng), random_number(rng), random_number(rng)},
         .torque_nmm = {10 * random_number(rng), 0, 20 * random_number(rng)}});
  }
  return spec;
}

/// Eq. (16) of every connection, as load ratios of a connector that holds 12 N on a lever of 20 mm.
std::vector<double> load_ratios(const model::Robot& robot, const std::vector<Vec6<double>>& u) {
  const model::LatticeBeam<double> beam(model::beam_section(robot.material()), robot.lattice());
  std::vector<double> ratios;
  for (const model::Connection& pair : robot.connections()) {
    const Vec6<double> force =
        beam.middle_force(pair.direction, u[base::at(pair.a)], u[base::at(pair.b)]);
    ratios.push_back((force[2] + std::max(std::abs(force[3]), std::abs(force[4])) / 20) / 12);
  }
  return ratios;
}

/// Multigrid settles where the direct solver does, in the same states, and agrees. Returns whether
/// they did settle.
bool expect_agreement(const model::Robot& robot, const ContactOptions& contact,
                      Precision precision) {
  EquilibriumSolver direct(robot, {.method = Method::kDirect});
  EquilibriumSolver multigrid(robot, {.method = Method::kMultigrid, .precision = precision});
  const Equilibrium a = direct.solve(contact);
  const Equilibrium b = multigrid.solve(contact);
  EXPECT_EQ(a.outcome, b.outcome);
  EXPECT_EQ(b.method, Method::kMultigrid);
  if (a.outcome != Outcome::kSettled || b.outcome != Outcome::kSettled) {
    return false;
  }
  EXPECT_LE(
      largest_difference(load_ratios(robot, a.displacement), load_ratios(robot, b.displacement)),
      kRatioTolerance);
  return true;
}

TEST(MultigridOnALattice, agrees_with_the_direct_solver_with_supports_anywhere) {
  for (const auto& [name, lattice] : kLattices) {
    int settled_count = 0;
    for (std::uint64_t seed = 1; seed <= 20; seed += test::kIsShort ? 7 : 1) {
      SCOPED_TRACE(std::string(name) + ", seed " + std::to_string(seed));
      const auto robot = model::Robot::create(random_spec(lattice, seed));
      ASSERT_TRUE(robot.has_value()) << robot.error().message;
      for (const Precision precision : {Precision::kSingle, Precision::kDouble}) {
        settled_count += expect_agreement(robot.value(), {}, precision) ? 1 : 0;
      }
    }
    EXPECT_GE(settled_count, test::least(10, 7)) << name;
  }
}

TEST(MultigridOnALattice, agrees_with_the_direct_solver_on_facets_that_are_points) {
  for (const auto& [name, lattice] : kLattices) {
    SCOPED_TRACE(name);
    model::RobotSpec spec = random_spec(lattice, 3);
    spec.foot_mm = 0;
    expect_agreement(model::Robot::create(spec).value(), {}, Precision::kSingle);
  }
}

TEST(MultigridOnALattice, agrees_with_the_direct_solver_under_the_exact_law) {
  for (const auto& [name, lattice] : kLattices) {
    for (std::uint64_t seed = 1; seed <= 8; ++seed) {
      SCOPED_TRACE(std::string(name) + ", seed " + std::to_string(seed));
      const model::Robot robot = model::Robot::create(random_spec(lattice, seed)).value();
      expect_agreement(robot, {.law = ContactLaw::kUnilateral, .gamma = 1e-6}, Precision::kSingle);
    }
  }
}

TEST(MultigridOnALattice, agrees_with_the_direct_solver_on_all_families) {
  for (const auto& [family, size] : {std::pair{model::Family::kBall, 12},
                                     {model::Family::kSheet, 24},
                                     {model::Family::kPrismWall, 12}}) {
    const auto cells = model::family_cells(family, static_cast<std::size_t>(size));
    const model::Robot robot =
        model::Robot::create({.existing = cells, .lattice = model::family_lattice(family)}).value();
    SCOPED_TRACE(model::families()[static_cast<std::size_t>(family)].name);
    EXPECT_TRUE(expect_agreement(robot, {}, Precision::kSingle));
    EXPECT_TRUE(expect_agreement(robot, {}, Precision::kDouble));
  }
}

/// The iterations that a robot without bumps takes hardly grow with its size.
TEST(MultigridOnALattice, takes_few_iterations_whatever_the_size) {
  for (const auto& [family, size] : {std::pair{model::Family::kBall, 16},
                                     {model::Family::kBall, 50},
                                     {model::Family::kSheet, 40},
                                     {model::Family::kSheet, 160},
                                     {model::Family::kPrismWall, 20},
                                     {model::Family::kPrismWall, 100}}) {
    const auto cells = model::family_cells(family, static_cast<std::size_t>(size));
    const model::Robot robot =
        model::Robot::create({.existing = cells, .lattice = model::family_lattice(family)}).value();
    EquilibriumSolver solver(robot, {.method = Method::kMultigrid, .is_bonded = true});
    const Equilibrium result = solver.solve({});
    EXPECT_EQ(result.outcome, Outcome::kSettled);
    EXPECT_LE(result.iteration_count, 10) << size;
  }
}

/// A ball that rests on a few of its modules, all of which press, is as easy in contact as bonded:
/// its feet must not stay out of the clusters, as those of portals do.
TEST(MultigridOnALattice, takes_no_more_iterations_for_a_ball_that_rests_than_for_a_bonded_one) {
  const model::RobotSpec spec = {
      .existing = model::family_cells(model::Family::kBall, test::kIsShort ? 40 : 72),
      .lattice = base::kFaceCentred};
  const model::Robot robot = model::Robot::create(spec).value();
  const auto solved = [&](bool is_bonded) {
    return EquilibriumSolver(robot, {.method = Method::kMultigrid, .is_bonded = is_bonded})
        .solve({});
  };
  const Equilibrium resting = solved(false);
  EXPECT_EQ(resting.outcome, Outcome::kSettled);
  EXPECT_TRUE(
      std::ranges::all_of(resting.contact, [](const auto& state) { return state.pressed; }));
  EXPECT_LE(resting.iteration_count, solved(true).iteration_count + 1);
}

/// A symmetry of a lattice about a vertical axis: of its axial coordinates, and of vectors.
struct Turn {
  Lattice lattice;
  std::function<Cell(const Cell&)> axial;
  double cosine = 0;
  double sine = 0;
};

Vec6<double> turned(const Turn& turn, const Vec6<double>& u) {
  Vec6<double> result = u;
  for (const std::size_t k : {0U, 3U}) {
    result[k] = turn.cosine * u[k] - turn.sine * u[k + 1];
    result[k + 1] = turn.sine * u[k] + turn.cosine * u[k + 1];
  }
  return result;
}

TEST(MultigridOnALattice, turns_with_the_robot) {
  const Turn turns[] = {// By 90 degrees: b3 = (b1 + b2)/2 + ... becomes b3 - b1.
                        {base::kFaceCentred,
                         [](const Cell& c) {
                           return Cell{-c.y - c.z, c.x, c.z};
                         },
                         0, 1},
                        {base::kHexagonalPrism,
                         [](const Cell& c) {
                           return Cell{-c.y, c.x + c.y, c.z};
                         },
                         0.5, std::sqrt(0.75)}};
  for (const Turn& turn : turns) {
    base::Rng rng(7);
    model::RobotSpec spec = {.lattice = turn.lattice};
    spec.existing = grown(turn.lattice, 400, 20, rng);
    model::RobotSpec other = {.lattice = turn.lattice};
    for (const Cell& cell : spec.existing) {
      other.existing.push_back(
          base::cell_of(turn.lattice, turn.axial(base::axial_of(turn.lattice, cell))));
    }
    spec.fixed = {spec.existing.front()};
    other.fixed = {other.existing.front()};
    const EquilibriumOptions options = {
        .method = Method::kMultigrid, .is_bonded = true, .tolerance = 1e-8};
    const model::Robot robot = model::Robot::create(spec).value();
    const model::Robot turned_robot = model::Robot::create(other).value();
    const Equilibrium a = EquilibriumSolver(robot, options).solve({});
    const Equilibrium b = EquilibriumSolver(turned_robot, options).solve({});
    ASSERT_EQ(a.outcome, Outcome::kSettled);
    ASSERT_EQ(b.outcome, Outcome::kSettled);
    double largest = 0;
    double difference = 0;
    for (std::size_t i = 0; i < a.displacement.size(); ++i) {
      const Vec6<double> expected = turned(turn, a.displacement[i]);
      for (std::size_t k = 0; k < 6; ++k) {
        largest = std::max(largest, std::abs(expected[k]));
        difference = std::max(difference, std::abs(expected[k] - b.displacement[i][k]));
      }
    }
    EXPECT_LT(difference, 1e-5 * largest);
  }
}

}  // namespace
}  // namespace holdfast::solver
