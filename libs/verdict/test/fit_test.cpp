// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
//
// Fits against closed forms (pull tests of lognormal strengths: the mean and the standard deviation
// of logarithms; one structure that held or broke), and against experiments that are made up with
// known strengths: how often is the truth in the interval?
#include "holdfast/verdict/fit.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "holdfast/base/rng.hpp"
#include "seeds.hpp"

namespace holdfast::verdict {
namespace {

using enum Experiment::Outcome;

/// Strengths that are drawn.
class Magnets {
 public:
  Magnets(std::uint64_t seed, double cv) : rng_(seed), law_(StrengthDistribution::kLognormal, cv) {}

  double draw(double mean) {
    const double size = std::sqrt(-2 * std::log(1 - uniform()));
    return mean * law_.at_normal(size * std::cos(2 * std::numbers::pi * uniform()));
  }

  double uniform() { return static_cast<double>(rng_.next() >> 11U) * 0x1p-53; }

 private:
  base::Rng rng_;
  ScatteredFactor law_;
};

Experiment pulled(double load, std::size_t strength_class = 0) {
  return {.outcome = kPulled, .connections = {{strength_class, load}}};
}

TEST(Fit, of_pull_tests_is_that_of_their_logarithms) {
  const std::vector<double> loads = {10.2, 12.9, 11.1, 9.5, 13.3, 11.8};
  std::vector<Experiment> experiments;
  double mean = 0;
  for (const double load : loads) {
    experiments.push_back(pulled(load));
    mean += std::log(load) / 6;
  }
  double variance = 0;
  for (const double load : loads) {
    variance += std::pow(std::log(load) - mean, 2) / 6;
  }
  const FitResult found = fit_strengths(experiments, 1);
  // The mean of a lognormal number, and its cv.
  EXPECT_NEAR(*found.strengths_n[0].value / std::exp(mean + variance / 2), 1, 1e-4);
  EXPECT_NEAR(*found.cv.value / std::sqrt(std::expm1(variance)), 1, 1e-3);
  EXPECT_LT(*found.strengths_n[0].low, *found.strengths_n[0].value);
  EXPECT_GT(*found.strengths_n[0].high, *found.strengths_n[0].value);
}

/// The profile is the likelihood where the cv is known: a pull test's interval is symmetric in the
/// logarithm, 1.96 standard deviations.
TEST(Fit, with_a_known_cv_has_the_interval_of_a_normal_number) {
  const FitResult found = fit_strengths(std::vector{pulled(10)}, 1, {.cv = 0.1});
  const double spread = std::sqrt(std::log(1.01));
  EXPECT_NEAR(std::log(*found.strengths_n[0].high / *found.strengths_n[0].low),
              2 * 1.959964 * spread, 1e-4);
}

TEST(Fit, has_one_end_where_nothing_broke_or_nothing_held) {
  const Experiment held = {.outcome = kHeld, .connections = {{0, 8}, {0, 5}}};
  const Experiment broke = {.outcome = kBroke, .connections = {{0, 9}}};
  const FitResult strong = fit_strengths(std::vector{held, held}, 1, {.cv = 0.1});
  EXPECT_FALSE(strong.strengths_n[0].value);
  EXPECT_FALSE(strong.strengths_n[0].high);
  ASSERT_TRUE(strong.strengths_n[0].low);
  // At that end the likelihood is exp(-1.92): (1 - F(8)) (1 - F(5)), twice.
  EXPECT_NEAR(2 * std::log(probability_of_holding(
                      held.connections, {.strengths_n = {{.value = strong.strengths_n[0].low}}},
                      {.cv = 0.1})),
              -1.920729, 1e-3);
  const FitResult weak = fit_strengths(std::vector{broke}, 1, {.cv = 0.1});
  EXPECT_FALSE(weak.strengths_n[0].value);
  EXPECT_FALSE(weak.strengths_n[0].low);
  EXPECT_TRUE(weak.strengths_n[0].high);
  const FitResult nothing = fit_strengths({}, 2);
  EXPECT_FALSE(nothing.strengths_n[0].value || nothing.cv.value);
}

TEST(Fit, between_what_held_and_what_broke) {
  const std::vector<Experiment> both = {{.outcome = kHeld, .connections = {{0, 8}}},
                                        {.outcome = kBroke, .connections = {{0, 9}}}};
  const FitResult found = fit_strengths(both, 1);
  ASSERT_TRUE(found.strengths_n[0].value);
  EXPECT_GT(*found.strengths_n[0].value, 8);
  EXPECT_LT(*found.strengths_n[0].value, 9.2);
  EXPECT_NEAR(found.log_likelihood, 0, 1e-3);  // Scatter need not be.
  EXPECT_FALSE(found.cv.low);
}

/// A module more hangs below: what held before is what each connection carries less.
TEST(Fit, of_a_chain_takes_what_held_into_account) {
  Experiment chain = {.outcome = kHeldThenBroke, .connections = {}, .more = {}};
  for (int k = 1; k <= 20; ++k) {
    chain.connections.push_back({0, 0.599 * k});
    chain.more.push_back({0, 0.599 * (k + 1)});
  }
  const FitResult found = fit_strengths(std::vector{chain}, 1, {.cv = 0.02});
  EXPECT_GT(*found.strengths_n[0].value, 0.599 * 20);
  EXPECT_LT(*found.strengths_n[0].value, 0.599 * 22);
}

TEST(Fit, names_what_contradicts_it) {
  std::vector<Experiment> experiments;
  for (const double load : {9.8, 10.0, 10.1, 10.2, 9.9}) {
    experiments.push_back(pulled(load));
  }
  experiments.push_back({.outcome = kHeld, .connections = {{0, 5}}});
  experiments.push_back({.outcome = kBrokeThere, .connections = {{0, 5}, {0, 12}}, .broken = {0}});
  experiments.push_back({.outcome = kBrokeThere, .connections = {{0, -2}}, .broken = {0}});
  const FitResult found = fit_strengths(experiments, 1, {.cv = 0.05});
  EXPECT_GT(found.probabilities[5], 0.9);
  EXPECT_LT(*found.place_probabilities[6], kContradiction);
  EXPECT_EQ(found.probabilities[7], 0);
}

/// What is as likely to hold as not tells most of one strength whose scatter is known.
TEST(Fit, learns_most_from_what_may_break) {
  const std::vector<Experiment> experiments = {pulled(10)};
  const FitOptions options = {.cv = 0.1};
  const FitResult fit = fit_strengths(experiments, 1, options);
  const auto gain = [&](double load) {
    return *information_gain(experiments, fit, options, std::vector<TestedConnection>{{0, load}});
  };
  EXPECT_GT(gain(10), gain(8));
  EXPECT_GT(gain(10), gain(13));
  EXPECT_NEAR(gain(1), 0, 1e-9);
}

struct Truth {
  std::vector<double> strengths = {11.98, 14.97};
  double cv = 0.12;
};

/// Pull tests and structures, of both classes.
std::vector<Experiment> made_up(const Truth& truth, std::uint64_t seed) {
  Magnets magnets(seed, truth.cv);
  std::vector<Experiment> experiments;
  for (int i = 0; i < 8; ++i) {
    experiments.push_back(pulled(magnets.draw(truth.strengths[0]), 0));
    experiments.push_back(pulled(magnets.draw(truth.strengths[1]), 1));
  }
  for (int i = 0; i < 14; ++i) {
    Experiment one;
    for (std::size_t k = 0; k < 6; ++k) {
      one.connections.push_back({k % 2, truth.strengths[k % 2] * (0.5 + 0.6 * magnets.uniform())});
      if (magnets.draw(truth.strengths[k % 2]) <= one.connections.back().load_n) {
        one.broken.push_back(k);
      }
    }
    one.outcome = one.broken.empty() ? kHeld : i % 2 == 0 ? kBroke : kBrokeThere;
    experiments.push_back(std::move(one));
  }
  return experiments;
}

/// Strengths that were measured one by one, with a known lognormal scatter s: the profile is a
/// parabola in the logarithm, n (log v - mean)^2 / (2 s^2) below its top.
TEST(Fit, has_the_profile_that_a_closed_form_has) {
  const std::vector<double> forces = {9, 10, 10.5, 12};
  std::vector<Experiment> pulls;
  double mean = 0;
  for (const double force : forces) {
    pulls.push_back({.outcome = kPulled, .connections = {{.strength_class = 1, .load_n = force}}});
    mean += std::log(force) / static_cast<double>(forces.size());
  }
  const FitOptions options{.cv = 0.1};
  const double spread = std::sqrt(std::log1p(0.01));
  const double top = mean + spread * spread / 2;  // The strength is the mean, not the median.
  const std::vector<double> values = {8, 9.5, 10, 10.4, 11, 13};
  const auto profile = strength_profile(pulls, 2, options, 1, values);
  ASSERT_EQ(profile.size(), values.size());
  for (std::size_t i = 0; i < values.size(); ++i) {
    const double way = (std::log(values[i]) - top) / spread;
    EXPECT_EQ(profile[i].value, values[i]);
    EXPECT_NEAR(profile[i].log_likelihood, -2 * way * way, 1e-5 * (1 + way * way));
  }
  EXPECT_TRUE(strength_profile(pulls, 2, options, 0, values).empty());
  const FitResult found = fit_strengths(pulls, 2, options);
  const std::vector<double> ends = {*found.strengths_n[1].low, *found.strengths_n[1].high};
  for (const ProfilePoint& end : strength_profile(pulls, 2, options, 1, ends)) {
    EXPECT_NEAR(end.log_likelihood, -kIntervalDrop, 1e-4);
  }
}

TEST(Fit, has_the_truth_in_its_intervals_as_often_as_it_says) {
  const Truth truth;
  const int count = test::campaign(10);  // 300 take some minutes.
  std::array<int, 3> covered{};
  for (int i = 0; i < count; ++i) {
    const auto experiments = made_up(truth, static_cast<std::uint64_t>(i));
    const FitResult found = fit_strengths(experiments, 2);
    const auto has = [](const FittedNumber& number, double value) {
      return number.low.value_or(0) <= value && value <= number.high.value_or(1e9) ? 1 : 0;
    };
    covered[0] += has(found.strengths_n[0], truth.strengths[0]);
    covered[1] += has(found.strengths_n[1], truth.strengths[1]);
    covered[2] += has(found.cv, truth.cv);
  }
  for (const int one : covered) {
    // 0.9 to 0.97 of 300; of fewer as far as chance goes, three standard deviations of 0.94.
    const double slack = count == 300 ? 0 : 3 * std::sqrt(0.94 * 0.06 / count);
    EXPECT_GE(static_cast<double>(one) / count, 0.9 - slack);
    EXPECT_LE(static_cast<double>(one) / count, 0.97 + slack);
    RecordProperty("covered", one);
  }
}

}  // namespace
}  // namespace holdfast::verdict
