// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "several_solutions.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "connection_assessment.hpp"
#include "holdfast/verdict/connection_law.hpp"
#include "stability.hpp"

namespace holdfast::verdict {
namespace {

using Displacements = std::vector<base::Vec6<double>>;

}  // namespace

double load_ratio_max(const model::Robot& robot, const Displacements& u, const Displacements& low) {
  const ConnectionLaws laws(robot);
  double largest = -std::numeric_limits<double>::infinity();
  for (const model::Connection& pair : robot.connections()) {
    const double ratio = laws.load_ratio(pair, u, low);
    largest = ratio > largest || std::isnan(ratio) ? ratio : largest;
    if (std::isnan(largest)) {
      break;
    }
  }
  const bool is_any_nan = host::any(robot.ranks(), std::isnan(largest));
  return is_any_nan ? std::numeric_limits<double>::quiet_NaN() : host::max(robot.ranks(), largest);
}

namespace {

void widen(LoadRange& range, double ratio) {
  range.low = ratio < range.low || std::isnan(ratio) ? ratio : range.low;
  range.high = ratio > range.high || std::isnan(ratio) ? ratio : range.high;
}

/// Takes in what a solution and its alternative say. Beside 106 bits the alternative says something
/// only if feet are ambiguous.
void widen(LoadRange& range, const model::Robot& robot, const solver::Solution& solution,
           bool is_ambiguous = false) {
  widen(range, load_ratio_max(robot, solution.displacement, solution.displacement_low));
  if (solution.displacement_low.empty() || is_ambiguous) {
    widen(range, load_ratio_max(robot, solution.alternative, {}));
  }
}

constexpr LoadRange kEmpty = {.low = std::numeric_limits<double>::infinity(),
                              .high = -std::numeric_limits<double>::infinity()};

/// Whether a range, widened by an error, is on one side of 1; not if it is not a number.
bool is_on_side(const LoadRange& range, double error, bool is_broken) {
  const double low = range.low - error;
  const double high = range.high + error;
  return is_broken ? breaks(low) && breaks(high)
                   : low < 1 - kLoadRatioTie && high < 1 - kLoadRatioTie;
}

}  // namespace

void compare_solutions(const Situation& here, solver::EquilibriumSolver& solver, double gamma,
                       const solver::EquilibriumOptions& options, const LoadRange& answers,
                       Assessment& assessment) {
  const model::Robot& robot = here.robot;
  solver::Equilibrium& settled = assessment.equilibrium;
  SeveralSolutions& several = assessment.several.emplace();
  several.found_count = settled.others.size() + 1;
  several.regularised = answers;
  for (const solver::Solution& other : settled.others) {
    widen(several.regularised, robot, other);
  }
  const solver::Equilibrium exact =
      solver.solve({.law = mechanics::ContactLaw::kUnilateral, .gamma = gamma});
  settled.steps += exact.steps;
  settled.iteration_count += exact.iteration_count;
  const bool is_held_by_contact = here.rule == StabilityRule::kContactForces;
  const auto does_fall = [&](const solver::Solution& one) {
    return is_held_by_contact && !do_states_hold(here, one.contact);
  };
  assessment.model.falls_otherwise = std::ranges::any_of(settled.others, does_fall);
  if (exact.outcome == solver::Outcome::kSettled) {
    assessment.model.falls_otherwise |= does_fall(exact);
    assessment.model.slip_otherwise = find_slip(robot, exact);
    widen(several.unilateral.emplace(kEmpty), robot, exact, exact.open_but_held_count > 0);
  }
  const bool is_multigrid =
      settled.method == solver::Method::kMultigrid || exact.method == solver::Method::kMultigrid;
  const double share = is_multigrid ? multigrid_error(robot, options) : kRounding;
  const double scale = std::max(1.0, several.regularised.high);
  several.error = share * scale + weak_spring_error(robot, exact, scale);
}

bool do_agree(const SeveralSolutions& several, bool is_broken) {
  return is_on_side(several.regularised, several.error, is_broken) && several.unilateral &&
         is_on_side(*several.unilateral, several.error, is_broken);
}

Reason reason_of(ReasonCode code, const SeveralSolutions& several) {
  const LoadRange unilateral = several.unilateral.value_or(kEmpty);
  return {.code = code,
          .numbers = {static_cast<double>(several.found_count), several.regularised.low,
                      several.regularised.high, unilateral.low, unilateral.high}};
}

}  // namespace holdfast::verdict
