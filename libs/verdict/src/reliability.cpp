// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "holdfast/verdict/reliability.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numeric>
#include <string_view>
#include <utility>

namespace holdfast::verdict {
namespace {

constexpr double kRootOfTwo = 1.41421356237309504880;

/// G is a function of a standard normal number z, and what is asked for is integrated over z by the
/// trapezoidal rule, which converges faster than any power of its step. Beyond this z there is
/// less than 1e-33 of G.
constexpr double kNormalMax = 12;

/// The widest step over z. Where G scatters far more than s, the product over connections falls
/// from 1 to 0 within a fraction of cv / common_cv, and steps are this share of that.
constexpr double kStepMax = 0.125;
constexpr double kStepShare = 0.1;

/// Connections whose probabilities together are below this share of the largest are left out.
constexpr double kNegligible = 1e-18;

/// Factors of strengths are found to this share.
constexpr double kFactorDigits = 1e-7;

/// Connections that fail in fewer cases are not named.
constexpr double kShareMin = 1e-6;

/// No larger factor is sought: a normal distribution of a large cv has too many strengths of zero.
constexpr double kFactorMax = 1e9;

/// The probability that a standard normal number is above z.
double normal_above(double z) { return 0.5 * std::erfc(z / kRootOfTwo); }

/// Weibull's exponent k for a coefficient of variation:
/// cv^2 + 1 = Gamma(1 + 2/k) / Gamma(1 + 1/k)^2, which falls with k.
double weibull_exponent(double cv) {
  double low = 0.5;
  double high = 2 / cv + 2;
  for (int i = 0; i < 100; ++i) {
    const double k = 0.5 * (low + high);
    const double found = std::expm1(std::lgamma(1 + 2 / k) - 2 * std::lgamma(1 + 1 / k));
    (found > cv * cv ? low : high) = k;
  }
  return 0.5 * (low + high);
}

/// What becomes of many connections whose load ratios are divided by one factor.
class Product {
 public:
  /// `ratios` are positive, the largest first.
  Product(std::span<const double> ratios, const StrengthScatter& scatter)
      : ratios_(ratios), own_(scatter.distribution, scatter.cv) {}

  /// The logarithm of the probability that all connections hold if all strengths are multiplied
  /// by `factor`.
  double log_holds(double factor) const {
    double sum = 0;
    double first = 0;
    for (std::size_t i = 0; i < ratios_.size(); ++i) {
      const double log_above = own_.log_above(ratios_[i] / factor);
      first = i == 0 ? log_above : first;
      sum += log_above;
      const bool is_done = static_cast<double>(ratios_.size()) * log_above > kNegligible * first;
      if (is_done || !(sum > -std::numeric_limits<double>::max())) {
        break;
      }
    }
    return sum;
  }

  const ScatteredFactor& own() const { return own_; }

 private:
  std::span<const double> ratios_;
  ScatteredFactor own_;
};

/// The mean over G of what each(G) says; at G = 1 if there is none.
template <class Each>
double mean_over_common(const StrengthScatter& scatter, const Each& each) {
  if (scatter.common_cv == 0) {
    return each(1.0);
  }
  const ScatteredFactor common(scatter.distribution, scatter.common_cv);
  const double step = std::min(kStepMax, kStepShare * scatter.cv / scatter.common_cv);
  const int count = static_cast<int>(kNormalMax / step);
  const double density = step / (kRootOfTwo * std::sqrt(std::acos(-1.0)));
  double sum = 0;
  for (int i = -count; i <= count; ++i) {
    const double z = i * step;
    sum += density * std::exp(-0.5 * z * z) * each(common.at_normal(z));
  }
  return sum;
}

/// The positive load ratios after a change of all by `more`, the largest first, with the indices of
/// their connections.
std::vector<std::size_t> pulled(std::span<const double> ratios, double more) {
  std::vector<std::size_t> order;
  for (std::size_t i = 0; i < ratios.size(); ++i) {
    if (ratios[i] + more > kLoadRatioTie) {
      order.push_back(i);
    }
  }
  std::ranges::stable_sort(order, std::ranges::greater(), [&](std::size_t i) { return ratios[i]; });
  return order;
}

std::vector<double> pulled_ratios(std::span<const double> ratios, double more) {
  std::vector<double> some;
  for (const std::size_t i : pulled(ratios, more)) {
    some.push_back(ratios[i] + more);
  }
  return some;
}

/// The probability that some connection fails with strengths times `factor`.
double failing(std::span<const double> ratios, const StrengthScatter& scatter, double factor) {
  const Product product(ratios, scatter);
  return mean_over_common(
      scatter, [&](double common) { return -std::expm1(product.log_holds(common * factor)); });
}

/// The factor with which some connection fails with probability `fails`, by bisection.
std::optional<double> strength_factor(std::span<const double> ratios,
                                      const StrengthScatter& scatter, double fails) {
  if (ratios.empty()) {
    return std::nullopt;
  }
  double low = ratios.front();
  while (failing(ratios, scatter, low) < fails) {
    low /= 2;
  }
  double high = 2 * low;
  while (failing(ratios, scatter, high) > fails) {
    if (high > kFactorMax) {
      return std::nullopt;
    }
    low = high;
    high *= 2;
  }
  while (high - low > kFactorDigits * high) {
    const double middle = 0.5 * (low + high);
    (failing(ratios, scatter, middle) > fails ? low : high) = middle;
  }
  return high;
}

double clamped(double probability) { return std::min(1.0, std::max(0.0, probability)); }

/// The range of the largest load ratio over all solutions that are known.
LoadRange whole_range(const Assessment& assessment) {
  LoadRange range = assessment.load_ratio_range;
  const auto add = [&](const LoadRange& other, double error) {
    range.low = std::min(range.low, other.low - error);
    range.high = std::max(range.high, other.high + error);
  };
  if (assessment.several) {
    add(assessment.several->regularised, assessment.several->error);
    if (assessment.several->unilateral) {
      add(*assessment.several->unilateral, assessment.several->error);
    }
  }
  return range;
}

}  // namespace

const char* name(StrengthDistribution distribution) {
  switch (distribution) {
    case StrengthDistribution::kLognormal:
      return "lognormal";
    case StrengthDistribution::kNormal:
      return "normal";
    case StrengthDistribution::kWeibull:
      break;
  }
  return "weibull";
}

std::optional<StrengthDistribution> find_strength_distribution(std::string_view name) {
  for (const auto each : {StrengthDistribution::kLognormal, StrengthDistribution::kNormal,
                          StrengthDistribution::kWeibull}) {
    if (name == verdict::name(each)) {
      return each;
    }
  }
  return std::nullopt;
}

ScatteredFactor::ScatteredFactor(StrengthDistribution distribution, double cv)
    : distribution_(distribution) {
  switch (distribution) {
    case StrengthDistribution::kLognormal:
      spread_ = std::sqrt(std::log1p(cv * cv));
      location_ = -0.5 * spread_ * spread_;
      break;
    case StrengthDistribution::kNormal:
      spread_ = cv;
      location_ = 1;
      break;
    case StrengthDistribution::kWeibull:
      spread_ = weibull_exponent(cv);
      location_ = std::exp(-std::lgamma(1 + 1 / spread_));
      break;
  }
}

ScatteredFactor::Tails ScatteredFactor::tails(double value) const {
  if (!(value > 0)) {
    return {};
  }
  if (distribution_ == StrengthDistribution::kWeibull) {
    const double power = std::pow(value / location_, spread_);
    return {.below = -std::expm1(-power), .above = std::exp(-power)};
  }
  const bool is_normal = distribution_ == StrengthDistribution::kNormal;
  const double z = ((is_normal ? value : std::log(value)) - location_) / spread_;
  return {.below = normal_above(-z), .above = normal_above(z)};
}

double ScatteredFactor::log_above(double value) const {
  const Tails both = tails(value);
  return both.below < 0.5 ? std::log1p(-both.below) : std::log(both.above);
}

double ScatteredFactor::at_normal(double z) const {
  constexpr double kSmallest = std::numeric_limits<double>::min();
  switch (distribution_) {
    case StrengthDistribution::kLognormal:
      return std::exp(location_ + spread_ * z);
    case StrengthDistribution::kNormal:
      return std::max(kSmallest, location_ + spread_ * z);
    case StrengthDistribution::kWeibull:
      break;
  }
  const double log_above = z < 0 ? std::log1p(-normal_above(-z)) : std::log(normal_above(z));
  return std::max(kSmallest, location_ * std::pow(-log_above, 1 / spread_));
}

Reliability find_reliability(std::span<const double> load_ratios, const StrengthScatter& scatter) {
  const std::vector<double> ratios = pulled_ratios(load_ratios, 0);
  const Product product(ratios, scatter);
  Reliability found{.scatter = scatter};
  found.fails = clamped(failing(ratios, scatter, 1));
  found.holds = clamped(mean_over_common(
      scatter, [&](double common) { return std::exp(product.log_holds(common)); }));
  found.holds_low = found.holds;
  found.holds_high = found.holds;
  const std::vector<std::size_t> order = pulled(load_ratios, 0);
  for (std::size_t i = 0; i < std::min(order.size(), kLikeliestMax) && found.fails > 0; ++i) {
    const double alone = mean_over_common(
        scatter, [&](double common) { return product.own().below(ratios[i] / common); });
    const double share = clamped(alone / found.fails);
    if (i > 0 && share < kShareMin) {
      break;
    }
    found.likeliest.push_back({.connection = order[i], .load_ratio = ratios[i], .share = share});
  }
  found.strength_factor_99 = strength_factor(ratios, scatter, 0.01);
  found.strength_factor_999 = strength_factor(ratios, scatter, 0.001);
  return found;
}

std::optional<Reliability> find_reliability(const Assessment& assessment,
                                            const StrengthScatter& scatter) {
  const bool is_standing = known_stability(assessment) == std::optional(true);
  const bool is_solved = assessment.equilibrium.outcome == solver::Outcome::kSettled;
  if (!is_standing || !is_solved || assessment.whole) {
    return std::nullopt;
  }
  std::vector<double> ratios;
  for (const ConnectionResult& connection : assessment.connections) {
    if (!std::isfinite(connection.load_ratio)) {
      return std::nullopt;
    }
    ratios.push_back(connection.load_ratio);
  }
  Reliability found = find_reliability(ratios, scatter);
  if (assessment.load_ratio_max) {
    const LoadRange range = whole_range(assessment);
    if (!std::isfinite(range.low) || !std::isfinite(range.high)) {
      return std::nullopt;
    }
    const auto holds_with = [&](double more) {
      return clamped(1 - failing(pulled_ratios(ratios, more), scatter, 1));
    };
    found.holds_low = std::min(found.holds, holds_with(range.high - *assessment.load_ratio_max));
    found.holds_high = std::max(found.holds, holds_with(range.low - *assessment.load_ratio_max));
  }
  return found;
}

}  // namespace holdfast::verdict
