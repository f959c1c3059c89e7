// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
//
// Probabilities against closed forms (one connection; products of lognormal numbers, which are
// lognormal), and against samples of strengths.
#include "holdfast/verdict/reliability.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include "holdfast/base/rng.hpp"
#include "random_robot.hpp"
#include "seeds.hpp"

namespace holdfast::verdict {
namespace {

using enum StrengthDistribution;

constexpr std::array kAll = {kLognormal, kNormal, kWeibull};

double normal_below(double z) { return 0.5 * std::erfc(-z / std::numbers::sqrt2); }

/// The probability that a lognormal number of mean 1 is at most `value`.
double lognormal_below(double value, double variance_of_log) {
  return normal_below((std::log(value) + variance_of_log / 2) / std::sqrt(variance_of_log));
}

double variance_of_log(double cv) { return std::log(1 + cv * cv); }

double normal_draw(base::Rng& rng) {
  double sum = -6;
  for (int i = 0; i < 12; ++i) {
    sum += static_cast<double>(rng.below(1U << 20U)) / (1U << 20U);
  }
  return sum;
}

// Strengths as given, and masses under which the one connection breaks in one of 30 to 30,000
// cases: of 256 samples often none does.
TEST(Reliability, that_samples_are_too_few_for_is_within_its_bounds) {
  int within = 0;
  int count = 0;
  for (const double z : {1.8, 2.5, 3.0, 3.5, 4.0}) {
    const double holds = normal_below(z);
    for (std::uint64_t seed = 0; seed < 60; ++seed) {
      base::Rng rng(seed);
      std::vector<LoadCase> cases;
      for (int i = 0; i < 128; ++i) {
        const double way = 0.1 * normal_draw(rng);
        const double mean = 1 - 0.1 * z;
        cases.push_back({.ratios = {mean + way}});
        cases.push_back({.ratios = {mean - way}});
      }
      const Reliability found = find_reliability(cases, {.cv = kCvMin});
      within += found.holds_low <= holds && holds <= found.holds_high ? 1 : 0;
      ++count;
    }
  }
  EXPECT_GE(within, count - count / 50) << count;
  // Far from the limit there is no doubt.
  const std::vector<LoadCase> far = {{.ratios = {0.3}}, {.ratios = {0.32}}};
  EXPECT_EQ(find_reliability(far, {.cv = kCvMin}).holds_low, 1);
}

TEST(Reliability, of_one_connection_is_its_distribution_even_far_out) {
  for (const double ratio : {0.05, 0.3, 0.7, 0.95, 1.0, 1.3}) {
    const double fails = lognormal_below(ratio, variance_of_log(0.1));
    const Reliability found = find_reliability(std::array{ratio}, {.cv = 0.1});
    EXPECT_NEAR(found.fails, fails, 1e-11 * fails) << ratio;
    EXPECT_NEAR(found.holds, 1 - fails, 1e-12) << ratio;
    ASSERT_EQ(found.likeliest.size(), 1U);
    EXPECT_NEAR(found.likeliest[0].share, 1, 1e-12);
  }
  const double normal = normal_below((0.4 - 1) / 0.05);  // 12 standard deviations out.
  EXPECT_NEAR(
      find_reliability(std::array{0.4}, {.distribution = kNormal, .cv = 0.05}).fails / normal, 1,
      1e-11);
}

TEST(Reliability, of_many_is_the_product_with_all_digits_of_small_probabilities) {
  const double one = lognormal_below(0.4, variance_of_log(0.1));
  ASSERT_LT(one, 1e-18);  // 1 - one is 1.
  const std::vector<double> many(1000, 0.4);
  EXPECT_NEAR(find_reliability(many, {.cv = 0.1}).fails / (1000 * one), 1, 1e-9);
}

/// G s is lognormal, and the variances of the logarithms add up.
TEST(Reliability, with_a_common_factor_is_that_of_a_product_of_two) {
  for (const auto& [own, common] : std::vector<std::pair<double, double>>{
           {0.1, 0.05}, {0.1, 0.1}, {0.02, 0.2}, {0.001, 0.5}, {0.5, 0.001}, {1, 1}}) {
    const double variance = variance_of_log(own) + variance_of_log(common);
    for (const double z : {-7.0, -3.0, 0.0, 1.0}) {
      const double ratio = std::exp(z * std::sqrt(variance) - variance / 2);
      const Reliability found =
          find_reliability(std::array{ratio}, {.cv = own, .common_cv = common});
      EXPECT_NEAR(found.fails / normal_below(z), 1, 1e-9) << own << " " << common << " " << z;
      EXPECT_NEAR(found.holds, 1 - normal_below(z), 1e-10);
    }
  }
}

TEST(Reliability, of_connections_in_step_lies_between_the_worst_and_all_by_themselves) {
  const std::vector<double> ratios = {0.8, 0.79, 0.75, 0.7, -0.5, 0};
  for (const StrengthDistribution distribution : kAll) {
    const double alone =
        find_reliability(std::array{0.8}, {.distribution = distribution, .cv = 0.1}).fails;
    const double apart = find_reliability(ratios, {.distribution = distribution, .cv = 0.1}).fails;
    const double together =
        find_reliability(ratios, {.distribution = distribution, .cv = 1e-3, .common_cv = 0.1})
            .fails;
    EXPECT_GT(apart, alone);
    EXPECT_NEAR(together, alone, 0.02 * alone) << name(distribution);
  }
}

TEST(Reliability, factors_have_the_mean_one_and_the_given_cv) {
  for (const StrengthDistribution distribution : kAll) {
    for (const double cv : {0.003, 0.05, 0.15}) {
      const ScatteredFactor factor(distribution, cv);
      double mean = 0;
      double square = 0;
      for (int i = -1000; i <= 1000; ++i) {
        const double z = i * 0.01;
        const double weight = 0.01 * std::exp(-z * z / 2) / std::sqrt(2 * std::numbers::pi);
        mean += weight * factor.at_normal(z);
        square += weight * std::pow(factor.at_normal(z) - 1, 2);
        EXPECT_NEAR(factor.below(factor.at_normal(z)), normal_below(z), 1e-9);
      }
      EXPECT_NEAR(mean, 1, 1e-8) << name(distribution) << cv;
      EXPECT_NEAR(std::sqrt(square), cv, 1e-7 * cv) << name(distribution) << cv;
    }
  }
}

TEST(Reliability, is_as_asked_with_strengths_times_the_factors) {
  const std::vector<double> ratios = {0.9, 0.85, 0.5, 0.1, -1};
  for (const StrengthDistribution distribution : kAll) {
    for (const double common : {0.0, 0.05}) {
      const StrengthScatter scatter = {
          .distribution = distribution, .cv = 0.12, .common_cv = common};
      const Reliability found = find_reliability(ratios, scatter);
      for (const auto& [factor, holds] : {std::pair(*found.strength_factor_99, 0.99),
                                          std::pair(*found.strength_factor_999, 0.999)}) {
        std::vector<double> less = ratios;
        std::ranges::transform(less, less.begin(), [f = factor](double r) { return r / f; });
        EXPECT_NEAR(find_reliability(less, scatter).holds, holds, 1e-6);
      }
    }
  }
}

TEST(Reliability, has_no_factor_where_none_helps_and_needs_none_without_tension) {
  const Reliability wild = find_reliability(std::array{0.5}, {.distribution = kNormal, .cv = 1});
  EXPECT_FALSE(wild.strength_factor_99);  // 16 % of these have no strength at all.
  const Reliability pressed = find_reliability(std::array{-0.5, 0.0}, {.cv = 0.3});
  EXPECT_EQ(pressed.holds, 1);
  EXPECT_EQ(pressed.fails, 0);
  EXPECT_TRUE(pressed.likeliest.empty());
  EXPECT_FALSE(pressed.strength_factor_999);
}

/// One strength after the other, by Box and Muller.
class Sampler {
 public:
  explicit Sampler(std::uint64_t seed) : rng_(seed) {}

  double factor(StrengthDistribution distribution, double cv) {
    if (cv == 0) {
      return 1;
    }
    const ScatteredFactor law(distribution, cv);
    return law.at_normal(normal());
  }

  double normal() {
    const double size = std::sqrt(-2 * std::log(1 - uniform()));
    return size * std::cos(2 * std::numbers::pi * uniform());
  }

 private:
  double uniform() { return static_cast<double>(rng_.next() >> 11U) * 0x1p-53; }

  base::Rng rng_;
};

/// The factor with which a robot whose loads alone scatter holds with 0.99 or 0.999 is a quantile
/// of its load ratio: of 1 + 0.05 z with z normal, and of 0.5 + x / 10 with x exponential, which is
/// not linear in normal numbers. Each campaign of samples gives intervals, of which at 95 % not
/// more may miss the quantile. Samples of a pair are independent, alike, or opposite.
struct BoundCampaign {
  std::array<int, 2> missed = {};  ///< For 0.99 and for 0.999.
  std::array<int, 2> bounded = {};

  void add(std::size_t which, const FactorRange& range, double truth) {
    constexpr double kNear = 1e-3;  // Strengths of cv 1e-4 are not quite as given.
    const bool is_within = range.low.value_or(0) <= truth * (1 + kNear) &&
                           range.high.value_or(truth) >= truth * (1 - kNear);
    missed.at(which) += is_within ? 0 : 1;
    bounded.at(which) += range.high ? 1 : 0;
  }
};

BoundCampaign bound_campaign(bool is_normal, int kind, int count, Sampler& sampler) {
  const auto ratio = [is_normal](double z) {
    return is_normal ? 1 + 0.05 * z : 0.5 - 0.1 * std::log(normal_below(-z));
  };
  BoundCampaign campaign;
  for (int i = 0; i < count; ++i) {
    std::vector<LoadCase> cases;
    for (int pair = 0; pair < 512; ++pair) {
      const double first = sampler.normal();
      const double second = kind == 0 ? sampler.normal() : kind == 1 ? first : -first;
      cases.push_back({.ratios = {ratio(first)}});
      cases.push_back({.ratios = {ratio(second)}});
    }
    const Reliability found = find_reliability(cases, {.cv = kCvMin}, 1, is_normal);
    campaign.add(0, found.factor_range_99, ratio(2.3263479));
    campaign.add(1, found.factor_range_999, ratio(3.0902323));
  }
  return campaign;
}

TEST(Reliability, factors_lie_within_their_bounds_as_often_as_is_said) {
  const int count = test::campaign(60);
  const double allowed = 0.05 * count + 3 * std::sqrt(0.0475 * count);
  Sampler sampler(4);
  for (const bool is_normal : {true, false}) {
    for (const int kind : {0, 1, 2}) {
      const BoundCampaign found = bound_campaign(is_normal, kind, count, sampler);
      EXPECT_LE(found.missed[0], allowed) << is_normal << kind;
      EXPECT_LE(found.missed[1], allowed) << is_normal << kind;
      EXPECT_EQ(found.bounded[0], count) << is_normal << kind;
      EXPECT_EQ(found.bounded[1], is_normal ? count : 0) << "1,024 samples do not tell it";
    }
  }
}

/// Where strengths scatter more than loads a few samples suffice.
TEST(Reliability, factors_of_smooth_probabilities_are_narrow) {
  Sampler sampler(5);
  std::vector<LoadCase> cases;
  for (int pair = 0; pair < 512; ++pair) {
    const double z = sampler.normal();
    cases.push_back({.ratios = {0.8 * (1 + 0.01 * z)}});
    cases.push_back({.ratios = {0.8 * (1 - 0.01 * z)}});
  }
  const Reliability found = find_reliability(cases, {.cv = 0.1}, 1, true);
  // Of a product of two lognormal numbers the variances of the logarithms add.
  const double variance = variance_of_log(0.1) + 0.01 * 0.01;
  const double exact = 0.8 * std::exp(3.0902323 * std::sqrt(variance) + variance_of_log(0.1) / 2);
  EXPECT_NEAR(*found.strength_factor_999, exact, 2e-3 * exact);
  EXPECT_LT(*found.factor_range_999.low, *found.strength_factor_999);
  EXPECT_GT(*found.factor_range_999.high, *found.strength_factor_999);
  EXPECT_LT(*found.factor_range_999.high - *found.factor_range_999.low, 0.01);
}

TEST(Reliability, factors_have_no_bounds_where_too_few_samples_are_known) {
  std::vector<LoadCase> cases(1024, {.ratios = {0.5}});
  const Reliability found = find_reliability(cases, {.cv = kCvMin});
  EXPECT_TRUE(found.factor_range_99.high);  // 0.99^512 is 0.006, below 0.025; 0.999^512 is 0.6.
  EXPECT_FALSE(found.factor_range_999.high);
  std::fill_n(cases.begin(), 8, LoadCase{.state = CaseState::kUnknown});
  EXPECT_FALSE(find_reliability(cases, {.cv = kCvMin}).factor_range_99.high);
  std::ranges::fill(cases, LoadCase{.state = CaseState::kUnknown});
  cases[0] = {.ratios = {0.5}};
  const Reliability none = find_reliability(cases, {.cv = kCvMin});
  EXPECT_FALSE(none.factor_range_99.low);
  EXPECT_FALSE(none.factor_range_99.high);
}

/// Against the share of samples in which all connections hold.
TEST(Reliability, is_that_of_samples_on_random_robots) {
  const int robot_count = test::campaign(20);
  const int sample_count = test::campaign(4000);
  int counted = 0;
  for (std::uint64_t seed = 0; counted < robot_count; ++seed) {
    const auto robot = model::Robot::create(test::random_robot(seed));
    ASSERT_TRUE(robot);
    const Assessment assessment = assess(robot.value());
    if (!assessment.is_stable || !assessment.worst) {
      continue;
    }
    const double scale = 0.85 / *assessment.load_ratio_max;
    std::vector<double> ratios;
    for (const ConnectionResult& one : assessment.connections) {
      ratios.push_back(one.load_ratio * scale);
    }
    StrengthScatter scatter = {
        .distribution = kAll[seed % 3], .cv = 0.1, .common_cv = seed % 2 == 0 ? 0.08 : 0.0};
    for (std::size_t i = 0; seed % 5 < 2 && i < ratios.size(); ++i) {
      scatter.own_cv.push_back(i % 4 == 0 ? 0.2 : 0.1);
      scatter.own_distribution.push_back(kAll[(seed + i) % 3]);
    }
    const Reliability found = find_reliability(ratios, scatter);
    Sampler sampler(seed);
    std::vector<ScatteredFactor> own;
    for (std::size_t i = 0; i < ratios.size(); ++i) {
      own.emplace_back(scatter.distribution_of(i), scatter.cv_of(i));
    }
    int holds = 0;
    for (int i = 0; i < sample_count; ++i) {
      const double common = sampler.factor(scatter.distribution, scatter.common_cv);
      bool is_whole = true;
      for (std::size_t k = 0; k < ratios.size(); ++k) {
        const bool is_pulled = ratios[k] > 0;
        is_whole =
            (!is_pulled || common * own[k].at_normal(sampler.normal()) > ratios[k]) && is_whole;
      }
      holds += is_whole ? 1 : 0;
    }
    const double sigma = std::sqrt(found.holds * found.fails / sample_count);
    EXPECT_NEAR(static_cast<double>(holds) / sample_count, found.holds,
                4 * sigma + 1.0 / sample_count)
        << "seed " << seed;
    ++counted;
  }
}

}  // namespace
}  // namespace holdfast::verdict
