// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "judges/core_assessment.hpp"

#include <cmath>
#include <utility>

#include "holdfast/plan/candidates.hpp"

namespace holdfast::plan {
namespace {

/// Whether a check of the robot would end here as well, with this equilibrium of the regularised
/// law which has no others (find_equilibrium() in verdict/src/assessment.cpp).
bool is_final(const model::Robot& robot, const verdict::Assessment& assessment) {
  const bool is_model_needed = assessment.stability_rule != verdict::StabilityRule::kContactForces;
  const bool agrees = assessment.model.is_settled && assessment.is_stable &&
                      (assessment.model.is_stable || !is_model_needed);
  const bool is_decided = assessment.verdict == verdict::Verdict::kSafe ||
                          assessment.verdict == verdict::Verdict::kOverload;
  const double distance = std::abs(assessment.load_ratio_max.value_or(0) - 1);
  return agrees && !verdict::has_pulling_facets(robot, assessment) && is_decided &&
         distance > kNearLimit;
}

}  // namespace

std::optional<verdict::Assessment> assess_by_core(CoreResponse& core, const model::Robot& robot,
                                                  int thread_count) {
  auto equilibrium = core.solve(robot);
  if (!equilibrium) {
    return std::nullopt;
  }
  verdict::Assessment assessment =
      verdict::assess_equilibrium(robot, *std::move(equilibrium), thread_count);
  return is_final(robot, assessment) ? std::optional(std::move(assessment)) : std::nullopt;
}

}  // namespace holdfast::plan
