// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "decision.hpp"

#include <array>
#include <cmath>
#include <optional>
#include <span>

#include "holdfast/model/lattice_beam.hpp"
#include "second_order_check.hpp"
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

/// Says why the loads of a stable robot do not decide whether anything breaks; none if they do.
std::optional<Reason> find_doubt(const Situation& here, const Assessment& assessment) {
  const Equilibrium& equilibrium = assessment.equilibrium;
  const LoadRange& range = assessment.load_ratio_range;
  const bool is_broken = breaks(range.low);
  std::optional<Reason> doubt;
  if (equilibrium.outcome == Outcome::kTooLarge) {
    doubt = Reason{.code = ReasonCode::kTooManyModules,
                   .numbers = {static_cast<double>(here.module_count)}};
  } else if (equilibrium.outcome == Outcome::kTooSlow) {
    doubt = Reason{.code = ReasonCode::kNoDigitsLeft};
  } else if (equilibrium.outcome != Outcome::kSettled) {
    const bool is_singular = equilibrium.outcome == Outcome::kSingular;
    doubt =
        Reason{.code = is_singular ? ReasonCode::kSingularStiffness : ReasonCode::kNoEquilibrium,
               .numbers = {static_cast<double>(equilibrium.steps)}};
  } else if (std::isnan(range.low) || std::isnan(range.high)) {
    doubt = Reason{.code = ReasonCode::kLoadNotANumber};
  } else if (!std::isfinite(range.low) || !std::isfinite(range.high) ||
             breaks(range.high) != is_broken) {
    doubt = Reason{.code = ReasonCode::kLimitInRange, .numbers = {range.low, range.high}};
  } else if (assessment.several && !do_agree(*assessment.several, is_broken)) {
    doubt = reason_of(ReasonCode::kSolutionsDisagree, *assessment.several);
  }
  return doubt;
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

/// Says why a robot is safe in which nothing breaks.
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

/// The cell of a slipping module, which may be another rank's.
std::vector<base::Cell> slip_cells(const model::Robot& robot, const Slip& slip) {
  if (!robot.ranks().is_shared()) {
    return {};
  }
  const base::Cell mine =
      robot.ranks().rank() == slip.rank ? robot.modules()[slip.module].cell : base::Cell{};
  return {host::gather(robot.ranks(), std::span<const base::Cell>(&mine, 1))[base::at(slip.rank)]};
}

/// Says why a robot that the rigid body holds may not stay by the model; none if it does. With
/// supports anywhere neither of both answers is enough to be safe. Without equilibrium the model
/// has none.
std::optional<Reason> find_fall(const Situation& here, const Assessment& assessment) {
  const ModelStability& model = assessment.model;
  auto slip = assessment.equilibrium.outcome == Outcome::kSettled
                  ? find_slip(here.robot, assessment.equilibrium)
                  : std::nullopt;
  slip = slip ? slip : model.slip_otherwise;
  std::optional<Reason> fall;
  if (here.rule == StabilityRule::kContactForces && model.is_settled && !model.is_stable) {
    fall = Reason{.code = ReasonCode::kModelFalls};
  } else if (model.falls_otherwise && !breaks(assessment.load_ratio_range.low)) {
    fall = Reason{.code = ReasonCode::kStatesDisagree};
  } else if (slip) {
    fall = Reason{.code = ReasonCode::kMaySlip,
                  .numbers = {static_cast<double>(slip->module), slip->ratio, slip->friction},
                  .cells = slip_cells(here.robot, *slip)};
  }
  return fall;
}

/// Says why a robot that the rigid body does not hold is not known to stay.
Reason falling_reason(const Assessment& assessment) {
  using limit::RigidAnswer;
  const limit::RigidStability& rigid = assessment.rigid;
  Reason reason;
  if (assessment.simplified.edge && assessment.simplified.margin_mm) {
    reason = toppling_reason(assessment.simplified);
  } else if (rigid.answer == RigidAnswer::kUndecided) {
    reason.code = ReasonCode::kRigidUndecided;
  } else if (rigid.answer == RigidAnswer::kNothingToSpare) {
    reason.code = ReasonCode::kBalances;
  } else {
    reason = {.code = ReasonCode::kFalls,
              .quoted = rigid.motion ? limit::text(*rigid.motion) : std::string()};
  }
  return reason;
}

/// Says how many feet slip, and which carries most then.
Reason slip_remark(const model::Robot& robot, const Equilibrium& equilibrium) {
  const model::LatticeBeam<double> beam(model::beam_section(robot.material()), robot.lattice());
  Reason reason{.code = ReasonCode::kFeetSlip};
  auto& [count, module, sideways, share, unused, none] = reason.numbers;
  for (std::size_t i = 0; i < equilibrium.slip.size(); ++i) {
    const model::Facet& facet = robot.facets()[i];
    const auto local = beam.to_local(facet.direction, equilibrium.facet_force[i]);
    const double exact = std::hypot(local[0], local[1]);
    const double across = exact < kLoadRatioTie * std::abs(local[2]) ? 0 : exact;
    if (equilibrium.slip[i] == std::array<double, 3>{}) {
      continue;
    }
    count += 1;
    if (count == 1 || across > sideways * (1 + kLoadRatioTie)) {
      module = facet.module;
      sideways = across;
      share = across / std::abs(local[2]);
    }
  }
  return reason;
}

void add_contact_remarks(const Situation& here, Assessment& assessment) {
  std::vector<Reason>& reasons = assessment.reasons;
  if (!assessment.equilibrium.slip.empty()) {
    reasons.push_back(slip_remark(here.robot, assessment.equilibrium));
  }
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

/// Adds remarks that are no reason for the verdict, but belong to its loads.
void add_load_remarks(const Situation& here, Assessment& assessment) {
  if (const auto& gaps = assessment.gaps) {
    Reason reason = {.code = ReasonCode::kGapsOpen,
                     .numbers = {static_cast<double>(gaps->count), static_cast<double>(gaps->worst),
                                 gaps->gap_mm, gaps->limit_mm}};
    if (assessment.whole) {  // The index is another rank's.
      reason.cells = {gaps->ends.begin(), gaps->ends.end()};
    }
    assessment.reasons.push_back(std::move(reason));
  }
  const double margin = assessment.simplified.margin_mm.value_or(0);
  if (assessment.lean && assessment.lean->margin_mm > 0 &&
      margin - assessment.lean->margin_mm > kLeanShare * margin) {
    assessment.reasons.push_back(
        {.code = ReasonCode::kMassMoves,
         .numbers = {assessment.lean->shift_mm, margin, assessment.lean->margin_mm}});
  }
  const bool is_doubted = assessment.reasons.front().code == ReasonCode::kSecondOrder;
  if (auto warning = is_doubted ? std::nullopt : second_order_warning(assessment)) {
    assessment.reasons.push_back(*std::move(warning));
  }
  if (here.has_payloads && assessment.worst) {
    assessment.reasons.push_back({.code = ReasonCode::kLoadsTogether});
  }
}

/// A verdict, whether the robot stays, and why.
struct Decision {
  Verdict verdict = Verdict::kUndecided;
  bool is_stable = false;
  Reason reason;
};

/// Finds the verdict as docs/theory.md defines it: the first that holds.
Decision decision_on(const Situation& here, const Assessment& assessment) {
  if (!assessment.is_stable) {
    const bool is_known = assessment.rigid.answer != limit::RigidAnswer::kUndecided;
    return {.verdict = is_known ? Verdict::kUnstable : Verdict::kUndecided,
            .reason = falling_reason(assessment)};
  }
  const bool is_bonded = assessment.contact_model == ContactModel::kBonded;
  if (auto fall = is_bonded ? std::nullopt : find_fall(here, assessment)) {
    const bool is_known = fall->code == ReasonCode::kModelFalls;
    return {.verdict = is_known ? Verdict::kUnstable : Verdict::kUndecided,
            .reason = *std::move(fall)};
  }
  if (auto doubt = find_doubt(here, assessment)) {
    return {.is_stable = true, .reason = *std::move(doubt)};
  }
  if (auto doubt = second_order_doubt(assessment)) {
    return {.is_stable = true, .reason = *std::move(doubt)};
  }
  if (breaks(assessment.load_ratio_range.low)) {
    return {
        .verdict = Verdict::kOverload, .is_stable = true, .reason = breaking_reason(assessment)};
  }
  if (assessment.lean && assessment.lean->margin_mm <= 0) {
    return {.reason = {.code = ReasonCode::kDisplacedMass,
                       .numbers = {assessment.lean->shift_mm, *assessment.simplified.margin_mm,
                                   -assessment.lean->margin_mm}}};
  }
  return {.verdict = Verdict::kSafe, .is_stable = true, .reason = holding_reason(assessment)};
}

}  // namespace

void decide(const Situation& here, Assessment& assessment) {
  Decision decision = decision_on(here, assessment);
  assessment.verdict = decision.verdict;
  assessment.is_stable = decision.is_stable;
  assessment.reasons = {std::move(decision.reason)};
  add_contact_remarks(here, assessment);
  add_load_remarks(here, assessment);
}

}  // namespace holdfast::verdict
