// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "holdfast/verdict/reliability.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <utility>

namespace holdfast::verdict {
namespace {

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

/// The connections of which it is found how often they fail where load ratios scatter, too.
constexpr std::size_t kLookedAtMax = 40;

/// Connections that fail in fewer cases are not named.
constexpr double kShareMin = 1e-6;

/// No larger factor is sought: a normal distribution of a large cv has too many strengths of zero.
constexpr double kFactorMax = 1e9;
/// No smaller one, as a share of the largest load ratio: all that is known holds with it.
constexpr double kFactorMin = 1e-9;
/// Bounds of factors are found to this share.
constexpr double kBoundDigits = 1e-5;
/// Halvings of an interval within 0 to 1, which leave nothing of it.
constexpr int kChanceBisections = 60;

/// How a strength scatters: its distribution and cv.
using Law = std::pair<StrengthDistribution, double>;

Law law_of(const StrengthScatter& scatter, std::size_t connection) {
  return {scatter.distribution_of(connection), scatter.cv_of(connection)};
}

/// What becomes of the connections of one robot whose load ratios are divided by one factor.
class Product {
 public:
  /// All load ratios change by `more`; those that are positive then are taken.
  Product(std::span<const double> ratios, const StrengthScatter& scatter, double more) {
    std::map<Law, std::vector<double>> by_law;
    for (std::size_t i = 0; i < ratios.size(); ++i) {
      if (ratios[i] + more > kLoadRatioTie) {
        by_law[law_of(scatter, i)].push_back(ratios[i] + more);
      }
    }
    for (auto& [law, some] : by_law) {
      std::ranges::sort(some, std::ranges::greater());
      largest_ = std::max(largest_, some.front());
      groups_.push_back({ScatteredFactor(law.first, law.second), std::move(some)});
    }
  }

  /// The logarithm of the probability that all connections hold if all strengths are multiplied
  /// by `factor`.
  double log_holds(double factor) const {
    double sum = 0;
    for (const Group& group : groups_) {
      sum += log_holds(group, factor);
    }
    return sum;
  }

  /// The largest load ratio; 0 if nothing is pulled.
  double largest() const { return largest_; }

 private:
  /// Connections that scatter alike, by falling load ratio.
  struct Group {
    ScatteredFactor own;
    std::vector<double> ratios;
  };

  static double log_holds(const Group& group, double factor) {
    double sum = 0;
    double first = 0;
    const auto count = static_cast<double>(group.ratios.size());
    for (std::size_t i = 0; i < group.ratios.size(); ++i) {
      const double log_above = group.own.log_above(group.ratios[i] / factor);
      first = i == 0 ? log_above : first;
      sum += log_above;
      const bool is_done = count * log_above > kNegligible * first;
      if (is_done || !(sum > -std::numeric_limits<double>::max())) {
        break;
      }
    }
    return sum;
  }

  std::vector<Group> groups_;
  double largest_ = 0;
};

/// The mean over G of what each(G) says; at G = 1 if there is none.
template <class Each>
double mean_over_common(const StrengthScatter& scatter, const Each& each) {
  if (scatter.common_cv == 0) {
    return each(1.0);
  }
  const ScatteredFactor common(scatter.distribution, scatter.common_cv);
  const double least =
      scatter.own_cv.empty() ? scatter.cv : *std::ranges::min_element(scatter.own_cv);
  const double step = std::min(kStepMax, kStepShare * least / scatter.common_cv);
  const int count = static_cast<int>(kNormalMax / step);
  const double density = step / std::sqrt(2 * std::acos(-1.0));
  double sum = 0;
  for (int i = -count; i <= count; ++i) {
    const double z = i * step;
    sum += density * std::exp(-0.5 * z * z) * each(common.at_normal(z));
  }
  return sum;
}

/// All cases of one robot.
class Cases {
 public:
  Cases(std::span<const LoadCase> cases, const StrengthScatter& scatter, double more = 0)
      : scatter_(scatter) {
    for (const LoadCase& one : cases) {
      const bool is_known = one.state == CaseState::kKnown;
      states_.push_back(one.state);
      products_.emplace_back(
          is_known ? std::span<const double>(one.ratios) : std::span<const double>(), scatter,
          more);
    }
  }

  /// The probability that all connections hold with strengths times `factor`, and that one fails;
  /// what is not known counts as failing.
  double holds(double factor) const {
    return mean(
        factor, [](double log_holds) { return std::exp(log_holds); }, 0);
  }

  double fails(double factor) const {
    return mean(
        factor, [](double log_holds) { return -std::expm1(log_holds); }, 1);
  }

  /// The probability that all hold with strengths times `factor`, by case.
  std::vector<double> each_holds(double unknown, double factor = 1) const {
    std::vector<double> list;
    for (std::size_t i = 0; i < products_.size(); ++i) {
      list.push_back(states_[i] == CaseState::kFallen ? 0
                     : states_[i] == CaseState::kUnknown
                         ? unknown
                         : mean_over_common(scatter_, [&](double common) {
                             return std::exp(products_[i].log_holds(common * factor));
                           }));
    }
    return list;
  }

  double largest() const {
    double largest = 0;
    for (const Product& product : products_) {
      largest = std::max(largest, product.largest());
    }
    return largest;
  }

 private:
  template <class Each>
  double mean(double factor, const Each& each, double otherwise) const {
    return mean_over_common(scatter_, [&](double common) {
      double sum = 0;
      for (std::size_t i = 0; i < products_.size(); ++i) {
        sum += states_[i] == CaseState::kKnown ? each(products_[i].log_holds(common * factor))
                                               : otherwise;
      }
      return sum / static_cast<double>(products_.size());
    });
  }

  const StrengthScatter& scatter_;
  std::vector<CaseState> states_;
  std::vector<Product> products_;
};

/// The factor with which some connection fails with probability `fails`, by bisection of
/// `fails_with`, which says that probability by the factor; `start` is near it. None if no factor
/// up to kFactorMax suffices, or any does.
template <class FailsWith>
std::optional<double> strength_factor(const FailsWith& fails_with, double start, double fails,
                                      double digits) {
  if (start == 0 || fails_with(kFactorMax) > fails) {
    return std::nullopt;
  }
  double low = start;
  while (fails_with(low) < fails) {
    low /= 2;
    if (low < kFactorMin * start) {
      return std::nullopt;
    }
  }
  double high = 2 * low;
  while (fails_with(high) > fails) {
    low = high;
    high *= 2;
  }
  while (high - low > digits * high) {
    const double middle = 0.5 * (low + high);
    (fails_with(middle) > fails ? low : high) = middle;
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

/// The connections that fail most often, by falling share. Of those that scatter alike the ones
/// with the largest load ratio are looked at, of the first case that is known.
std::vector<FailingConnection> likeliest(std::span<const LoadCase> cases,
                                         const StrengthScatter& scatter, double fails,
                                         std::size_t count_max) {
  std::vector<FailingConnection> list;
  const auto known = std::ranges::find(cases, CaseState::kKnown, &LoadCase::state);
  if (known == cases.end() || fails <= 0) {
    return list;
  }
  std::map<Law, std::vector<std::size_t>> by_law;
  for (std::size_t i = 0; i < known->ratios.size(); ++i) {
    if (known->ratios[i] > kLoadRatioTie) {
      by_law[law_of(scatter, i)].push_back(i);
    }
  }
  for (auto& [law, some] : by_law) {
    std::ranges::stable_sort(some, std::ranges::greater(),
                             [&](std::size_t i) { return known->ratios[i]; });
    some.resize(std::min(some.size(), std::max(count_max, cases.size() > 1 ? kLookedAtMax : 0)));
    const ScatteredFactor own(law.first, law.second);
    for (const std::size_t i : some) {
      const double alone = mean_over_common(scatter, [&](double common) {
        double sum = 0;
        for (const LoadCase& one : cases) {
          sum += one.state == CaseState::kKnown ? own.below(one.ratios[i] / common) : 0;
        }
        return sum / static_cast<double>(cases.size());
      });
      list.push_back(
          {.connection = i, .load_ratio = known->ratios[i], .share = clamped(alone / fails)});
    }
  }
  std::ranges::stable_sort(list, std::ranges::greater(), &FailingConnection::share);
  list.resize(std::min(list.size(), count_max));
  while (list.size() > 1 && list.back().share < kShareMin) {
    list.pop_back();
  }
  return list;
}

/// The mean of probabilities of samples less or plus three times what it may be off. Samples come
/// in pairs that are opposite to each other.
double bound(const std::vector<double>& samples, double direction) {
  const std::size_t count = samples.size() / 2;
  double mean = 0;
  double square = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const double pair = (samples[2 * i] + samples[2 * i + 1]) / 2;
    mean += pair / static_cast<double>(count);
    square += pair * pair / static_cast<double>(count);
  }
  const double variance = std::max(0.0, square - mean * mean);
  return clamped(mean + direction * 3 * std::sqrt(variance / static_cast<double>(count)));
}

/// If none of n samples shows an event, its probability is below this over n, as surely as a mean
/// is within three standard deviations: -log(0.00135).
constexpr double kUnseen = 6.6;
/// Fewer events than these say too little of how often they come.
constexpr double kSeenMin = 10;
/// A load ratio that is farther from its limit, in standard deviations, does not come there.
constexpr double kFarDeviations = 6;

/// Whether masses that scatter as in the samples may bring any load ratio to the other side of
/// `limit`.
bool may_cross_limit(std::span<const LoadCase> cases, double limit = 1) {
  std::vector<double> sum;
  std::vector<double> square;
  double count = 0;
  for (const LoadCase& one : cases) {
    if (one.state == CaseState::kKnown) {
      sum.resize(one.ratios.size());
      square.resize(one.ratios.size());
      for (std::size_t i = 0; i < one.ratios.size(); ++i) {
        sum[i] += one.ratios[i];
        square[i] += one.ratios[i] * one.ratios[i];
      }
      ++count;
    }
  }
  for (std::size_t i = 0; i < sum.size(); ++i) {
    const double mean = sum[i] / count;
    const double deviation = std::sqrt(std::max(0.0, square[i] / count - mean * mean));
    if (std::abs(limit - mean) < kFarDeviations * deviation) {
      return true;
    }
  }
  return false;
}

/// Widens the bounds where samples are too few to show how rarely the robot holds, or does not.
void doubt_rare_events(std::span<const LoadCase> cases, Reliability& found) {
  const auto count = static_cast<double>(cases.size());
  const bool is_rare = std::min(found.fails, found.holds) * count < kSeenMin;
  if (is_rare && may_cross_limit(cases)) {
    found.holds_low = count * found.fails < kSeenMin
                          ? clamped(std::min(found.holds_low, found.holds - kUnseen / count))
                          : found.holds_low;
    found.holds_high = count * found.holds < kSeenMin
                           ? clamped(std::max(found.holds_high, found.holds + kUnseen / count))
                           : found.holds_high;
  }
}

/// The other end of the interval in which a probability lies, surely but for 2.5 %, if the mean of
/// `count` independent numbers from 0 to 1 of which it is the expectation is `mean`: the one with
/// count KL(mean, p) = log 40 [Hoeffding 1963, Theorem 1], which for events that are never seen is
/// that of the binomial distribution [Clopper 1934]. `direction`: 1 for the upper end, -1 for the
/// lower one.
double chance_bound(double mean, double count, double direction) {
  const double allowed = std::log(40.0) / count;
  const auto divergence = [mean](double p) {
    const double of_event = mean > 0 ? mean * std::log(mean / p) : 0;
    return of_event + (mean < 1 ? (1 - mean) * std::log((1 - mean) / (1 - p)) : 0);
  };
  double inner = mean;
  double outer = direction > 0 ? 1 : 0;
  for (int i = 0; i < kChanceBisections; ++i) {
    const double middle = 0.5 * (inner + outer);
    (divergence(middle) < allowed ? inner : outer) = middle;
  }
  return outer;
}

/// Bounds of the factors with which the robot fails with a probability, from samples.
class FactorBounds {
 public:
  FactorBounds(std::span<const LoadCase> cases, const Cases& all, bool is_linear)
      : cases_(cases), all_(all), is_linear_(is_linear) {}

  FactorRange range(double fails) const {
    const auto bound_with = [&](double direction) {
      return strength_factor([&](double factor) { return fails_with(factor, direction); },
                             all_.largest(), fails, kBoundDigits);
    };
    return {.low = bound_with(-1), .high = bound_with(1)};
  }

 private:
  /// A bound of the probability that the robot fails. Where loads are linear in masses and none
  /// comes near its limit, what samples say varies little, and their mean is normal; else it may be
  /// any number from 0 to 1, and only how many there are counts. Of opposite samples both may fail,
  /// so pairs are what is independent.
  double fails_with(double factor, double direction) const {
    const std::vector<double> holds = all_.each_holds(direction > 0 ? 0 : 1, factor);
    const double sure = 1 - bound(holds, -direction);
    if (is_linear_ && !may_cross_limit(cases_, factor)) {
      return sure;
    }
    double mean = 0;
    for (const double one : holds) {
      mean += (1 - one) / static_cast<double>(holds.size());
    }
    return chance_bound(clamped(mean), static_cast<double>(holds.size()) / 2, direction);
  }

  std::span<const LoadCase> cases_;
  const Cases& all_;
  bool is_linear_;
};

}  // namespace

Reliability find_reliability(std::span<const LoadCase> cases, const StrengthScatter& scatter,
                             std::size_t likeliest_max, bool is_linear) {
  const Cases all(cases, scatter);
  Reliability found{.scatter = scatter};
  found.fails = clamped(all.fails(1));
  found.holds = clamped(all.holds(1));
  found.holds_low = found.holds;
  found.holds_high = found.holds;
  if (cases.size() > 1) {
    found.holds_low = std::min(found.holds, bound(all.each_holds(0), -1));
    found.holds_high = std::max(found.holds, bound(all.each_holds(1), 1));
    doubt_rare_events(cases, found);
  }
  found.likeliest = likeliest(cases, scatter, found.fails, likeliest_max);
  const auto fails_with = [&](double factor) { return all.fails(factor); };
  const auto factor_of = [&](double fails) {
    return strength_factor(fails_with, all.largest(), fails, kFactorDigits);
  };
  found.strength_factor_99 = factor_of(0.01);
  found.strength_factor_999 = factor_of(0.001);
  found.factor_range_99 = {.low = found.strength_factor_99, .high = found.strength_factor_99};
  found.factor_range_999 = {.low = found.strength_factor_999, .high = found.strength_factor_999};
  if (cases.size() > 1) {
    const FactorBounds bounds(cases, all, is_linear);
    found.factor_range_99 = bounds.range(0.01);
    found.factor_range_999 = bounds.range(0.001);
  }
  return found;
}

Reliability find_reliability(std::span<const double> load_ratios, const StrengthScatter& scatter) {
  const LoadCase one{.ratios = {load_ratios.begin(), load_ratios.end()}};
  return find_reliability(std::span(&one, 1), scatter);
}

std::optional<std::vector<double>> known_ratios(const Assessment& assessment) {
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
  return ratios;
}

std::optional<Reliability> find_reliability(const Assessment& assessment,
                                            const StrengthScatter& scatter,
                                            const SampledMasses& sampled,
                                            std::size_t likeliest_max) {
  auto ratios = known_ratios(assessment);
  if (!ratios) {
    return std::nullopt;
  }
  const LoadCase one{.ratios = *std::move(ratios)};
  const auto cases =
      sampled.cases.empty() ? std::span(&one, 1) : std::span<const LoadCase>(sampled.cases);
  Reliability found = find_reliability(cases, scatter, likeliest_max, sampled.changed_count == 0);
  found.sample_count = sampled.cases.size();
  found.changed_count = sampled.changed_count;
  if (assessment.load_ratio_max) {
    const LoadRange range = whole_range(assessment);
    if (!std::isfinite(range.low) || !std::isfinite(range.high)) {
      return std::nullopt;
    }
    const double base = clamped(1 - Cases(std::span(&one, 1), scatter).fails(1));
    const auto change_with = [&](double more) {
      return clamped(1 - Cases(std::span(&one, 1), scatter, more).fails(1)) - base;
    };
    found.holds_low = clamped(found.holds_low +
                              std::min(0.0, change_with(range.high - *assessment.load_ratio_max)));
    found.holds_high = clamped(found.holds_high +
                               std::max(0.0, change_with(range.low - *assessment.load_ratio_max)));
  }
  return found;
}

Verdict judge_probability(const std::optional<Reliability>& sure, double asked) {
  if (asked <= 0) {
    return Verdict::kSafe;
  }
  if (!sure) {
    return Verdict::kUndecided;
  }
  if (sure->holds_high < asked) {
    return Verdict::kOverload;
  }
  return sure->holds_low < asked ? Verdict::kUndecided : Verdict::kSafe;
}

}  // namespace holdfast::verdict
