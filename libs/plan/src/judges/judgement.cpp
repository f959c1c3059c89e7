// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "holdfast/plan/judgement.hpp"

#include <algorithm>
#include <utility>

#include "holdfast/verdict/deformed.hpp"
#include "judges/stage_judge.hpp"

namespace holdfast::plan {

using verdict::ReasonCode;

solver::EquilibriumOptions as_checked(const model::Robot& robot,
                                      solver::EquilibriumOptions options) {
  options.second_order = robot.is_modulus_stated() ? solver::SecondOrderWish::kCheck
                                                   : solver::SecondOrderWish::kNothing;
  return options;
}

verdict::Assessment first_look(const model::Robot& robot) {
  verdict::Assessment assessment = verdict::assess_rigidly(robot, false);
  const bool is_open =
      assessment.is_stable || assessment.rigid.answer == limit::RigidAnswer::kUndecided;
  assessment.verdict = is_open ? verdict::Verdict::kUndecided : verdict::Verdict::kUnstable;
  return assessment;
}

verdict::Assessment assess(const model::Robot& robot, const solver::EquilibriumOptions& options) {
  if (options.is_bonded || first_look(robot).verdict != verdict::Verdict::kUnstable) {
    return verdict::assess(robot, options);
  }
  solver::Equilibrium none;
  none.outcome = solver::Outcome::kNotSought;
  return verdict::assess_equilibrium(robot, std::move(none), options.thread_count);
}

verdict::Assessment assess_bent(const model::Robot& robot,
                                const solver::EquilibriumOptions& options,
                                std::span<const model::Obstacle> obstacles) {
  // As far beyond the loads as what happens there would leave the verdict open.
  return verdict::assess_deformed(robot, assess(robot, options),
                                  {.factor_max = 1 + 2 * verdict::kFactorTie,
                                   .obstacles = obstacles,
                                   .is_bonded = options.is_bonded,
                                   .memory_bytes_max = options.memory_bytes_max,
                                   .thread_count = options.thread_count})
      .assessment;
}

Judgement both_of(const Judgement& a, const Judgement& b) {
  Judgement both = verdict::severity(b.verdict) > verdict::severity(a.verdict) ? b : a;
  both.load_ratio_max = larger(a.load_ratio_max, b.load_ratio_max);
  both.load_ratio_high = larger(a.load_ratio_high, b.load_ratio_high);
  both.margin_mm = smaller(a.margin_mm, b.margin_mm);
  both.is_bound = a.is_bound || b.is_bound;
  return both;
}

std::string verdict_text(const Judgement& judgement) {
  return std::string(verdict::name(judgement.verdict)) +
         (judgement.is_bent ? ", as linear theory does not suffice (holdfast check --deformed)"
                            : "");
}

Judgement judge(const model::Robot& robot, const solver::EquilibriumOptions& options) {
  solver::EquilibriumOptions mine = as_checked(robot, options);
  mine.has_rigid_figures = false;
  return judgement_of(assess(robot, mine));
}

Judgement judgement_of(const verdict::Assessment& assessment) {
  Judgement judgement{.verdict = assessment.verdict,
                      .load_ratio_max = assessment.load_ratio_max,
                      .load_ratio_high = assessment.load_ratio_max,
                      .margin_mm = assessment.simplified.margin_mm,
                      .is_bent = !assessment.reasons.empty() &&
                                 assessment.reasons.front().code == ReasonCode::kSecondOrder};
  if (judgement.load_ratio_high) {
    *judgement.load_ratio_high =
        std::max(*judgement.load_ratio_high, assessment.load_ratio_range.high);
  }
  return judgement;
}

}  // namespace holdfast::plan
