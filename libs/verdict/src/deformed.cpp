// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "holdfast/verdict/deformed.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <utility>

#include "connection_assessment.hpp"
#include "holdfast/model/connector_law.hpp"
#include "stability.hpp"

namespace holdfast::verdict {
namespace {

using large::Path;
using large::State;

/// The first thing that happens to a robot as its loads grow, and the verdict if it does before
/// they are what they are.
struct Happening {
  double factor = 0;
  Verdict verdict = Verdict::kUndecided;
  Reason reason;
};

double number(std::size_t index) { return static_cast<double>(index); }

/// The reason for an overload: connections that break under the loads as they are, or the one that
/// did on the way.
Reason breaking(const model::Robot& robot, const large::Event& event,
                const Assessment& assessment) {
  const auto connections = robot.connections();
  std::size_t worst = assessment.broken.empty() ? connections.size() : assessment.broken.front();
  double ratio = 1;
  if (worst < connections.size()) {
    ratio = assessment.connections[worst].load_ratio;
  } else {
    for (worst = 0; worst + 1 < connections.size(); ++worst) {
      const model::Connection pair = connections[worst];
      if (base::at(pair.a) == event.modules[0] && base::at(pair.b) == event.modules[1]) {
        break;
      }
    }
  }
  return {.code = ReasonCode::kConnectionsBreak,
          .numbers = {std::max(1.0, number(assessment.broken.size())), number(connections.size()),
                      number(worst), ratio}};
}

Happening happening_of(const model::Robot& robot, const large::Event& event,
                       const Assessment& assessment) {
  using large::EventKind;
  switch (event.kind) {
    case EventKind::kBreaks:
      return {.factor = event.factor,
              .verdict = Verdict::kOverload,
              .reason = breaking(robot, event, assessment)};
    case EventKind::kTouchesFloor:
      return {.factor = event.factor,
              .reason = {.code = ReasonCode::kTouchesFloor,
                         .numbers = {event.factor, number(event.modules[0])}}};
    case EventKind::kTouchesItself:
      return {.factor = event.factor,
              .reason = {.code = ReasonCode::kTouchesItself,
                         .numbers = {event.factor, number(event.modules.front()),
                                     event.modules.size() > 1 ? number(event.modules[1]) : -1}}};
    case EventKind::kTooSoft:
      break;
  }
  return {.factor = event.factor,
          .reason = {.code = ReasonCode::kTooSoft, .numbers = {event.factor, large::kStrainMax}}};
}

Happening happening_of(const large::Critical& critical) {
  const bool is_buckling = critical.loss == large::Loss::kBifurcation;
  return {.factor = critical.factor,
          .verdict = Verdict::kUnstable,
          .reason = {.code = is_buckling ? ReasonCode::kBuckles : ReasonCode::kCollapses,
                     .numbers = {critical.factor, number(critical.module), critical.motion[0],
                                 critical.motion[1], critical.motion[2],
                                 critical.is_by_facets ? 1.0 : 0.0}}};
}

/// All that happens on a path, by factor.
std::vector<Happening> happenings(const model::Robot& robot, const Path& path,
                                  const Assessment& assessment) {
  std::vector<Happening> all;
  for (const large::Event& event : path.events) {
    all.push_back(happening_of(robot, event, assessment));
  }
  if (path.critical) {
    all.push_back(happening_of(*path.critical));
  }
  std::ranges::stable_sort(all, {}, &Happening::factor);
  return all;
}

/// Loads of connections, and what breaks.
void take_connections(const model::Robot& robot, const State& state, Assessment& assessment) {
  assessment.connections.clear();
  assessment.broken.clear();
  const auto connections = robot.connections();
  auto connection = connections.begin();
  for (std::size_t i = 0; i < connections.size(); ++i, ++connection) {
    const auto force = model::connection_force(robot.connector(*connection), state.middle_force[i]);
    assessment.connections.push_back({.load_ratio = state.load_ratio[i],
                                      .axial_n = force.axial_n,
                                      .bending_nmm = force.bending_nmm,
                                      .shear_n = force.shear_n,
                                      .torsion_nmm = force.torsion_nmm});
    if (breaks(state.load_ratio[i])) {
      assessment.broken.push_back(i);
    }
  }
  std::ranges::stable_sort(assessment.broken, std::greater<>(),
                           [&](std::size_t i) { return state.load_ratio[i]; });
  assessment.load_ratio_max.reset();
  assessment.worst.reset();
  assessment.load_ratio_range = {};
  assessment.load_ratio_change = 0;
  if (state.worst) {
    const double margin = kFactorTie * 1e-4 * std::max(1.0, state.load_ratio_max);
    assessment.load_ratio_max = state.load_ratio_max;
    assessment.load_ratio_range = {.low = state.load_ratio_max - margin,
                                   .high = state.load_ratio_max + margin};
    if (state.load_ratio_max >= kLoadRatioTie) {
      assessment.worst = state.worst;
    }
  }
}

/// Displacements, contact states and the forces of facets.
void take_equilibrium(const State& state, Assessment& assessment) {
  solver::Equilibrium& equilibrium = assessment.equilibrium;
  equilibrium.outcome = solver::Outcome::kSettled;
  equilibrium.law = mechanics::ContactLaw::kUnilateral;
  equilibrium.displacement.clear();
  for (const mechanics::Pose& pose : state.poses) {
    const auto& u = pose.displacement;
    const auto turn = mechanics::rotation_vector(pose.rotation);
    equilibrium.displacement.push_back({u[0], u[1], u[2], turn[0], turn[1], turn[2]});
  }
  equilibrium.displacement_low.clear();
  equilibrium.alternative = equilibrium.displacement;
  equilibrium.gamma = 0;
  equilibrium.energy_error = 0;
  equilibrium.others.clear();
  equilibrium.slip.clear();
  equilibrium.open_but_held_count = 0;
  equilibrium.facet_force = state.facet_force;
  equilibrium.contact.clear();
  for (const solver::FacetState& facet : state.facets) {
    equilibrium.contact.push_back(facet.state);
  }
  if (assessment.contact_model == ContactModel::kRegularised) {
    assessment.contact_model = ContactModel::kUnilateral;
  }
  assessment.several.reset();
  assessment.lean.reset();
}

/// Says why nothing is known of a robot under its loads; none if something is.
std::optional<Reason> find_end(const model::Robot& robot, const Path& path) {
  if (path.outcome == large::Outcome::kTooLarge) {
    return Reason{.code = ReasonCode::kTooManyModules, .numbers = {number(robot.modules().size())}};
  }
  if (!path.loaded && path.outcome != large::Outcome::kLost) {
    return Reason{.code = ReasonCode::kNoEquilibrium,
                  .numbers = {number(base::at(path.solve_count))}};
  }
  return std::nullopt;
}

/// The verdict by the first of the table's events, docs/second_order.md. Feet are followed as if
/// they stuck: what breaks then may hold where they slip.
Happening decision_of(const model::Robot& robot, const Path& path,
                      const std::vector<Happening>& all, const Assessment& assessment) {
  const auto slip = find_slip(robot, assessment.equilibrium);
  const bool happens = !all.empty() && all.front().factor <= 1 + kFactorTie;
  if (happens && !(slip && all.front().verdict == Verdict::kOverload)) {
    Happening first = all.front();
    if (first.factor >= 1 - kFactorTie) {
      first.verdict = Verdict::kUndecided;
    }
    return first;
  }
  if (const auto end = find_end(robot, path)) {
    return {.reason = *end};
  }
  if (slip) {
    return {.reason = {.code = ReasonCode::kMaySlip,
                       .numbers = {number(slip->module), slip->ratio, slip->friction}}};
  }
  Reason reason{.code = ReasonCode::kSingleModule};
  if (assessment.worst) {
    reason = {.code = ReasonCode::kHolds,
              .numbers = {number(*assessment.worst), *assessment.load_ratio_max}};
  } else if (!assessment.connections.empty()) {
    reason = {.code = ReasonCode::kNoTension};
  }
  return {.verdict = Verdict::kSafe, .reason = std::move(reason)};
}

/// Whether linear theory says all that there is to say: the robot topples, or may by one of the
/// contact laws, before anything bends.
bool is_settled_without(const Assessment& linear, bool is_bonded) {
  const ReasonCode code = linear.reasons.front().code;
  return (!linear.rigid.holds() && !is_bonded) || code == ReasonCode::kModelFalls ||
         code == ReasonCode::kStatesDisagree;
}

}  // namespace

Deformed assess_deformed(const model::Robot& robot, Assessment linear,
                         const large::Options& options) {
  if (is_settled_without(linear, options.is_bonded)) {
    return {.assessment = std::move(linear)};
  }
  Deformed deformed{.assessment = std::move(linear), .path = large::follow(robot, options)};
  Assessment& assessment = deformed.assessment;
  const Path& path = *deformed.path;
  const State& state = path.loaded ? *path.loaded : path.last;
  if (state.poses.empty()) {  // There was no start.
    assessment.verdict = Verdict::kUndecided;
    assessment.reasons = {find_end(robot, path).value_or(Reason{})};
    return deformed;
  }
  take_equilibrium(state, assessment);
  take_connections(robot, state, assessment);
  assessment.gaps_mm = state.gap_mm;
  assessment.gaps = find_open_gaps(robot, state.gap_mm);
  const std::vector<Happening> all = happenings(robot, path, assessment);
  Happening decision = decision_of(robot, path, all, assessment);
  assessment.verdict = decision.verdict;
  assessment.reasons = {std::move(decision.reason)};
  assessment.is_stable = path.loaded.has_value() && decision.verdict != Verdict::kUnstable;
  const auto next =
      std::ranges::find_if(all, [](const Happening& one) { return one.factor > 1 + kFactorTie; });
  assessment.weight_factor = decision.verdict != Verdict::kSafe
                                 ? (all.empty() ? std::optional<double>() : all.front().factor)
                             : next != all.end() ? std::optional(next->factor)
                                                 : std::nullopt;
  if (assessment.contact_model == ContactModel::kBonded) {
    assessment.reasons.push_back({.code = ReasonCode::kBonded});
  }
  if (assessment.gaps) {
    assessment.reasons.push_back(
        {.code = ReasonCode::kGapsOpen,
         .numbers = {number(assessment.gaps->count), number(assessment.gaps->worst),
                     assessment.gaps->gap_mm, assessment.gaps->limit_mm}});
  }
  if (robot.has_payloads()) {
    assessment.reasons.push_back({.code = ReasonCode::kLoadsTogether});
  }
  return deformed;
}

Assessment assess_state(const model::Robot& robot, const State& state, bool is_stable,
                        bool is_bonded) {
  Assessment assessment;
  assessment.is_stable = is_stable;
  assessment.contact_model = is_bonded ? ContactModel::kBonded : ContactModel::kUnilateral;
  take_equilibrium(state, assessment);
  take_connections(robot, state, assessment);
  assessment.gaps_mm = state.gap_mm;
  assessment.gaps = find_open_gaps(robot, state.gap_mm);
  assessment.verdict = !is_stable                   ? Verdict::kUnstable
                       : !assessment.broken.empty() ? Verdict::kOverload
                                                    : Verdict::kSafe;
  return assessment;
}

}  // namespace holdfast::verdict
