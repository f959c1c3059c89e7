// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
//
// Robots whose masses scatter: against an integral for one connection, and against robots that are
// made with other masses and checked from scratch.
#include "holdfast/verdict/mass_samples.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

#include "holdfast/base/rng.hpp"
#include "holdfast/verdict/reliability.hpp"
#include "random_robot.hpp"
#include "seeds.hpp"

namespace holdfast::verdict {
namespace {

model::RobotSpec with_masses(model::RobotSpec spec, const model::Robot& robot,
                             std::span<const double> masses_kg) {
  spec.own_masses.clear();
  for (std::size_t i = 0; i < masses_kg.size(); ++i) {
    spec.own_masses.push_back({robot.modules()[i].cell, masses_kg[i]});
  }
  return spec;
}

/// The sampling that checks what it cannot follow.
MassSampling sampling_of(const model::RobotSpec& spec, const model::Robot& robot) {
  MassSampling sampling;
  sampling.check = [&spec, &robot](std::span<const double> masses) -> std::optional<Assessment> {
    const auto changed = model::Robot::create(with_masses(spec, robot, masses));
    return changed ? std::optional(assess(changed.value())) : std::nullopt;
  };
  return sampling;
}

/// A module that hangs from a fixed one pulls with its weight: ratio r (1 + cv e), e normal.
TEST(MassSamples, of_one_connection_agree_with_the_integral) {
  const model::RobotSpec spec = {.existing = {{0, 0, 1}, {0, 0, 0}},
                                 .fixed = {{0, 0, 1}},
                                 .support_z = std::nullopt,
                                 .material = {.strength_vertical_n = 0.8}};
  const auto robot = model::Robot::create(spec);
  ASSERT_TRUE(robot);
  const Assessment found = assess(robot.value());
  const double ratio = *found.load_ratio_max;
  EXPECT_NEAR(ratio, 0.06106 * 9.81 / 0.8, 1e-9);
  for (const double mass_cv : {0.02, 0.1, 0.3}) {
    const StrengthScatter scatter = {.cv = 0.1, .mass_cv = {mass_cv, mass_cv}};
    const SampledMasses sampled =
        sample_masses(robot.value(), found, scatter.mass_cv, sampling_of(spec, robot.value()));
    EXPECT_EQ(sampled.cases.size(), 1024U);
    EXPECT_EQ(sampled.changed_count, 0U);
    const auto reliability = find_reliability(found, scatter, sampled);
    ASSERT_TRUE(reliability);
    const ScatteredFactor own(scatter.distribution, scatter.cv);
    double fails = 0;
    for (double z = -8; z <= 8; z += 0.01) {
      fails += 0.01 * std::exp(-z * z / 2) / std::sqrt(2 * std::numbers::pi) *
               own.below(ratio * (1 + mass_cv * z));
    }
    EXPECT_LE(reliability->holds_low, 1 - fails);
    EXPECT_GE(reliability->holds_high, 1 - fails);
    EXPECT_LT(reliability->holds_high - reliability->holds_low, 0.05);
    EXPECT_NEAR(reliability->likeliest.at(0).share, 1, 1e-9);
  }
}

/// The mean, and its standard error, over robots that are made and checked one by one.
struct Mean {
  double mean = 0;
  double error = 0;
};

Mean checked_one_by_one(const model::RobotSpec& spec, const model::Robot& robot,
                        const StrengthScatter& scatter, int count, std::uint64_t seed) {
  base::Rng rng(seed ^ 0x5eedU);
  const auto uniform = [&] { return static_cast<double>(rng.next() >> 11U) * 0x1p-53; };
  double sum = 0;
  double square = 0;
  for (int i = 0; i < count; ++i) {
    std::vector<double> masses;
    for (std::size_t module = 0; module < robot.modules().size(); ++module) {
      const double normal =
          std::sqrt(-2 * std::log(1 - uniform())) * std::sin(2 * std::numbers::pi * uniform());
      masses.push_back(robot.mass(module) * (1 + scatter.mass_cv[module] * normal));
    }
    const auto made = model::Robot::create(with_masses(spec, robot, masses));
    const auto ratios = known_ratios(assess(made.value()));
    const double holds = ratios ? find_reliability(*ratios, scatter).holds : 0;
    sum += holds / count;
    square += holds * holds / count;
  }
  return {sum, std::sqrt(std::max(0.0, square - sum * sum) / count)};
}

TEST(MassSamples, of_random_robots_agree_with_checks_from_scratch) {
  const int robot_count = test::campaign(16);
  int counted = 0;
  int changed = 0;
  for (std::uint64_t seed = 0; counted < robot_count; ++seed) {
    model::RobotSpec spec = test::random_robot(seed);
    const auto first = model::Robot::create(spec);
    ASSERT_TRUE(first);
    const Assessment before = assess(first.value());
    if (!before.is_stable || !before.worst || before.verdict == Verdict::kUndecided) {
      continue;
    }
    spec.material.strength_vertical_n *= *before.load_ratio_max / 0.85;
    spec.material.strength_lateral_n *= *before.load_ratio_max / 0.85;
    const auto robot = model::Robot::create(spec);
    const Assessment found = assess(robot.value());
    StrengthScatter scatter = {.cv = 0.08};
    for (std::size_t i = 0; i < robot.value().modules().size(); ++i) {
      scatter.mass_cv.push_back(i % 3 == 0 ? 0.2 : 0.05);
    }
    MassSampling sampling = sampling_of(spec, robot.value());
    sampling.check_count_max = 1024;
    const SampledMasses sampled = sample_masses(robot.value(), found, scatter.mass_cv, sampling);
    const auto reliability = find_reliability(found, scatter, sampled);
    ASSERT_TRUE(reliability);
    const Mean mean = checked_one_by_one(spec, robot.value(), scatter, 1000, seed);
    EXPECT_LE(reliability->holds_low, mean.mean + 3 * mean.error) << "seed " << seed;
    EXPECT_GE(reliability->holds_high, mean.mean - 3 * mean.error) << "seed " << seed;
    changed += sampled.changed_count > 0 ? 1 : 0;
    ++counted;
  }
  EXPECT_TRUE(changed > 0 || robot_count < 16);
}

TEST(MassSamples, that_cannot_be_checked_are_not_known) {
  int narrower_count = 0;
  for (std::uint64_t seed = 0; seed < 60 && narrower_count == 0; ++seed) {
    const model::RobotSpec spec = test::random_robot(seed);
    const auto robot = model::Robot::create(spec);
    ASSERT_TRUE(robot);
    const Assessment found = assess(robot.value());
    const std::vector<double> cv(robot.value().modules().size(), 0.3);
    const SampledMasses blind = sample_masses(robot.value(), found, cv, {});
    const SampledMasses seen =
        sample_masses(robot.value(), found, cv, sampling_of(spec, robot.value()));
    EXPECT_EQ(blind.changed_count, seen.changed_count);
    const StrengthScatter scatter = {.cv = 0.05, .mass_cv = cv};
    const auto wide = find_reliability(found, scatter, blind);
    const auto narrow = find_reliability(found, scatter, seen);
    ASSERT_EQ(wide.has_value(), narrow.has_value());
    if (!wide || blind.changed_count == 0) {
      continue;
    }
    EXPECT_LE(wide->holds_low, narrow->holds_low);
    EXPECT_GE(wide->holds_high, narrow->holds_high);
    narrower_count +=
        narrow->holds_high - narrow->holds_low < wide->holds_high - wide->holds_low ? 1 : 0;
  }
  EXPECT_GT(narrower_count, 0);
}

TEST(MassSamples, are_none_where_nothing_scatters) {
  const auto robot = model::Robot::create({.existing = {{0, 0, 0}, {0, 0, 1}}});
  const Assessment found = assess(robot.value());
  EXPECT_TRUE(sample_masses(robot.value(), found, std::vector<double>(2), {}).cases.empty());
}

/// Connections that scatter differently: two products, one behind the other.
TEST(MassSamples, go_with_strengths_that_scatter_by_connection) {
  const std::vector<double> ratios = {0.9, 0.8, -1, 0.7};
  const StrengthScatter scatter = {.cv = 0.2, .own_cv = {0.05, 0.2, 0.2, 0.05}};
  const double first = find_reliability(std::vector{0.9, 0.7}, {.cv = 0.05}).holds;
  const double second = find_reliability(std::vector{0.8}, {.cv = 0.2}).holds;
  const Reliability found = find_reliability(ratios, scatter);
  EXPECT_NEAR(found.holds, first * second, 1e-12);
  EXPECT_EQ(found.likeliest.at(0).connection, 1U);
}

}  // namespace
}  // namespace holdfast::verdict
