// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "holdfast/verdict/scatter.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace holdfast::verdict {
namespace {

constexpr double kRootOfTwo = 1.41421356237309504880;

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

}  // namespace holdfast::verdict
