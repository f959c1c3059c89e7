// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
//
// Equilibrium with the ground, for random robots that stand, tilt and topple, under both laws.
// Expected values: the balance of forces and torques, homogeneity, the conditions that define
// unilateral contact, and a second method, dense and without any code of the solver. Tolerances:
// rounding times the condition number, which for a robot that topples is 1 / gamma times that of a
// standing one; measured, 3e-8 is the largest for gamma = 1e-4 and 1e-11 for standing robots.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "dense_reference.hpp"
#include "holdfast/solver/equilibrium.hpp"
#include "random_robot.hpp"
#include "seeds.hpp"

namespace holdfast::solver {
namespace {

using namespace holdfast::test;
using base::Vec6;
using mechanics::ContactLaw;
using mechanics::ContactState;
using model::Robot;
using model::RobotSpec;

constexpr double kGamma = 1e-4;
constexpr ContactOptions kContactLaws[] = {{.law = ContactLaw::kRegularised, .gamma = kGamma},
                                           {.law = ContactLaw::kUnilateral, .gamma = kGamma}};
constexpr double kContactTolerance = 1e-6;
constexpr std::uint64_t kRobotCount = 200;

Robot make(const RobotSpec& spec) {
  auto robot = Robot::create(spec);
  EXPECT_TRUE(robot.has_value()) << robot.error().message;
  return std::move(robot).value();
}

/// Ix != Iy and a facet narrower than the pitch; one robot in three has a fixed module.
Robot lopsided_robot(std::uint64_t seed) {
  RobotSpec spec = random_robot(seed);
  spec.material.moment_x_mm4 = 150'000;
  spec.material.moment_y_mm4 = 400'000;
  spec.material.facet_mm = 30;
  if (seed % 3 == 0) {
    spec.fixed = {spec.existing.back()};
  }
  return make(spec);
}

mechanics::GroundFacet<double> facet_of(const Robot& robot, const ContactOptions& contact) {
  return mechanics::ground_facet(model::beam_section(robot.material()), robot.material().facet_mm,
                                 contact.gamma, contact.law);
}

bool rests(const Robot& robot, std::size_t i) {
  return robot.modules()[i].support == model::Support::kGround;
}

/// What the contact does, seen from the facet centre: the force that the ground takes and the
/// motion `v` that the beam is spared, without the weak spring.
struct Facet {
  Vec6<double> trial{};
  Vec6<double> force{};
  Vec6<double> v{};

  /// Takes the module's displacement and what the ground does to it.
  Facet(const mechanics::GroundFacet<double>& facet, const Vec6<double>& displacement,
        const Vec6<double>& f)
      : trial(mechanics::trial_force(facet, displacement)) {
    force = {-f[0], -f[1], -f[2], -f[3] + f[1] * facet.lever, -f[4] - f[0] * facet.lever, -f[5]};
    for (std::size_t k = 0; k < 6; ++k) {
      force[k] = (force[k] - facet.gamma * trial[k]) / (1 - facet.gamma);
      v[k] = (trial[k] - force[k]) / facet.stiffness[k];
    }
  }

  /// Held sideways, a facet takes the whole trial force; free, none of it.
  bool is_held() const {
    const auto size = [](const Vec6<double>& f) { return std::hypot(f[0], f[1]); };
    return size(force) >= size(trial) / 2;
  }
};

/// Forces and torques about the origin that are left of the ground's and the weights', in units of
/// the robot's weight times 1 mm.
double imbalance(const Robot& robot, const Equilibrium& result) {
  const double weight = model::module_weight_n(robot.material());
  const double pitch = robot.material().pitch_mm;
  const std::vector<Vec6<double>> forces = ground_forces(robot, result);
  Vec6<double> sum{};
  for (std::size_t i = 0; i < robot.modules().size(); ++i) {
    const base::Cell& cell = robot.modules()[i].cell;
    const double x = cell.x * pitch;
    const double y = cell.y * pitch;
    const double z = cell.z * pitch;
    Vec6<double> f = forces[i];
    f[2] -= weight;
    base::add_to(sum, {f[0], f[1], f[2], f[3] + y * f[2] - z * f[1], f[4] + z * f[0] - x * f[2],
                       f[5] + x * f[1] - y * f[0]});
  }
  return largest({sum}) / (weight * static_cast<double>(robot.modules().size()));
}

TEST(EquilibriumOfARandomRobot, is_found_by_either_law) {
  int settled_count[2] = {};
  for (std::uint64_t seed = 0; seed < kRobotCount; ++seed) {
    const Robot robot = make(random_robot(seed));
    EquilibriumSolver solver(robot);
    for (std::size_t law = 0; law < 2; ++law) {
      const Equilibrium result = solver.solve(kContactLaws[law]);
      settled_count[law] += result.outcome == Outcome::kSettled ? 1 : 0;
      EXPECT_LE(result.steps, 40);
    }
  }
  // Newton's method on Eqs. (9)-(12) cycles on 3.5 % of random robots, as another program
  // counted.
  EXPECT_GE(settled_count[0], 190);
  EXPECT_EQ(settled_count[1], 200);
}

TEST(EquilibriumOfARandomRobot, balances_the_weight_and_its_torque) {
  for (std::uint64_t seed = 0; seed < kRobotCount; ++seed) {
    const Robot robot = make(random_robot(seed));
    EquilibriumSolver solver(robot);
    for (const ContactOptions& law : kContactLaws) {
      const Equilibrium result = solver.solve(law);
      if (result.outcome == Outcome::kSettled) {
        EXPECT_LT(imbalance(robot, result), kContactTolerance) << "seed " << seed;
      }
    }
  }
}

TEST(EquilibriumOfARandomRobot, has_the_states_that_its_displacements_prescribe) {
  for (std::uint64_t seed = 0; seed < kRobotCount; ++seed) {
    const Robot robot = lopsided_robot(seed);
    EquilibriumSolver solver(robot);
    for (const ContactOptions& law : kContactLaws) {
      const Equilibrium result = solver.solve(law);
      const auto facet = facet_of(robot, law);
      for (std::size_t i = 0; result.outcome == Outcome::kSettled && i < robot.modules().size();
           ++i) {
        const auto trial = mechanics::trial_force(facet, result.displacement[i]);
        const ContactState open = {.pressed = false};
        EXPECT_EQ(contact_of(robot, result, i),
                  rests(robot, i) ? mechanics::contact_state(facet, trial) : open)
            << "seed " << seed << ", module " << i;
      }
    }
  }
}

TEST(EquilibriumOfARandomRobot, is_that_of_a_dense_solution_with_the_same_states) {
  for (std::uint64_t seed = 0; seed < campaign(60U, 10U); ++seed) {
    const Robot robot = lopsided_robot(seed);
    EquilibriumSolver solver(robot);
    for (const ContactOptions& law : kContactLaws) {
      const Equilibrium result = solver.solve(law);
      if (result.outcome != Outcome::kSettled) {
        continue;
      }
      const std::vector<Vec6<double>> forces = ground_forces(robot, result);
      auto facet = facet_of(robot, law);
      facet.gamma = result.gamma;
      const auto dense = dense_displacement(robot, [&](std::size_t i) {
        return law.law == ContactLaw::kRegularised
                   ? regularised_tangent(robot.material(), kGamma, contact_of(robot, result, i))
                   : unilateral_tangent(robot.material(), result.gamma,
                                        contact_of(robot, result, i),
                                        Facet(facet, result.displacement[i], forces[i]).is_held());
      });
      EXPECT_LT(largest_difference(result.displacement, dense),
                kContactTolerance * largest(result.displacement))
          << "seed " << seed;
    }
  }
}

/// Doubling is exact in binary, so nothing but the size may change, to the last bit.
TEST(EquilibriumOfARandomRobot, doubles_when_gravity_doubles) {
  for (std::uint64_t seed = 0; seed < kRobotCount; ++seed) {
    RobotSpec spec = random_robot(seed);
    const Robot once = make(spec);
    spec.material.gravity_m_s2 *= 2;
    const Robot twice = make(spec);
    for (const ContactOptions& law : kContactLaws) {
      Equilibrium result = EquilibriumSolver(once).solve(law);
      const Equilibrium doubled = EquilibriumSolver(twice).solve(law);
      for (Vec6<double>& u : result.displacement) {
        base::add_to(u, Vec6<double>(u));
      }
      EXPECT_EQ(result.outcome, doubled.outcome) << "seed " << seed;
      EXPECT_EQ(result.contact, doubled.contact) << "seed " << seed;
      EXPECT_EQ(result.displacement, doubled.displacement) << "seed " << seed;
    }
  }
}

/// One solver serves several laws in any order: nothing of an earlier solution is left behind.
TEST(EquilibriumOfARandomRobot, does_not_depend_on_what_was_solved_before) {
  for (std::uint64_t seed = 0; seed < 40; ++seed) {
    const Robot robot = make(random_robot(seed));
    EquilibriumSolver used(robot);
    for (const std::size_t law : {0U, 1U, 0U, 1U}) {
      const Equilibrium again = used.solve(kContactLaws[law]);
      const Equilibrium fresh = EquilibriumSolver(robot).solve(kContactLaws[law]);
      EXPECT_EQ(again.displacement, fresh.displacement) << "seed " << seed;
      EXPECT_EQ(again.alternative, fresh.alternative) << "seed " << seed;
      EXPECT_EQ(again.steps, fresh.steps) << "seed " << seed;
    }
  }
}

/// A fixed column separates two parts: a plate that stays on the ground, and an arm on two legs
/// whose overhang lifts or tilts a foot. Only the arm may be made again when its feet change.
TEST(EquilibriumOfTwoParts, leaves_the_part_alone_whose_contact_does_not_change) {
  RobotSpec spec = {.existing = {{0, 0, 0}, {0, 0, 1}}};
  spec.fixed = spec.existing;
  std::size_t plate_count = 0;
  for (std::int32_t x = -6; x < 0; ++x) {
    for (std::int32_t y = 0; y < 4; ++y) {
      spec.existing.push_back({x, y, 0});
      ++plate_count;
    }
  }
  std::vector<base::Cell> arm = {{2, 0, 0}, {4, 0, 0}};
  for (std::int32_t x = 1; x <= 8; ++x) {
    arm.push_back({x, 0, 1});
  }
  spec.existing.insert(spec.existing.end(), arm.begin(), arm.end());
  const Robot robot = make(spec);
  for (const ContactOptions& law : kContactLaws) {
    const Equilibrium result = EquilibriumSolver(robot).solve(law);
    ASSERT_EQ(result.outcome, Outcome::kSettled);
    ASSERT_GT(result.steps, 1);
    const auto repeated = static_cast<std::size_t>(result.steps - 1);
    EXPECT_LE(result.made_column_count, plate_count + arm.size() + repeated * arm.size());
  }
}

/// Eqs. (6)-(8) for every facet: no corner below the ground, no pull, no pressure beyond the edges,
/// no work of pressure on motion; and held sideways exactly where pressed, but for those counted.
TEST(EquilibriumOfARandomRobot, obeys_unilateral_contact_at_every_facet) {
  for (std::uint64_t seed = 0; seed < kRobotCount; ++seed) {
    const Robot robot = lopsided_robot(seed);
    const Equilibrium result = EquilibriumSolver(robot).solve(kContactLaws[1]);
    ASSERT_EQ(result.outcome, Outcome::kSettled) << "seed " << seed;
    const std::vector<Vec6<double>> forces = ground_forces(robot, result);
    auto facet = facet_of(robot, kContactLaws[1]);
    facet.gamma = result.gamma;
    const double l = facet.half_width;
    const double height = kContactTolerance * largest(result.displacement);  // mm
    const double force = kContactTolerance * largest(forces);                // N, or N mm / l
    int open_but_held_count = 0;
    for (std::size_t i = 0; i < robot.modules().size(); ++i) {
      if (!rests(robot, i)) {
        EXPECT_EQ(forces[i], Vec6<double>{});
        continue;
      }
      const Facet at(facet, result.displacement[i], forces[i]);
      EXPECT_GE(at.v[2] - std::abs(at.v[3]) * l - std::abs(at.v[4]) * l, -height);
      EXPECT_LE(std::max(std::abs(at.force[3]), std::abs(at.force[4])) / l, -at.force[2] + force);
      const double work = at.force[2] * at.v[2] + at.force[3] * at.v[3] + at.force[4] * at.v[4];
      EXPECT_NEAR(work, 0, force * largest(result.displacement) + height * largest({at.force}));
      open_but_held_count += !contact_of(robot, result, i).pressed && at.is_held() ? 1 : 0;
      EXPECT_TRUE(at.is_held() || !contact_of(robot, result, i).pressed) << "seed " << seed;
    }
    EXPECT_EQ(result.open_but_held_count, open_but_held_count) << "seed " << seed;
  }
}

/// Closed facets are plain beams in both laws. The weak spring is weaker than elsewhere here.
TEST(EquilibriumOfARandomRobot, is_the_same_in_both_laws_while_all_facets_are_closed) {
  int closed_count = 0;
  for (std::uint64_t seed = 0; seed < kRobotCount; ++seed) {
    const Robot robot = make(random_robot(seed));
    EquilibriumSolver solver(robot);
    const Equilibrium regularised = solver.solve(kContactLaws[0]);
    const Equilibrium exact = solver.solve({.law = ContactLaw::kUnilateral, .gamma = 1e-9});
    bool is_closed = true;
    for (const ContactState& state : regularised.contact) {
      is_closed = is_closed && state == mechanics::kStuck;
    }
    if (regularised.outcome == Outcome::kSettled && is_closed) {
      EXPECT_EQ(regularised.contact, exact.contact) << "seed " << seed;
      EXPECT_LT(largest_difference(regularised.displacement, exact.displacement),
                1e-9 * largest(exact.displacement))
          << "seed " << seed;
      ++closed_count;
    }
  }
  EXPECT_GT(closed_count, 20);
}

/// Where an open facet is held for lack of a consistent choice, the alternative lets it slide:
/// again an equilibrium, with the states that its own displacements prescribe. Elsewhere the two
/// answers differ by rounding.
/// The solution with the facets' states at its own displacements; `is_held` says which are held.
template <class IsHeld>
std::vector<Vec6<double>> dense_at(const Robot& robot, double gamma,
                                   const std::vector<Vec6<double>>& displacement,
                                   const IsHeld& is_held) {
  const auto facet = facet_of(robot, kContactLaws[1]);
  return dense_displacement(robot, [&](std::size_t i) {
    const auto trial = mechanics::trial_force(facet, displacement[i]);
    return unilateral_tangent(robot.material(), gamma, mechanics::contact_state(facet, trial),
                              is_held(i));
  });
}

TEST(EquilibriumOfARandomRobot, has_an_alternative_with_ambiguous_facets_free) {
  int ambiguous_count = 0;
  for (std::uint64_t seed = 0; seed < campaign(kRobotCount, std::uint64_t{16}); ++seed) {
    const Robot robot = make(random_robot(seed));
    const Equilibrium result = EquilibriumSolver(robot).solve(kContactLaws[1]);
    ASSERT_EQ(result.outcome, Outcome::kSettled) << "seed " << seed;
    if (result.open_but_held_count == 0) {
      continue;
    }
    const auto is_pressed = [&](std::size_t i) { return contact_of(robot, result, i).pressed; };
    const auto is_dense = [&](const std::vector<Vec6<double>>& alternative) {
      return largest_difference(alternative,
                                dense_at(robot, result.free_gamma, alternative, is_pressed)) <
             kContactTolerance * largest(result.displacement);
    };
    EXPECT_TRUE(is_dense(result.alternative)) << "seed " << seed;
    // More digits leave both answers.
    const Equilibrium precise =
        EquilibriumSolver(robot, {.is_precise = true}).solve(kContactLaws[1]);
    EXPECT_EQ(precise.gamma, result.gamma);
    EXPECT_LT(largest_difference(precise.displacement, result.displacement),
              kContactTolerance * largest(result.displacement));
    EXPECT_TRUE(is_dense(precise.alternative)) << "seed " << seed;
    ++ambiguous_count;
  }
  EXPECT_GE(ambiguous_count, least(4, 16));
}

/// A robot that stands does without weak springs; where its facets would then be in other states,
/// or it does not stand, the error's energy says how much they do.
TEST(EquilibriumOfARandomRobot, is_without_weak_springs_or_says_what_they_do) {
  int taken_back_count = 0;
  int told_count = 0;
  for (std::uint64_t seed = 0; seed < campaign(kRobotCount, std::uint64_t{16}); ++seed) {
    const Robot robot = make(random_robot(seed));
    const Equilibrium result = EquilibriumSolver(robot).solve(kContactLaws[1]);
    ASSERT_EQ(result.outcome, Outcome::kSettled) << "seed " << seed;
    if (result.gamma == 0) {
      const Equilibrium weaker =
          EquilibriumSolver(robot).solve({.law = ContactLaw::kUnilateral, .gamma = kGamma / 100});
      if (weaker.gamma == 0 && weaker.contact == result.contact) {
        EXPECT_LT(largest_difference(result.displacement, weaker.displacement),
                  kContactTolerance * largest(result.displacement))
            << "seed " << seed;
        ++taken_back_count;
      }
    } else {
      EXPECT_GT(result.energy_error, 0) << "seed " << seed;
      ++told_count;
    }
  }
  EXPECT_GE(taken_back_count, least(150, 16));
  EXPECT_GE(told_count, least(20, 16));  // With springs as stiff as these, 1e-4.
}

}  // namespace
}  // namespace holdfast::solver
