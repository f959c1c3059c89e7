// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "holdfast/plan/judgement.hpp"

namespace holdfast::plan {

verdict::Assessment first_look(const model::Robot& robot) {
  verdict::Assessment assessment = verdict::assess_rigidly(robot);
  const bool is_open =
      assessment.is_stable || assessment.rigid.answer == limit::RigidAnswer::kUndecided;
  assessment.verdict = is_open ? verdict::Verdict::kUndecided : verdict::Verdict::kUnstable;
  return assessment;
}

Judgement judge(const model::Robot& robot, const solver::EquilibriumOptions& options) {
  verdict::Assessment assessment = first_look(robot);
  if (assessment.verdict != verdict::Verdict::kUnstable || options.is_bonded) {
    assessment = verdict::assess(robot, options);
  }
  return {.verdict = assessment.verdict,
          .load_ratio_max = assessment.load_ratio_max,
          .margin_mm = assessment.simplified.margin_mm};
}

}  // namespace holdfast::plan
