// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

/// How parts of a robot that are made alike differ all the same.
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

inline constexpr double kCvMin = 1e-4;
inline constexpr double kCvMax = 1;
inline constexpr double kMassCvMax = 0.3;  ///< Beyond that a normal mass may be below zero.

/// How strengths and masses scatter. The strength of connection i is G s_i times the one given: s_i
/// of each connection by itself, G of all of them together; all limits of a connection scatter
/// together.
struct StrengthScatter {
  StrengthDistribution distribution = StrengthDistribution::kLognormal;
  double cv = 0;         ///< Standard deviation over mean of s_i, from kCvMin to kCvMax.
  double common_cv = 0;  ///< That of G, whose distribution is the same; 0: there is no G.
  /// The cv of each s_i, by connection, where they are not all `cv`, which is then the largest.
  std::vector<double> own_cv = {};
  /// The distribution of each s_i, by connection; empty: all are `distribution`, as that of G is.
  std::vector<StrengthDistribution> own_distribution = {};
  /// The cv of each module's mass, by module, from 0 to kMassCvMax; normal, and independent of each
  /// other. Empty: masses do not scatter.
  std::vector<double> mass_cv = {};

  StrengthDistribution distribution_of(std::size_t connection) const {
    return own_distribution.empty() ? distribution : own_distribution[connection];
  }

  double cv_of(std::size_t connection) const { return own_cv.empty() ? cv : own_cv[connection]; }
};

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

}  // namespace holdfast::verdict
