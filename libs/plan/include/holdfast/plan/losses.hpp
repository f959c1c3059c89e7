// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <limits>
#include <optional>
#include <vector>

#include "holdfast/model/robot.hpp"
#include "holdfast/plan/cascade.hpp"
#include "holdfast/plan/judgement.hpp"
#include "holdfast/plan/loss.hpp"
#include "holdfast/solver/options.hpp"

/// Does a robot hold whatever single part of it is lost: a connection, a module, a foot?
namespace holdfast::plan {

/// The end of the cascade that a loss sets off, in numbers.
struct Aftermath {
  CascadeOutcome outcome = CascadeOutcome::kUndecided;
  std::size_t round_count = 0;  ///< Falling at once is the first.
  std::size_t broken_count = 0;
  std::size_t fallen_count = 0;
};

/// What follows from a loss: brittle, at once, and with nothing else lost before. Parts that the
/// loss leaves by themselves are judged by themselves.
struct LossAnswer {
  Loss loss;
  /// The worst of all parts; `unstable` if one of them is held by nothing.
  verdict::Verdict verdict = verdict::Verdict::kUndecided;
  /// The largest load ratio of what is held; none where no load is known.
  std::optional<double> load_ratio_max = {};
  bool is_bound = false;         ///< That is no less than the largest load ratio.
  std::size_t fallen_count = 0;  ///< Modules that nothing holds any more.

  /// What follows, if that is wanted, it is fatal, and there was time.
  std::optional<Aftermath> after = {};

  bool is_fatal() const {
    return verdict == verdict::Verdict::kOverload || verdict == verdict::Verdict::kUnstable;
  }
};

struct LossOptions {
  solver::EquilibriumOptions equilibrium = {};
  std::array<bool, kLossKindCount> kinds = {true, true, true};  ///< Those that are tried.
  /// Losses that are not judged by then are undecided.
  double seconds_max = std::numeric_limits<double>::infinity();
  /// Robots of so many modules are first looked at by bounds that need no factorization.
  std::size_t loop_count_min = 3000;
  /// Judges by equilibria in the deformed shape, each loss by a check.
  bool is_deformed = false;
  bool is_cascade_wanted = false;  ///< Finds what follows each fatal loss.
  bool is_by_checks = false;  ///< Judges every loss by a check of what is left: to compare with.
  /// Called now and then with how many losses are judged, of how many.
  std::function<void(std::size_t done, std::size_t count)> progress = {};
};

/// What follows from the loss of each part of a robot.
struct LossReport {
  Judgement whole;             ///< Of the robot as it is; if it is not safe, no loss is tried.
  std::size_t loss_count = 0;  ///< There are so many.
  std::vector<LossAnswer> answers = {};    ///< Each, in the order of its parts; none if not tried.
  std::vector<LossAnswer> fatal = {};      ///< Those that bring it down, in the order of its parts.
  std::vector<LossAnswer> undecided = {};  ///< Neither safe nor known to be fatal.
  /// The loss with the largest load ratio of those after which all is held; bounds count only where
  /// nothing else is known.
  std::optional<LossAnswer> worst = {};
  std::size_t bound_count = 0;  ///< So many are safe by a bound,
  std::size_t check_count = 0;  ///< and so many took a check.
  double seconds = 0;

  /// Whether it is safe whatever is lost.
  bool holds_all() const { return whole.is_safe() && fatal.empty() && undecided.empty(); }
};

/// Judges the loss of each part of a robot that model::Robot::create() accepts, as a check of what
/// is left would: connections first, then modules, then feet, each in the robot's order.
LossReport lose_each(const model::RobotSpec& spec, const LossOptions& options = {});

}  // namespace holdfast::plan
