// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "holdfast/verdict/assessment.hpp"

/// How sure is it that every connection holds, where strengths scatter? Loads do not depend on
/// strengths, so all that is needed of a robot is its load ratios.
namespace holdfast::verdict {

/// The distribution of a strength that scatters about the one given, which is its mean.
enum class StrengthDistribution : std::uint8_t {
  kLognormal,
  kNormal,  ///< A strength below zero counts as none.
  kWeibull,
};

/// Returns "lognormal", "normal" or "weibull".
const char* name(StrengthDistribution distribution);

/// The inverse of name().
std::optional<StrengthDistribution> find_strength_distribution(std::string_view name);

/// How strengths scatter. The strength of connection i is G s_i times the one given: s_i of each
/// connection by itself, G of all of them together; all limits of a connection scatter together.
struct StrengthScatter {
  StrengthDistribution distribution = StrengthDistribution::kLognormal;
  double cv = 0;         ///< Standard deviation over mean of s_i, from kCvMin to kCvMax.
  double common_cv = 0;  ///< That of G, whose distribution is the same; 0: there is no G.
};

inline constexpr double kCvMin = 1e-4;
inline constexpr double kCvMax = 1;

/// A factor of mean 1 that scatters.
class ScatteredFactor {
 public:
  /// `cv` from kCvMin to kCvMax.
  ScatteredFactor(StrengthDistribution distribution, double cv);

  /// The probability that the factor is at most `value`, right in both tails; 0 below 0.
  double below(double value) const { return tails(value).below; }

  /// The logarithm of the probability that it is more.
  double log_above(double value) const;

  /// The factor that is passed with the probability with which a standard normal number passes `z`.
  double at_normal(double z) const;

 private:
  struct Tails {
    double below = 0;
    double above = 1;
  };

  Tails tails(double value) const;

  StrengthDistribution distribution_;
  double spread_ = 0;    ///< Of the logarithm or the factor; Weibull's exponent.
  double location_ = 0;  ///< Mean of the logarithm; Weibull's scale.
};

/// One connection that may fail.
struct FailingConnection {
  std::size_t connection = 0;  ///< Its index.
  double load_ratio = 0;
  double share = 0;  ///< The probability that it fails, given that the robot does not hold.
};

/// The probability that every connection holds, and what decides it.
struct Reliability {
  StrengthScatter scatter;
  double holds = 1;  ///< The product over all connections, averaged over G.
  double fails = 0;  ///< 1 - holds, with all its digits where it is small.
  /// What `holds` lies between, by the range of the largest load ratio, which every load ratio may
  /// be off by.
  double holds_low = 1;
  double holds_high = 1;
  std::vector<FailingConnection> likeliest = {};  ///< At most kLikeliestMax, by falling share.
  /// The factor of all strengths that are given with which the robot holds with probability 0.99,
  /// and 0.999; none if no connection is pulled, or no factor does.
  std::optional<double> strength_factor_99 = {};
  std::optional<double> strength_factor_999 = {};
};

inline constexpr std::size_t kLikeliestMax = 10;

/// Says how sure it is that every connection holds with the loads of an assessment. None where the
/// robot is not known to stay, or no load is known: what strengths do is void then.
std::optional<Reliability> find_reliability(const Assessment& assessment,
                                            const StrengthScatter& scatter);

/// Says it for load ratios that are exact.
Reliability find_reliability(std::span<const double> load_ratios, const StrengthScatter& scatter);

}  // namespace holdfast::verdict
