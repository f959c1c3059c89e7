// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "holdfast/verdict/scatter.hpp"

/// How strong are connections, and how much do they scatter, given what held and what broke?
///
/// Connections are of a few classes, each with a mean strength; all scatter by one cv about it.
/// Loads do not depend on strengths, so an experiment is a list of loads and an outcome, and what
/// is sought maximises the likelihood of all outcomes. An interval at 95 % has all values of a
/// parameter with which, the others chosen best, the logarithm of the likelihood is at most
/// 1.92 below its maximum (half of the quantile of chi squared) [Pawitan 2001].
namespace holdfast::verdict {

/// A connection in an experiment.
struct TestedConnection {
  std::size_t strength_class = 0;
  double load_n = 0;  ///< What its strength has to be more than; it does not break at 0 or less.
};

/// An experiment: connections under loads, and what happened.
struct Experiment {
  enum class Outcome {
    kHeld,
    kBroke,       ///< Some connection did.
    kBrokeThere,  ///< Those of `broken` did, and no others.
    /// All held with these loads, and some broke when `more` came instead of them.
    kHeldThenBroke,
    kPulled,  ///< The load of the only connection grew until it broke, at load_n.
  };

  Outcome outcome = Outcome::kHeld;
  std::vector<TestedConnection> connections = {};
  std::vector<std::size_t> broken = {};  ///< Indices in `connections`.
  std::vector<TestedConnection> more =
      {};  ///< Of all of `connections`, in their order, and others.
};

struct FitOptions {
  StrengthDistribution distribution = StrengthDistribution::kLognormal;
  std::optional<double> cv = {};  ///< Where it is known; else it is fitted.
};

/// A fitted number and its interval at 95 %; no end where any value beyond is as likely.
struct FittedNumber {
  std::optional<double> value = {};
  std::optional<double> low = {};
  std::optional<double> high = {};
};

struct FitResult {
  std::vector<FittedNumber> strengths_n =
      {};                ///< By class; nothing of a class that was not tested.
  FittedNumber cv = {};  ///< The value alone where it was given.
  double log_likelihood = 0;
  /// The probability of each experiment's outcome with the fitted strengths, or for kPulled that of
  /// breaking so early or so late, or more so; 0 for one that cannot be, which is left out.
  std::vector<double> probabilities = {};
  /// Probabilities of the place, given that it broke, of experiments that broke there.
  std::vector<std::optional<double>> place_probabilities = {};
};

/// An outcome that is less probable contradicts the model.
inline constexpr double kContradiction = 0.01;

/// Fits strengths of `class_count` classes. Where nothing broke, or nothing held, there is no
/// largest likelihood: the interval has one end and there is no value.
FitResult fit_strengths(std::span<const Experiment> experiments, std::size_t class_count,
                        const FitOptions& options = {});

/// The most by which the logarithm of the likelihood is below its maximum in an interval at 95 %:
/// half of that quantile of chi squared with one degree of freedom.
inline constexpr double kIntervalDrop = 1.920729;

/// A value of a number and how likely it is, the others chosen best: the logarithm of the
/// likelihood less its maximum.
struct ProfilePoint {
  double value = 0;
  double log_likelihood = 0;
};

/// The profile of a class's strength at `values`, N, which ascend; none where experiments tell
/// nothing of it.
std::vector<ProfilePoint> strength_profile(std::span<const Experiment> experiments,
                                           std::size_t class_count, const FitOptions& options,
                                           std::size_t strength_class,
                                           std::span<const double> values);

/// How much a further experiment, of which only is seen whether it holds, would tell of the fitted
/// numbers: the logarithm of the factor by which the determinant of Fisher's information grows, in
/// the mean over its outcomes. `experiments` are those that were fitted. None where the fit has a
/// number without value. A cv at its lower bound counts as 0.1.
std::optional<double> information_gain(std::span<const Experiment> experiments,
                                       const FitResult& fit, const FitOptions& options,
                                       std::span<const TestedConnection> next);

/// The probability that all of these connections hold.
double probability_of_holding(std::span<const TestedConnection> connections, const FitResult& fit,
                              const FitOptions& options);

}  // namespace holdfast::verdict
