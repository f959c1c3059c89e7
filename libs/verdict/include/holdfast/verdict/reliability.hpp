// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "holdfast/verdict/assessment.hpp"
#include "holdfast/verdict/mass_samples.hpp"
#include "holdfast/verdict/scatter.hpp"

/// How sure is it that every connection holds, where strengths scatter? Loads do not depend on
/// strengths, so all that is needed of a robot is its load ratios.
namespace holdfast::verdict {

/// One connection that may fail.
struct FailingConnection {
  std::size_t connection = 0;  ///< Its index.
  double load_ratio = 0;
  double share = 0;  ///< The probability that it fails, given that the robot does not hold.
};

/// What a factor of strengths lies between, with 95 %.
struct FactorRange {
  std::optional<double> low = {};   ///< None: no factor is known to be too small.
  std::optional<double> high = {};  ///< None: samples are too few to say that any suffices.
};

/// The probability that every connection holds, and what decides it.
struct Reliability {
  StrengthScatter scatter;
  double holds = 1;  ///< The product over all connections, averaged over G.
  double fails = 0;  ///< 1 - holds, with all its digits where it is small.
  /// What `holds` lies between, by the range of the largest load ratio, which every load ratio may
  /// be off by, and three standard deviations of what samples of masses say.
  double holds_low = 1;
  double holds_high = 1;
  std::vector<FailingConnection> likeliest = {};  ///< So many as were asked for, by falling share.
  /// The factor of all strengths that are given with which the robot holds with probability 0.99,
  /// and 0.999; none if no connection is pulled, or no factor does.
  std::optional<double> strength_factor_99 = {};
  std::optional<double> strength_factor_999 = {};
  FactorRange factor_range_99 = {};  ///< What each of them lies between, by samples of masses.
  FactorRange factor_range_999 = {};
  std::size_t sample_count = 0;   ///< Of masses; 0 where they do not scatter.
  std::size_t changed_count = 0;  ///< Those of them in which facets are in other states.
};

inline constexpr std::size_t kLikeliestMax = 10;

/// The load ratios of a robot that are known to be right; none where it is not known to stay, or no
/// load is known.
std::optional<std::vector<double>> known_ratios(const Assessment& assessment);

/// Says how sure it is that every connection holds with the loads of an assessment, or with those
/// of sampled masses. None where known_ratios() are none: what strengths do is void then.
std::optional<Reliability> find_reliability(const Assessment& assessment,
                                            const StrengthScatter& scatter,
                                            const SampledMasses& sampled = {},
                                            std::size_t likeliest_max = kLikeliestMax);

/// Says it for cases that are all as likely as each other, one or pairs of opposite samples.
/// `is_linear`: loads are linear in numbers that are normal, as masses are while facets keep their
/// states, so that one that is far from its limit does not come there.
Reliability find_reliability(std::span<const LoadCase> cases, const StrengthScatter& scatter,
                             std::size_t likeliest_max = kLikeliestMax, bool is_linear = false);

/// Whether a robot holds with a probability that is asked for: safe if so, overload if certainly
/// not, undecided where bounds leave it open or nothing is known. Safe if 0 is asked.
Verdict judge_probability(const std::optional<Reliability>& sure, double asked);

/// Says it for load ratios that are exact.
Reliability find_reliability(std::span<const double> load_ratios, const StrengthScatter& scatter);

}  // namespace holdfast::verdict
