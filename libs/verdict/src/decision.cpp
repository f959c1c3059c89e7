// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "decision.hpp"

#include <cmath>
#include <optional>
#include <span>
#include <utility>

#include "several_solutions.hpp"
#include "stability.hpp"

namespace holdfast::verdict {
namespace {

using solver::Equilibrium;
using solver::Outcome;

Reason toppling_reason(const RigidBody& body) {
  const auto& [a, b] = *body.edge;
  if (*body.margin_mm == 0) {
    return {.code = ReasonCode::kNothingToSpare, .numbers = {a.x, a.y, b.x, b.y}};
  }
  return {.code = ReasonCode::kTopples, .numbers = {a.x, a.y, b.x, b.y, -*body.margin_mm}};
}

/// Why the loads of a stable robot are not known; none if they are.
std::optional<Reason> find_obstacle(std::size_t module_count, const Equilibrium& equilibrium) {
  switch (equilibrium.outcome) {
    case Outcome::kSettled:
      return std::nullopt;
    case Outcome::kTooLarge:
      return Reason{.code = ReasonCode::kTooManyModules,
                    .numbers = {static_cast<double>(module_count)}};
    case Outcome::kTooSlow:
      return Reason{.code = ReasonCode::kNoDigitsLeft};
    case Outcome::kSingular:
      return Reason{.code = ReasonCode::kSingularStiffness,
                    .numbers = {static_cast<double>(equilibrium.steps)}};
    default:
      return Reason{.code = ReasonCode::kNoEquilibrium,
                    .numbers = {static_cast<double>(equilibrium.steps)}};
  }
}

/// Why the loads do not say whether anything breaks; none if they do.
std::optional<Reason> find_doubt(const Assessment& assessment) {
  const LoadRange& range = assessment.load_ratio_range;
  const bool is_broken = breaks(range.low);
  if (std::isnan(range.low) || std::isnan(range.high)) {
    return Reason{.code = ReasonCode::kLoadNotANumber};
  }
  if (!std::isfinite(range.low) || !std::isfinite(range.high) || breaks(range.high) != is_broken) {
    return Reason{.code = ReasonCode::kLimitInRange, .numbers = {range.low, range.high}};
  }
  if (assessment.several && !do_agree(*assessment.several, is_broken)) {
    return reason_of(ReasonCode::kSolutionsDisagree, *assessment.several);
  }
  return std::nullopt;
}

std::size_t connection_count(const Assessment& assessment) {
  return assessment.whole ? assessment.whole->connection_count : assessment.connections.size();
}

/// The ends of the worst connection, where its index is another rank's.
std::vector<base::Cell> worst_cells(const Assessment& assessment) {
  if (!assessment.whole) {
    return {};
  }
  return {assessment.whole->worst.begin(), assessment.whole->worst.end()};
}

/// Why a robot is safe in which nothing breaks.
Reason holding_reason(const Assessment& assessment) {
  if (connection_count(assessment) == 0) {
    return {.code = ReasonCode::kSingleModule};
  }
  if (assessment.worst) {
    return {.code = ReasonCode::kHolds,
            .numbers = {static_cast<double>(*assessment.worst), *assessment.load_ratio_max},
            .cells = worst_cells(assessment)};
  }
  const double bound = assessment.load_ratio_range.high;
  return bound < kLoadRatioTie ? Reason{.code = ReasonCode::kNoTension}
                               : Reason{.code = ReasonCode::kNoKnownTension, .numbers = {bound}};
}

Reason breaking_reason(const Assessment& assessment) {
  return {.code = ReasonCode::kConnectionsBreak,
          .numbers = {static_cast<double>(assessment.whole ? assessment.whole->broken_count
                                                           : assessment.broken.size()),
                      static_cast<double>(connection_count(assessment)),
                      static_cast<double>(*assessment.worst), *assessment.load_ratio_max},
          .cells = worst_cells(assessment)};
}

void decide_stable(const model::Robot& robot, Assessment& assessment) {
  const std::size_t count = model::whole_module_count(robot);
  auto obstacle = find_obstacle(count, assessment.equilibrium);
  if (!obstacle) {
    obstacle = find_doubt(assessment);
  }
  if (obstacle) {
    assessment.reasons.push_back(*std::move(obstacle));
  } else if (breaks(assessment.load_ratio_range.low)) {
    assessment.verdict = Verdict::kOverload;
    assessment.reasons.push_back(breaking_reason(assessment));
  } else if (assessment.lean && assessment.lean->margin_mm <= 0) {
    assessment.is_stable = false;
    assessment.reasons.push_back(
        {.code = ReasonCode::kDisplacedMass,
         .numbers = {assessment.lean->shift_mm, *assessment.simplified.margin_mm,
                     -assessment.lean->margin_mm}});
  } else {
    assessment.verdict = Verdict::kSafe;
    assessment.reasons.push_back(holding_reason(assessment));
  }
}

void add_contact_remarks(Assessment& assessment) {
  std::vector<Reason>& reasons = assessment.reasons;
  if (assessment.contact_model == ContactModel::kUnilateral) {
    reasons.push_back({.code = ReasonCode::kUnilateralContact});
  }
  if (assessment.several && assessment.verdict != Verdict::kUndecided) {
    reasons.push_back(reason_of(ReasonCode::kSolutionsAgree, *assessment.several));
  }
  if (assessment.equilibrium.open_but_held_count > 0) {
    reasons.push_back(
        {.code = ReasonCode::kAmbiguousFeet,
         .numbers = {static_cast<double>(assessment.equilibrium.open_but_held_count),
                     assessment.load_ratio_range.low, assessment.load_ratio_range.high}});
  }
  if (assessment.contact_model == ContactModel::kBonded) {
    reasons.push_back({.code = ReasonCode::kBonded});
    return;
  }
  if (assessment.stability_rule != StabilityRule::kContactForces && assessment.model.is_settled &&
      assessment.model.is_stable != assessment.rigid.holds()) {
    reasons.push_back(
        {.code = ReasonCode::kModelDisagrees, .numbers = {assessment.model.is_stable ? 1.0 : 0.0}});
  }
}

/// The cell of a slipping module, which may be another rank's.
std::vector<base::Cell> slip_cells(const model::Robot& robot, const Slip& slip) {
  if (!robot.ranks().is_shared()) {
    return {};
  }
  const base::Cell mine =
      robot.ranks().rank() == slip.rank ? robot.modules()[slip.module].cell : base::Cell{};
  return {host::gather(robot.ranks(), std::span<const base::Cell>(&mine, 1))[base::at(slip.rank)]};
}

/// Of the answers with supports anywhere neither is enough to be safe. Without equilibrium the
/// model has none.
void heed_model(const model::Robot& robot, Assessment& assessment) {
  if (!assessment.is_stable) {
    return;
  }
  auto slip = assessment.equilibrium.outcome == Outcome::kSettled
                  ? find_slip(robot, assessment.equilibrium)
                  : std::nullopt;
  if (!slip) {
    slip = assessment.model.slip_otherwise;
  }
  if (assessment.stability_rule == StabilityRule::kContactForces && assessment.model.is_settled &&
      !assessment.model.is_stable) {
    assessment.is_stable = false;
    assessment.verdict = Verdict::kUnstable;
    assessment.reasons.push_back({.code = ReasonCode::kModelFalls});
  } else if (assessment.model.falls_otherwise && !breaks(assessment.load_ratio_range.low)) {
    assessment.is_stable = false;
    assessment.reasons.push_back({.code = ReasonCode::kStatesDisagree});
  } else if (slip) {
    assessment.is_stable = false;
    assessment.reasons.push_back(
        {.code = ReasonCode::kMaySlip,
         .numbers = {static_cast<double>(slip->module), slip->ratio, slip->friction},
         .cells = slip_cells(robot, *slip)});
  }
}

/// The verdict on a robot that the rigid body does not hold.
void decide_falling(Assessment& assessment) {
  using limit::RigidAnswer;
  const limit::RigidStability& rigid = assessment.rigid;
  assessment.verdict =
      rigid.answer == RigidAnswer::kUndecided ? Verdict::kUndecided : Verdict::kUnstable;
  if (assessment.simplified.edge && assessment.simplified.margin_mm) {
    assessment.reasons.push_back(toppling_reason(assessment.simplified));
  } else if (rigid.answer == RigidAnswer::kUndecided) {
    assessment.reasons.push_back({.code = ReasonCode::kRigidUndecided});
  } else if (rigid.answer == RigidAnswer::kNothingToSpare) {
    assessment.reasons.push_back({.code = ReasonCode::kBalances});
  } else {
    assessment.reasons.push_back(
        {.code = ReasonCode::kFalls,
         .quoted = rigid.motion ? limit::text(*rigid.motion) : std::string()});
  }
}

/// The ends of the connection that opens most, where its index is another rank's.
std::vector<base::Cell> gap_cells(const model::Robot& robot, const OpenGaps& gaps) {
  if (!robot.ranks().is_shared()) {
    return {};
  }
  return {gaps.ends.begin(), gaps.ends.end()};
}

/// What is no reason for the verdict, but belongs to its loads.
void add_load_remarks(const model::Robot& robot, Assessment& assessment) {
  if (assessment.gaps) {
    assessment.reasons.push_back({.code = ReasonCode::kGapsOpen,
                                  .numbers = {static_cast<double>(assessment.gaps->count),
                                              static_cast<double>(assessment.gaps->worst),
                                              assessment.gaps->gap_mm, assessment.gaps->limit_mm},
                                  .cells = gap_cells(robot, *assessment.gaps)});
  }
  const double margin = assessment.simplified.margin_mm.value_or(0);
  if (assessment.lean && assessment.lean->margin_mm > 0 &&
      margin - assessment.lean->margin_mm > kLeanShare * margin) {
    assessment.reasons.push_back(
        {.code = ReasonCode::kMassMoves,
         .numbers = {assessment.lean->shift_mm, margin, assessment.lean->margin_mm}});
  }
  const bool has_payloads = host::any(robot.ranks(), robot.has_payloads());
  if (has_payloads && assessment.worst) {
    assessment.reasons.push_back({.code = ReasonCode::kLoadsTogether});
  }
}

}  // namespace

void decide(const model::Robot& robot, Assessment& assessment) {
  if (assessment.contact_model != ContactModel::kBonded) {
    heed_model(robot, assessment);
  }
  if (assessment.is_stable) {
    decide_stable(robot, assessment);
  } else if (assessment.reasons.empty()) {
    decide_falling(assessment);
  }
  add_contact_remarks(assessment);
  add_load_remarks(robot, assessment);
}

}  // namespace holdfast::verdict
