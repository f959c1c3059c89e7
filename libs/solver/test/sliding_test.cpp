// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
//
// Feet that slip by Coulomb's law. Sources: closed forms of a portal, and brute force: in robots of
// one layer, all combinations of feet that stick, slip to the left and slip to the right, each a
// dense system of its own.
#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "../../../tests/support/seeds.hpp"
#include "contact/sliding_feet.hpp"
#include "dense_reference.hpp"
#include "holdfast/base/rng.hpp"
#include "holdfast/solver/equilibrium.hpp"

namespace holdfast::solver {
namespace {

using base::Cell;
using base::Vec6;
using model::RobotSpec;

constexpr ContactOptions kPaper = {};

/// A slab of cells at height `height` on a leg at each end.
RobotSpec portal(int span, int height, double friction) {
  RobotSpec spec;
  for (int z = 0; z < height; ++z) {
    spec.existing.push_back({0, 0, z});
    spec.existing.push_back({span, 0, z});
  }
  for (int x = 0; x <= span; ++x) {
    spec.existing.push_back({x, 0, height});
  }
  spec.floor.friction = friction;
  return spec;
}

std::vector<Equilibrium> slid(const model::Robot& robot) {
  EquilibriumSolver solver(robot);
  return solver.let_slip(solver.solve(kPaper), kPaper);
}

/// The thrust of a portal whose feet slip is what friction holds: mu times half its weight.
TEST(Sliding, a_portal_has_the_thrust_of_its_friction) {
  for (const double friction : {0.0, 0.01, 0.05, 0.1}) {
    const model::Robot robot = model::Robot::create(portal(6, 3, friction)).value();
    const auto found = slid(robot);
    ASSERT_EQ(found.size(), 1U);
    const double weight = 13 * model::module_weight_n(robot.material());
    for (std::size_t foot = 0; foot < 2; ++foot) {
      const double sign =
          robot.modules()[base::at(robot.facets()[foot].module)].cell.x == 0 ? 1 : -1;
      EXPECT_NEAR(found[0].facet_force[foot][0], sign * friction * weight / 2, 1e-9);
      EXPECT_NEAR(found[0].facet_force[foot][2], weight / 2, 1e-9);
    }
  }
}

/// A foot with T = T0 - A s and N = N0 + G s along one axis sticks at s = 0 where T0 <= mu N0, and
/// slips by s = (T0 - mu N0) / (A + mu G) if that is positive: where mu G < -A both are solutions,
/// and otherwise just one is.
TEST(Sliding, a_foot_that_is_lifted_by_its_slip_may_have_two_answers) {
  for (const double lift : {-0.2, -3.0}) {
    for (const double pull : {0.9, 1.1}) {
      constexpr double kStiffness = 2;
      SlidingFeet feet({{.friction = 1,
                         .stiffness = {kStiffness, kStiffness, 1},
                         .force = {pull, 0, 0},
                         .press_n = 1}});
      for (std::size_t i = 0; i < kSlipSize; ++i) {
        feet.force_by_slip(0, i, 0, i) = -1;
      }
      feet.press_by_slip(0, 0, 0) = lift;
      const double slip = (pull - 1) / (1 + lift);
      const bool sticks = pull <= 1;
      const auto found = feet.solve();
      if (sticks || slip > 0) {
        ASSERT_TRUE(found);
        EXPECT_NEAR((*found)[0][0], sticks ? 0 : slip, 1e-12);
        EXPECT_EQ(feet.has_others(*found), sticks && slip > 0);
      } else {  // It is lifted by its slip and then goes on without friction.
        ASSERT_TRUE(found);
        EXPECT_NEAR((*found)[0][0], pull, 1e-12);
      }
    }
  }
}

/// A robot of one layer and the same beams for all: feet, and what a combination of their states
/// says.
class BruteForce {
 public:
  explicit BruteForce(const model::Robot& robot, double friction)
      : robot_(robot), friction_(friction) {
    const model::Material& m = robot.material();
    to_facet_(0, 4) = -m.pitch_mm / 2;
    to_facet_(1, 3) = m.pitch_mm / 2;
    const test::Matrix6 back = to_facet_.inverse();
    spring_ = back.transpose() * test::paper_block(m, 1) * back;
  }

  /// The forces (sideways, across) of all feet, by every combination that is consistent with all
  /// feet pressing all over; those that agree once.
  std::vector<std::vector<std::array<double, 2>>> all() const {
    std::vector<std::vector<std::array<double, 2>>> solutions;
    std::vector<int> signs(robot_.facets().size(), -1);
    for (;;) {
      const auto forces = forces_of(signs);
      if (!forces.empty() && std::ranges::none_of(solutions, [&](const auto& known) {
            return is_same(known, forces);
          })) {
        solutions.push_back(forces);
      }
      std::size_t i = 0;
      while (i < signs.size() && signs[i] == 1) {
        signs[i++] = -1;
      }
      if (i == signs.size()) {
        return solutions;
      }
      ++signs[i];
    }
  }

  static bool is_same(const std::vector<std::array<double, 2>>& a,
                      const std::vector<std::array<double, 2>>& b) {
    bool is_same = true;
    for (std::size_t i = 0; i < a.size(); ++i) {
      is_same = is_same && std::abs(a[i][0] - b[i][0]) < 1e-6 && std::abs(a[i][1] - b[i][1]) < 1e-6;
    }
    return is_same;
  }

 private:
  /// 0: sticks. Else the direction in which it slips, and in which the floor takes its force. All
  /// that slip the same way leave the robot without hold; a spring of 1e-9 then holds the feet.
  std::vector<std::array<double, 2>> forces_of(const std::vector<int>& signs) const {
    const auto sign_of = [&](std::size_t module) {
      std::size_t facet = 0;
      while (base::at(robot_.facets()[facet].module) != module) {
        ++facet;
      }
      return signs[facet];
    };
    const auto law = [&](std::size_t module) {
      test::Matrix6 rows = spring_;
      if (const int sign = sign_of(module); sign != 0) {
        rows.row(0) = 1e-9 * spring_.row(0) - sign * friction_ * spring_.row(2);
      }
      return rows;
    };
    const auto u = test::dense_displacement(robot_, [&](std::size_t module) -> test::Matrix6 {
      return to_facet_.transpose() * law(module) * to_facet_;
    });
    std::vector<std::array<double, 2>> forces;
    for (std::size_t i = 0; i < signs.size(); ++i) {
      const std::size_t module = base::at(robot_.facets()[i].module);
      const test::Vector6 w = to_facet_ * Eigen::Map<const test::Vector6>(u[module].data());
      const test::Vector6 t = law(module) * w;
      const double press = -t(2);
      const double slip = w(0) - t(0) / spring_(0, 0);
      const double tie = 1e-7;
      const bool holds = signs[i] == 0 ? std::abs(t(0)) <= friction_ * press + tie
                                       : slip * signs[i] >= -tie / spring_(0, 0);
      const double most = press * robot_.material().facet_mm / 2;
      if (!holds || press <= 0 || std::abs(t(3)) >= most || std::abs(t(4)) >= most) {
        return {};
      }
      forces.push_back({t(0), press});
    }
    return forces;
  }

  const model::Robot& robot_;
  double friction_;
  test::Matrix6 to_facet_ = test::Matrix6::Identity();
  test::Matrix6 spring_;
};

/// A sheet of up to 12 modules in the plane y = 0, grown at random, its lowest layer on the floor.
RobotSpec sheet(std::uint64_t seed) {
  base::Rng rng(seed);
  std::vector<Cell> cells = {{0, 0, 0}};
  std::set<Cell> taken = {{0, 0, 0}};
  const std::size_t count = 4 + rng.below(9);
  while (cells.size() < count) {
    const Cell from = cells[rng.below(cells.size())];
    Cell next = from;
    const auto side = rng.below(4);
    next.x += side == 0 ? 1 : side == 1 ? -1 : 0;
    next.z += side == 2 ? 1 : side == 3 ? -1 : 0;
    if (next.z >= 0 && taken.insert(next).second) {
      cells.push_back(next);
    }
  }
  return {.existing = cells};
}

/// Where brute force finds one solution it is the one found here, and where it finds several there
/// is no answer.
TEST(Sliding, sheets_slip_as_brute_force_says) {
  constexpr std::array kFrictions = {0.0, 0.02, 0.1, 0.2, 0.4, 0.8, 2.0, 5.0};
  int one_count = 0;
  int several_count = 0;
  int none_count = 0;
  for (std::uint64_t seed = 0; seed < test::campaign(1500U); ++seed) {
    RobotSpec spec = sheet(seed);
    const double friction = kFrictions[seed % kFrictions.size()];
    spec.floor.friction = friction;
    const model::Robot robot = model::Robot::create(spec).value();
    if (robot.facets().size() < 2 || robot.facets().size() > 6) {
      continue;
    }
    EquilibriumSolver solver(robot);
    const Equilibrium stuck = solver.solve(kPaper);
    bool is_beyond = stuck.outcome == Outcome::kSettled;
    bool is_any_beyond = false;
    for (std::size_t i = 0; is_beyond && i < robot.facets().size(); ++i) {
      const auto& force = stuck.facet_force[i];
      is_beyond = stuck.contact[i] == mechanics::kStuck;
      is_any_beyond |= std::abs(force[0]) > friction * force[2] + 1e-6;
    }
    if (!is_beyond || !is_any_beyond) {
      continue;
    }
    const auto known = BruteForce(robot, friction).all();
    const auto found = solver.let_slip(stuck, kPaper);
    one_count += known.size() == 1 ? 1 : 0;
    several_count += known.size() > 1 ? 1 : 0;
    none_count += known.empty() ? 1 : 0;
    if (known.size() != 1) {
      EXPECT_TRUE(found.empty() || known.empty()) << seed;
      continue;
    }
    if (found.size() != 1U) {
      ADD_FAILURE() << seed;
      continue;
    }
    std::vector<std::array<double, 2>> forces;
    for (const Vec6<double>& force : found[0].facet_force) {
      forces.push_back({-force[0], force[2]});
      EXPECT_NEAR(force[1], 0, 1e-9) << seed;
    }
    EXPECT_TRUE(BruteForce::is_same(forces, known[0])) << seed;
  }
  EXPECT_GE(one_count, test::least(300));
  EXPECT_LE(several_count + none_count, one_count / 20);
}

}  // namespace
}  // namespace holdfast::solver
