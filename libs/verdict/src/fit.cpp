// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "holdfast/verdict/fit.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <numeric>

#include "simplex_search.hpp"

namespace holdfast::verdict {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// Fitted cvs lie between these; below the first strengths are as good as equal.
constexpr double kFitCvMin = 0.003;
constexpr double kFitCvMax = 1;

/// Strengths are sought up to this factor beyond the smallest and the largest load.
constexpr double kReach = 1e3;

/// What is sought: the logarithms of the strengths by class, then that of the cv.
using Point = std::vector<double>;

/// Connections with their common distribution and their strengths.
struct Strengths {
  ScatteredFactor own;
  std::span<const double> log_strengths;

  double relative(const TestedConnection& one) const {
    return one.load_n / std::exp(log_strengths[one.strength_class]);
  }

  double log_hold(const TestedConnection& one) const {
    return one.load_n > 0 ? own.log_above(relative(one)) : 0;
  }

  double log_break(const TestedConnection& one) const {
    return one.load_n > 0 ? std::log(own.below(relative(one))) : -kInfinity;
  }

  double log_all_hold(std::span<const TestedConnection> connections) const {
    double sum = 0;
    for (const TestedConnection& one : connections) {
      sum += log_hold(one);
    }
    return sum;
  }

  /// The logarithm of the density of breaking at a load, per logarithm of the load: the slope of
  /// the logarithm of the probability of holding, times that probability.
  double log_density(const TestedConnection& one) const {
    constexpr double kStep = 1e-4;
    const double value = relative(one);
    const double slope =
        (own.log_above(value * (1 - kStep)) - own.log_above(value * (1 + kStep))) / (2 * kStep);
    return std::log(slope) + own.log_above(value);
  }
};

double log_likelihood(const Experiment& experiment, const Strengths& strengths) {
  using enum Experiment::Outcome;
  const double held = strengths.log_all_hold(experiment.connections);
  switch (experiment.outcome) {
    case kHeld:
      return held;
    case kBroke:
      return std::log(-std::expm1(held));
    case kBrokeThere: {
      double sum = held;
      for (const std::size_t i : experiment.broken) {
        const TestedConnection& one = experiment.connections[i];
        sum += strengths.log_break(one) - strengths.log_hold(one);
      }
      return sum;
    }
    case kHeldThenBroke:
      return held + std::log(-std::expm1(strengths.log_all_hold(experiment.more) - held));
    case kPulled:
      break;
  }
  return strengths.log_density(experiment.connections.front());
}

/// Whether an outcome is possible whatever the strengths.
bool is_possible(const Experiment& experiment) {
  using enum Experiment::Outcome;
  const auto is_pulled = [](const TestedConnection& one) { return one.load_n > 0; };
  switch (experiment.outcome) {
    case kHeld:
      return true;
    case kBroke:
      return std::ranges::any_of(experiment.connections, is_pulled);
    case kBrokeThere:
      return !experiment.broken.empty() &&
             std::ranges::all_of(experiment.broken, [&](std::size_t i) {
               return is_pulled(experiment.connections[i]);
             });
    case kHeldThenBroke: {
      for (std::size_t i = 0; i < experiment.more.size(); ++i) {
        const double before =
            i < experiment.connections.size() ? experiment.connections[i].load_n : 0;
        if (experiment.more[i].load_n > std::max(0.0, before)) {
          return true;
        }
      }
      return false;
    }
    case kPulled:
      break;
  }
  return is_pulled(experiment.connections.front());
}

/// The likelihood of all experiments as a function of a point.
class Likelihood {
 public:
  Likelihood(std::span<const Experiment> experiments, std::size_t class_count,
             const FitOptions& options)
      : options_(options), class_count_(class_count), has_(class_count), broke_(class_count) {
    for (const Experiment& one : experiments) {
      if (is_possible(one)) {
        experiments_.push_back(&one);
        look_at(one);
      }
    }
  }

  double at(const Point& point) const {
    for (std::size_t c = 0; c < class_count_; ++c) {
      if (!(point[c] > log_low() && point[c] < log_high())) {
        return -kInfinity;
      }
    }
    const double cv = cv_of(point);
    if (!(cv >= kFitCvMin * (1 - 1e-12) && cv <= kFitCvMax * (1 + 1e-12)) && !options_.cv) {
      return -kInfinity;
    }
    const Strengths strengths = strengths_at(point);
    double sum = 0;
    for (const Experiment* one : experiments_) {
      sum += log_likelihood(*one, strengths);
    }
    return std::isnan(sum) ? -kInfinity : sum;
  }

  Strengths strengths_at(const Point& point) const {
    return {ScatteredFactor(options_.distribution, cv_of(point)),
            std::span(point).first(class_count_)};
  }

  double cv_of(const Point& point) const {
    return options_.cv ? *options_.cv : std::exp(point[class_count_]);
  }

  std::size_t size() const { return class_count_ + (options_.cv ? 0 : 1); }

  bool has(std::size_t strength_class) const { return has_[strength_class]; }

  double log_low() const { return std::log(load_min_ / kReach); }

  double log_high() const { return std::log(load_max_ * kReach); }

  bool is_empty() const { return load_max_ == 0; }

  /// Points to begin with: the middle of all loads, scattering little and much.
  std::vector<Point> starts() const {
    std::vector<Point> list;
    for (const double cv : {0.05, 0.2, 0.7}) {
      for (const double share : {0.5, 1.0, 1.5}) {
        Point point(size(), std::log(share * std::sqrt(load_min_ * load_max_)));
        for (std::size_t c = 0; c < class_count_; ++c) {
          point[c] = broke_[c] > 0 ? std::log(share * broke_[c]) : std::log(share * load_max_);
        }
        if (!options_.cv) {
          point.back() = std::log(cv);
        }
        list.push_back(std::move(point));
      }
    }
    return list;
  }

 private:
  void look_at(const Experiment& experiment) {
    const auto add = [&](const TestedConnection& one) {
      if (one.load_n > 0) {
        has_[one.strength_class] = true;
        load_min_ = std::min(load_min_, one.load_n);
        load_max_ = std::max(load_max_, one.load_n);
      }
    };
    std::ranges::for_each(experiment.connections, add);
    std::ranges::for_each(experiment.more, add);
    if (experiment.outcome != Experiment::Outcome::kHeld) {
      for (const TestedConnection& one : experiment.connections) {
        broke_[one.strength_class] = std::max(broke_[one.strength_class], one.load_n);
      }
    }
  }

  const FitOptions& options_;
  std::size_t class_count_;
  std::vector<const Experiment*> experiments_;
  std::vector<bool> has_;
  std::vector<double> broke_;  ///< The largest load in an experiment that broke, by class.
  double load_min_ = kInfinity;
  double load_max_ = 0;
};

/// The best point with some numbers of it fixed.
struct Best {
  Point point;
  double log_likelihood = -kInfinity;
};

/// Climbs from each start; `fixed` numbers, by index, stay as they are.
Best climb(const Likelihood& likelihood, std::span<const Point> starts,
           const std::vector<bool>& fixed) {
  Best best;
  for (const Point& start : starts) {
    std::vector<std::size_t> free;
    for (std::size_t i = 0; i < start.size(); ++i) {
      if (!fixed[i]) {
        free.push_back(i);
      }
    }
    const auto value_at = [&](std::span<const double> numbers) {
      Point point = start;
      for (std::size_t k = 0; k < free.size(); ++k) {
        point[free[k]] = numbers[k];
      }
      return -likelihood.at(point);
    };
    std::vector<double> numbers;
    for (const std::size_t i : free) {
      numbers.push_back(start[i]);
    }
    const double found = -minimise(value_at, numbers);
    if (found > best.log_likelihood) {
      best.log_likelihood = found;
      best.point = start;
      for (std::size_t k = 0; k < free.size(); ++k) {
        best.point[free[k]] = numbers[k];
      }
    }
  }
  return best;
}

/// The interval of one number by the profile of the likelihood.
class Profile {
 public:
  Profile(const Likelihood& likelihood, const Best& best, std::vector<bool> fixed,
          std::size_t index)
      : likelihood_(likelihood), best_(best), fixed_(std::move(fixed)), index_(index) {
    fixed_[index] = true;
  }

  /// The end of the interval towards `limit`; none if the likelihood does not fall so far.
  std::optional<double> end(double limit) {
    const double sign = limit > best_.point[index_] ? 1 : -1;
    Point from = best_.point;
    double inside = best_.point[index_];
    double step = 0.01;
    double outside = inside;
    while (true) {
      outside = inside + sign * step;
      if (sign * (outside - limit) >= 0) {
        return std::nullopt;
      }
      if (drop_at(outside, from) > kIntervalDrop) {
        break;
      }
      inside = outside;
      step *= 1.6;
    }
    for (int i = 0; i < kHalvings; ++i) {
      const double middle = 0.5 * (inside + outside);
      (drop_at(middle, from) > kIntervalDrop ? outside : inside) = middle;
    }
    return 0.5 * (inside + outside);
  }

  /// How much less likely ascending values are than the best, by value; all are logarithms.
  std::vector<double> drops(std::span<const double> values) const {
    std::vector<double> found(values.size());
    const auto above = static_cast<std::size_t>(
        std::lower_bound(values.begin(), values.end(), best_.point[index_]) - values.begin());
    Point from = best_.point;
    for (std::size_t i = above; i < values.size(); ++i) {
      found[i] = drop_at(values[i], from);
    }
    from = best_.point;
    for (std::size_t i = above; i-- > 0;) {
      found[i] = drop_at(values[i], from);
    }
    return found;
  }

 private:
  /// The number of times that a step of some tenths of a logarithm is halved: 1e-6 of it remain.
  static constexpr int kHalvings = 18;

  /// Goes on from the last point; where that has no likelihood left, from one that scatters much.
  double drop_at(double value, Point& from) const {
    std::vector<Point> start = {from};
    start[0][index_] = value;
    Best found = climb(likelihood_, start, fixed_);
    if (found.log_likelihood == -kInfinity && !fixed_.back()) {
      start[0].back() = std::log(0.5);
      found = climb(likelihood_, start, fixed_);
    }
    if (found.log_likelihood > -kInfinity) {
      from = std::move(found.point);
    }
    return best_.log_likelihood - found.log_likelihood;
  }

  const Likelihood& likelihood_;
  const Best& best_;
  std::vector<bool> fixed_;
  std::size_t index_;
};

/// Numbers that stay as they are: strengths of classes that nothing tells of.
std::vector<bool> fixed_numbers(const Likelihood& likelihood, std::size_t class_count) {
  std::vector<bool> fixed(likelihood.size(), false);
  for (std::size_t c = 0; c < class_count; ++c) {
    fixed[c] = !likelihood.has(c);
  }
  return fixed;
}

/// Whether the likelihood is still as large at the end of what is looked at.
bool is_open(const Likelihood& likelihood, const Best& best, std::vector<bool> fixed,
             std::size_t index, double limit) {
  Point end = best.point;
  end[index] = limit;
  fixed[index] = true;
  std::vector<Point> starts = {end};
  if (!fixed.back()) {
    end.back() = std::log(0.1);
    starts.push_back(end);
  }
  return climb(likelihood, starts, fixed).log_likelihood > best.log_likelihood - 1e-3;
}

FittedNumber strength_of(const Likelihood& likelihood, const Best& best,
                         const std::vector<bool>& fixed, std::size_t index) {
  FittedNumber number;
  const double low = likelihood.log_low() + 1e-6;
  const double high = likelihood.log_high() - 1e-6;
  Profile profile(likelihood, best, fixed, index);
  const auto from_log = [](const std::optional<double>& log) {
    return log ? std::optional(std::exp(*log)) : std::nullopt;
  };
  number.low = from_log(profile.end(low));
  number.high = from_log(profile.end(high));
  const bool is_one_sided = is_open(likelihood, best, fixed, index, low + 1e-6) ||
                            is_open(likelihood, best, fixed, index, high - 1e-6);
  number.value = is_one_sided ? std::nullopt : std::optional(std::exp(best.point[index]));
  return number;
}

void take_probabilities(std::span<const Experiment> experiments, const Strengths& strengths,
                        FitResult& result) {
  using enum Experiment::Outcome;
  for (const Experiment& one : experiments) {
    result.place_probabilities.emplace_back();
    if (!is_possible(one)) {
      result.probabilities.push_back(0);
    } else if (one.outcome == kPulled) {
      const double below = strengths.own.below(strengths.relative(one.connections.front()));
      result.probabilities.push_back(2 * std::min(below, 1 - below));
    } else if (one.outcome == kHeldThenBroke) {
      // That it holds the first and breaks by the second at all: an early and a late end.
      const double held = std::exp(strengths.log_all_hold(one.connections));
      const double broke = -std::expm1(strengths.log_all_hold(one.more));
      result.probabilities.push_back(std::min(1.0, 2 * std::min(held, broke)));
    } else {
      const double broke = -std::expm1(strengths.log_all_hold(one.connections));
      result.probabilities.push_back(one.outcome == kHeld ? 1 - broke : broke);
      if (one.outcome == kBrokeThere && broke > 0) {
        result.place_probabilities.back() =
            std::min(1.0, std::exp(log_likelihood(one, strengths)) / broke);
      }
    }
  }
}

/// The point that a fit has found.
Point point_of(const FitResult& fit, const FitOptions& options) {
  Point point;
  for (const FittedNumber& one : fit.strengths_n) {
    point.push_back(std::log(one.value.value_or(1)));
  }
  if (!options.cv) {
    const double cv = fit.cv.value.value_or(0.1);
    point.push_back(std::log(cv < 1.5 * kFitCvMin ? 0.1 : cv));
  }
  return point;
}

/// The logarithm of the determinant of a positive matrix by rows; none if it is not positive.
std::optional<double> log_determinant(std::vector<double> a, std::size_t n) {
  double sum = 0;
  for (std::size_t k = 0; k < n; ++k) {
    const double pivot = a[k * n + k];
    if (!(pivot > 0)) {
      return std::nullopt;
    }
    sum += std::log(pivot);
    for (std::size_t i = k + 1; i < n; ++i) {
      const double factor = a[i * n + k] / pivot;
      for (std::size_t j = k; j < n; ++j) {
        a[i * n + j] -= factor * a[k * n + j];
      }
    }
  }
  return sum;
}

/// Fisher's information of whether an experiment holds: g g^T / (p (1 - p)), g the slopes of the
/// probability p.
std::vector<double> information_of(std::span<const TestedConnection> connections,
                                   const Likelihood& likelihood, const Point& point) {
  const std::size_t n = point.size();
  constexpr double kStep = 1e-4;
  const auto holds = [&](const Point& at) {
    return std::exp(likelihood.strengths_at(at).log_all_hold(connections));
  };
  std::vector<double> slopes;
  for (std::size_t i = 0; i < n; ++i) {
    Point up = point;
    Point down = point;
    up[i] += kStep;
    down[i] -= kStep;
    slopes.push_back((holds(up) - holds(down)) / (2 * kStep));
  }
  const double p = holds(point);
  std::vector<double> information(n * n, 0);
  const double variance = p * (1 - p);
  for (std::size_t i = 0; i < n * n && variance > 1e-12; ++i) {
    information[i] = slopes[i / n] * slopes[i % n] / variance;
  }
  return information;
}

/// What experiments have told: minus the second slopes of the logarithm of the likelihood, and a
/// little that is known of every number beforehand, within a factor of e or so.
std::vector<double> information_so_far(const Likelihood& likelihood, const Point& point) {
  const std::size_t n = point.size();
  constexpr double kStep = 1e-3;
  const auto at = [&](std::size_t i, double a, std::size_t j, double b) {
    Point moved = point;
    moved[i] += a * kStep;
    moved[j] += b * kStep;
    return likelihood.at(moved);
  };
  std::vector<double> information(n * n);
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t j = 0; j < n; ++j) {
      const double slope = (at(i, 1, j, 1) - at(i, 1, j, -1) - at(i, -1, j, 1) + at(i, -1, j, -1)) /
                           (4 * kStep * kStep);
      information[i * n + j] = (i == j ? 1 : 0) - (std::isfinite(slope) ? slope : 0);
    }
  }
  return information;
}

}  // namespace

FitResult fit_strengths(std::span<const Experiment> experiments, std::size_t class_count,
                        const FitOptions& options) {
  const Likelihood likelihood(experiments, class_count, options);
  FitResult result;
  result.strengths_n.resize(class_count);
  if (options.cv) {
    result.cv.value = options.cv;
  }
  if (likelihood.is_empty()) {
    result.probabilities.assign(experiments.size(), 0);
    std::ranges::transform(experiments, result.probabilities.begin(),
                           [](const Experiment& one) { return is_possible(one) ? 1.0 : 0.0; });
    result.place_probabilities.resize(experiments.size());
    return result;
  }
  const std::vector<bool> fixed = fixed_numbers(likelihood, class_count);
  const Best best = climb(likelihood, likelihood.starts(), fixed);
  result.log_likelihood = best.log_likelihood;
  bool is_any_known = false;
  for (std::size_t c = 0; c < class_count; ++c) {
    if (!fixed[c]) {
      result.strengths_n[c] = strength_of(likelihood, best, fixed, c);
      is_any_known = is_any_known || result.strengths_n[c].value;
    }
  }
  if (!options.cv) {
    Profile profile(likelihood, best, fixed, class_count);
    const auto from_log = [](const std::optional<double>& log) {
      return log ? std::optional(std::exp(*log)) : std::nullopt;
    };
    result.cv.low = from_log(profile.end(std::log(kFitCvMin)));
    result.cv.high = from_log(profile.end(std::log(kFitCvMax)));
    result.cv.value = is_any_known ? std::optional(likelihood.cv_of(best.point)) : std::nullopt;
  }
  take_probabilities(experiments, likelihood.strengths_at(best.point), result);
  return result;
}

std::vector<ProfilePoint> strength_profile(std::span<const Experiment> experiments,
                                           std::size_t class_count, const FitOptions& options,
                                           std::size_t strength_class,
                                           std::span<const double> values) {
  const Likelihood likelihood(experiments, class_count, options);
  if (likelihood.is_empty() || !likelihood.has(strength_class)) {
    return {};
  }
  const std::vector<bool> fixed = fixed_numbers(likelihood, class_count);
  const Best best = climb(likelihood, likelihood.starts(), fixed);
  std::vector<double> logs;
  for (const double value : values) {
    logs.push_back(std::log(value));
  }
  const std::vector<double> drops = Profile(likelihood, best, fixed, strength_class).drops(logs);
  std::vector<ProfilePoint> points;
  for (std::size_t i = 0; i < values.size(); ++i) {
    points.push_back({.value = values[i], .log_likelihood = -drops[i]});
  }
  return points;
}

std::optional<double> information_gain(std::span<const Experiment> experiments,
                                       const FitResult& fit, const FitOptions& options,
                                       std::span<const TestedConnection> next) {
  const auto is_missing = [](const FittedNumber& one) { return !one.value; };
  if (std::ranges::any_of(fit.strengths_n, is_missing) || is_missing(fit.cv)) {
    return std::nullopt;
  }
  const Likelihood likelihood(experiments, fit.strengths_n.size(), options);
  const Point point = point_of(fit, options);
  const std::size_t n = point.size();
  const std::vector<double> before = information_so_far(likelihood, point);
  std::vector<double> after = before;
  const auto information = information_of(next, likelihood, point);
  std::transform(after.begin(), after.end(), information.begin(), after.begin(), std::plus<>());
  const auto first = log_determinant(before, n);
  const auto second = log_determinant(after, n);
  return first && second ? std::optional(*second - *first) : std::nullopt;
}

double probability_of_holding(std::span<const TestedConnection> connections, const FitResult& fit,
                              const FitOptions& options) {
  const Point point = point_of(fit, options);
  const double cv = options.cv ? *options.cv : std::exp(point.back());
  const Strengths strengths{ScatteredFactor(options.distribution, cv),
                            std::span(point).first(fit.strengths_n.size())};
  return std::exp(strengths.log_all_hold(connections));
}

}  // namespace holdfast::verdict
