// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
//
// How far a robot's own answer can be trusted, and why it is not the exact one where it is not.
#include <algorithm>
#include <cmath>

#include "distributed/distributed_parts.hpp"

namespace holdfast {
namespace {

/// Whether forces follow from balance alone: as many connections and touching facets as modules
/// that can move, as each of them is held. Those between fixed modules carry nothing.
bool is_determinate(const model::Robot& robot) {
  const auto is_fixed = [&](std::int32_t module) {
    return robot.modules()[static_cast<std::size_t>(module)].support == model::Support::kFixed;
  };
  const auto carrying = std::ranges::count_if(
      robot.connections(), [&](const auto& one) { return !(is_fixed(one.a) && is_fixed(one.b)); });
  return static_cast<std::size_t>(carrying) + robot.facets().size() == robot.free_count();
}

/// Whether the load ratios of the exact answer and the robot differ by more than is promised under
/// one law (docs/distributed.md).
bool is_far(const verdict::Assessment& exact, const agent::Answer& answer) {
  const auto ratio = load_ratio_max(answer);
  return ratio && exact.load_ratio_max &&
         std::abs(*ratio - *exact.load_ratio_max) > 0.01 + 0.01 * std::abs(*exact.load_ratio_max);
}

Difference difference(const verdict::Assessment& exact, bool has_lost_modules,
                      const DistributedRun& run) {
  using verdict::Verdict;
  const bool is_other_law = has_other_law(exact, run.result);
  const bool is_far_away = exact.is_stable && is_far(exact, run.result.answer);
  if (run.view.verdict == exact.verdict && !is_other_law && !is_far_away) {
    return Difference::kNone;
  }
  if (has_lost_modules) {
    return Difference::kModules;
  }
  if (exact.verdict != run.view.verdict &&
      (run.view.verdict == Verdict::kUndecided || exact.verdict == Verdict::kUndecided)) {
    return exact.verdict == Verdict::kUndecided ? Difference::kExactUndecided
                                                : Difference::kRobotUndecided;
  }
  if (is_other_law) {
    return Difference::kContactLaw;
  }
  if (exact.several) {
    return Difference::kOtherSolutions;
  }
  const bool falls = exact.verdict == Verdict::kUnstable || run.view.verdict == Verdict::kUnstable;
  return falls && exact.stability_rule == verdict::StabilityRule::kContactForces
             ? Difference::kUnstableByModel
             : Difference::kUnexplained;
}

}  // namespace

/// A robot that finds no state under the regularised law answers by the unilateral one, also where
/// the exact solver, which starts from other states, has found one.
bool has_other_law(const verdict::Assessment& exact, const sim::SimulationResult& result) {
  const bool has_law = exact.contact_model == verdict::ContactModel::kRegularised ||
                       exact.contact_model == verdict::ContactModel::kUnilateral;
  const bool is_unilateral = exact.contact_model == verdict::ContactModel::kUnilateral;
  const bool has_ratio = result.answer.verdict == agent::Verdict::kSafe ||
                         result.answer.verdict == agent::Verdict::kOverload;
  return has_law && has_ratio && result.effort.solves > 0 &&
         result.effort.is_unilateral != is_unilateral;
}

void note_difference(const model::Robot& robot, const verdict::Assessment& exact,
                     bool has_lost_modules, DistributedRun& run) {
  // The polynomial's is the less of a bound and of what the energy of the error is estimated as.
  const bool is_bound =
      is_determinate(robot) && run.result.effort.method != agent::Method::kPolynomial;
  run.error_kind = is_bound ? ErrorKind::kBound : ErrorKind::kEstimate;
  run.difference = difference(exact, has_lost_modules, run);
}

const char* name(ErrorKind kind) { return kind == ErrorKind::kBound ? "bound" : "estimate"; }

const char* name(Difference difference) {
  switch (difference) {
    case Difference::kModules:
      return "modules";
    case Difference::kRobotUndecided:
      return "robot_undecided";
    case Difference::kExactUndecided:
      return "exact_undecided";
    case Difference::kContactLaw:
      return "contact_law";
    case Difference::kOtherSolutions:
      return "other_solutions";
    case Difference::kUnstableByModel:
      return "unstable_by_model";
    case Difference::kUnexplained:
      return "unexplained";
    case Difference::kNone:
      break;
  }
  return "none";
}

}  // namespace holdfast
