// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
//
// What the robot itself says where the elastic modulus is stated: never `safe` where the
// second-order check or the equilibrium in the deformed shape says something else. Both know
// nothing of the modules' bounds.
#include <gtest/gtest.h>

#include <cmath>

#include "campaign.hpp"
#include "general_robot.hpp"
#include "holdfast/base/rng.hpp"
#include "holdfast/holdfast.hpp"
#include "holdfast/verdict/deformed.hpp"
#include "random_robot.hpp"
#include "seeds.hpp"

namespace holdfast {
namespace {

using verdict::ReasonCode;

/// Robots by what was said of them.
struct BendingCounts {
  int bent = 0;     ///< The check leaves them undecided because of bending.
  int safe = 0;     ///< Modules call them safe.
  int trusted = 0;  ///< The check calls them safe and trusts linear theory,
  int refused = 0;  ///< and of these modules refuse to.
};

/// Asks modules, the check and, where the modules say that it is safe, the deformed shape.
void count_bending(const model::RobotSpec& spec, BendingCounts& counts) {
  const auto created = model::Robot::create(spec);
  if (!created || sim::find_options_fault(created.value(), {})) {
    return;
  }
  const model::Robot& robot = created.value();
  sim::Simulation simulation(robot, {.link = sim::unit()});
  simulation.run();
  const agent::Answer answer = simulation.result().answer;
  const auto exact =
      verdict::assess(robot, {.thread_count = 1, .second_order = solver::SecondOrderWish::kCheck});
  const ReasonCode why = exact.reasons.front().code;
  const bool is_bent = exact.verdict == verdict::Verdict::kUndecided &&
                       (why == ReasonCode::kSecondOrder || why == ReasonCode::kDisplacedMass);
  const bool is_safe = answer.verdict == agent::Verdict::kSafe;
  const bool is_trusted = exact.verdict == verdict::Verdict::kSafe &&
                          exact.second_order->trust == verdict::Trust::kTrusted;
  EXPECT_FALSE(is_safe && is_bent);
  if (is_safe) {
    const auto deformed = verdict::assess_deformed(robot, exact).assessment;
    EXPECT_EQ(deformed.verdict, verdict::Verdict::kSafe)
        << verdict::name(deformed.reasons.front().code);
  }
  counts.bent += is_bent ? 1 : 0;
  counts.safe += is_safe ? 1 : 0;
  counts.trusted += is_trusted ? 1 : 0;
  counts.refused += is_trusted && answer.reason == agent::Reason::kSecondOrder ? 1 : 0;
}

model::RobotSpec of_modulus(model::RobotSpec spec, double modulus_mpa) {
  spec.material.elastic_modulus_mpa = modulus_mpa;
  spec.is_modulus_stated = true;
  return spec;
}

model::RobotSpec tower(std::int32_t height, std::int32_t width, double modulus_mpa) {
  model::RobotSpec spec;
  for (std::int32_t i = 0; i < height * width * width; ++i) {
    spec.existing.push_back({i % width, i / width % width, i / (width * width)});
  }
  return of_modulus(spec, modulus_mpa);
}

sim::SimulationResult result_of(const model::RobotSpec& spec) {
  const model::Robot robot = test::robot_of(spec);
  sim::Simulation simulation(robot, {.link = sim::unit()});
  simulation.run();
  return simulation.result();
}

/// Greenhill: a thin tower buckles at 1744 E / n^3 times its weight. The bound of that is five
/// times too careful or so, what its foot needs some more.
TEST(Bending, towers_are_safe_far_below_the_height_at_which_they_buckle) {
  for (const double modulus : {0.2, 5.0, 100.0}) {
    for (const std::int32_t height : {2, 3, 4, 6, 9, 14, 20, 26, 60}) {
      SCOPED_TRACE(std::to_string(modulus) + " MPa, " + std::to_string(height) + " high");
      const double factor = 1744 * modulus / std::pow(height, 3);
      const agent::Answer answer = result_of(tower(height, 1, modulus)).answer;
      const bool is_safe = answer.verdict == agent::Verdict::kSafe;
      EXPECT_TRUE(is_safe || factor < 15);
      EXPECT_TRUE(!is_safe || factor > 1);
      EXPECT_TRUE(is_safe || answer.reason == agent::Reason::kSecondOrder);
    }
  }
}

/// One sweep more, of twice the tree's depth, before `safe`; nothing where nobody states the
/// modulus, and nothing before any other verdict.
TEST(Bending, costs_one_sweep_and_only_where_the_modulus_is_stated) {
  const auto rounds_of = [](model::RobotSpec spec, bool is_stated) {
    spec.is_modulus_stated = is_stated;
    return result_of(spec).rounds;
  };
  const model::RobotSpec high = tower(9, 1, model::Material{}.elastic_modulus_mpa);
  EXPECT_EQ(rounds_of(high, true), rounds_of(high, false) + 2 * 4);
  model::RobotSpec arm = high;
  arm.existing = {{0, 0, 1}, {1, 0, 1}, {2, 0, 1}, {3, 0, 1}, {4, 0, 1}, {5, 0, 1}};
  arm.fixed = {{0, 0, 1}};
  EXPECT_EQ(result_of(arm).answer.verdict, agent::Verdict::kOverload);
  EXPECT_EQ(rounds_of(arm, true), rounds_of(arm, false));
}

/// The modulus of a seed, in MPa.
double random_modulus(std::uint64_t seed, double least, double most) {
  base::Rng rng(seed + 77);
  return least * std::pow(most / least, static_cast<double>(rng.below(1'000'000)) / 1e6);
}

TEST(Bending, modules_never_call_safe_what_bends) {
  BendingCounts soft;
  for (std::uint64_t seed = 0; seed < test::campaign(40U); ++seed) {
    const double modulus = random_modulus(seed, 0.05, 5);
    count_bending(of_modulus(test::random_robot(seed, 2, 30), modulus), soft);
    for (const base::Lattice& lattice : test::kLattices) {
      const model::RobotSpec general = test::general_robot(lattice, seed);
      const model::RobotSpec floor = test::on_a_floor(general, seed % 2 == 0);
      const auto held = test::held_robot(lattice, seed, test::kFixed[seed % 4]);
      for (const model::RobotSpec& spec :
           {general, test::with_last_planned(floor, 1 + seed % 3), held}) {
        count_bending(of_modulus(spec, modulus), soft);
      }
    }
  }
  EXPECT_GE(soft.bent, test::least(12));
  EXPECT_GE(soft.safe, test::least(100));
}

TEST(Bending, modules_hardly_ever_refuse_table_I_on_a_floor) {
  BendingCounts stiff;
  for (std::uint64_t seed = 0; seed < test::campaign(40U); ++seed) {
    count_bending(of_modulus(test::random_robot(seed, 2, 30), 100), stiff);
  }
  for (const std::int32_t width : {1, 2, 3}) {
    count_bending(tower(30 / width / width, width, 100), stiff);
  }
  EXPECT_GE(stiff.trusted, test::least(30));
  EXPECT_LE(10 * stiff.refused, stiff.trusted);
}

}  // namespace
}  // namespace holdfast
