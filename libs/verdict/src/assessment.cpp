// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "holdfast/verdict/assessment.hpp"

#include <algorithm>
#include <span>
#include <utility>
#include <vector>

#include "connection_assessment.hpp"
#include "decision.hpp"
#include "several_solutions.hpp"
#include "stability.hpp"

namespace holdfast::verdict {
namespace {

using mechanics::ContactLaw;
using solver::Equilibrium;
using solver::Outcome;

/// Weak springs beside the unilateral contact of a stable robot: they change no load ratio by more
/// than about 1e-8, and keep the matrix regular on the way to the answer.
constexpr double kStableGammas[] = {1e-9};

/// Multigrid tries only this one: weaker springs escape its single precision, below its own error.
constexpr double kStableGammasMultigrid[] = {1e-6};

/// A toppling robot hangs on its weak springs, and bends elastically while it does: if they are
/// stiff, three corners may still touch and look like a hold. The weaker they are, the more the
/// tilt outweighs the bending; the second value serves one robot in ten thousand. Much weaker ones
/// drown the contact states in rounding.
constexpr double kTopplingGammas[] = {1e-6, 1e-7};

/// From here on a robot that topples is told from the rigid body alone, which is certain: its
/// equilibrium is that of the weak springs it would hang on, a large and almost singular problem.
constexpr std::size_t kTopplingCountMax = 1000;

/// A verdict that hangs on multigrid's error is sought once more with so much less of it.
constexpr double kFinerTolerance = 1e-6;

/// Then the direct solver is asked first where no more blocks than this fill in per module: a solid
/// cube of 17, 4,913 modules, has 60.
constexpr std::size_t kPreciseFillMax = 100;

/// From here on it is asked last, after multigrid with some more digits and with many: of a tower
/// of 3 x 3 x 20,000 that takes a sixth of the time and a tenth of the memory.
constexpr std::size_t kPreciseCountMax = 2'000;
constexpr double kFineTolerance = 1e-4;

/// Whether the model's stability is the rigid body's. A margin of zero is unstable by decision, not
/// by mechanics: no model need agree with it.
bool agrees(const Assessment& assessment) {
  if (assessment.stability_rule == StabilityRule::kContactForces) {
    return assessment.model.is_settled;  // Each is an answer of its own.
  }
  return assessment.model.is_settled && (assessment.model.is_stable == assessment.is_stable ||
                                         assessment.simplified.margin_mm == 0);
}

ContactModel contact_model(const model::Robot& robot, ContactLaw law, host::Ranks& ranks) {
  if (host::all(ranks, std::ranges::all_of(robot.facets(), &model::Facet::is_bonded))) {
    return ContactModel::kNone;
  }
  return law == ContactLaw::kUnilateral ? ContactModel::kUnilateral : ContactModel::kRegularised;
}

std::span<const double> weak_springs(solver::EquilibriumSolver& solver, bool is_stable) {
  if (!is_stable) {
    return kTopplingGammas;
  }
  return solver.prepare(ContactLaw::kUnilateral) == solver::Method::kMultigrid
             ? std::span<const double>(kStableGammasMultigrid)
             : kStableGammas;
}

/// Whether the paper's law, of which Newton's method found no solution, has one that falls. With
/// supports anywhere its answer counts beside the exact law's.
bool falls_by_other_states(const model::Robot& robot, solver::EquilibriumSolver& solver,
                           const Assessment& assessment) {
  if (assessment.stability_rule != StabilityRule::kContactForces || !assessment.model.is_settled ||
      !assessment.model.is_stable) {
    return false;
  }
  const auto found = solver.seek_settled(
      {.law = ContactLaw::kRegularised, .gamma = robot.material().contact_gamma});
  return std::ranges::any_of(found, [&](const Equilibrium& equilibrium) {
    return !model_stability(robot, equilibrium).is_stable;
  });
}

/// The paper's contact law first; the exact one where it has no answer or one that contradicts the
/// rigid body, which is certain on flat ground.
void find_equilibrium(const model::Robot& robot, solver::EquilibriumSolver& solver,
                      const solver::EquilibriumOptions& options, Assessment& assessment) {
  assessment.equilibrium =
      solver.solve({.law = ContactLaw::kRegularised, .gamma = robot.material().contact_gamma});
  assessment.model = model_stability(robot, assessment.equilibrium);
  assessment.contact_model = contact_model(robot, ContactLaw::kRegularised, robot.ranks());
  if (assessment.equilibrium.outcome == Outcome::kTooLarge ||
      assessment.contact_model == ContactModel::kNone) {
    return;
  }
  if (options.is_bonded) {
    assessment.contact_model = ContactModel::kBonded;
    return;
  }
  if (agrees(assessment)) {
    return;
  }
  for (const double gamma : weak_springs(solver, assessment.is_stable)) {
    if (agrees(assessment)) {
      break;
    }
    assessment.equilibrium.displacement = std::vector<base::Vec6<double>>();  // To have its memory.
    assessment.equilibrium.alternative = std::vector<base::Vec6<double>>();
    Equilibrium exact = solver.solve({.law = ContactLaw::kUnilateral, .gamma = gamma});
    exact.begin_with(assessment.equilibrium);
    assessment.equilibrium = std::move(exact);
    assessment.model = model_stability(robot, assessment.equilibrium);
    assessment.contact_model = ContactModel::kUnilateral;
  }
  assessment.model.falls_otherwise = falls_by_other_states(robot, solver, assessment);
}

/// Whether the equilibrium is one of the paper's law that stands.
bool stands_by_paper(const Assessment& assessment) {
  return assessment.contact_model == ContactModel::kRegularised && assessment.is_stable &&
         agrees(assessment);
}

/// The paper's law's further solutions, and the exact law's beside them where there are any, or
/// where open facets may pull. `answers` are those of the equilibrium.
void seek_others(const model::Robot& robot, solver::EquilibriumSolver& solver,
                 const solver::EquilibriumOptions& options, const LoadRange& answers,
                 Assessment& assessment) {
  solver.seek_others(assessment.equilibrium);
  if (!assessment.equilibrium.others.empty() || has_pulling_facets(robot, assessment)) {
    const double gamma = weak_springs(solver, assessment.is_stable).front();
    compare_solutions(robot, solver, gamma, options, answers, assessment);
  }
}

/// The equilibrium, its loads, and what there is beside it. Loads come before others are sought, as
/// then the second answer need not wait.
void solve(const model::Robot& robot, const solver::EquilibriumOptions& options,
           Assessment& assessment) {
  if (!assessment.is_stable && (robot.modules().size() > kTopplingCountMax ||
                                options.method == solver::Method::kMultigrid)) {
    assessment.equilibrium.outcome = Outcome::kNotSought;
    return;
  }
  solver::EquilibriumSolver solver(robot, options);
  find_equilibrium(robot, solver, options, assessment);
  if (assessment.equilibrium.outcome != Outcome::kSettled) {
    return;
  }
  const LoadRange answers = assess_loads(robot, options, assessment);
  if (stands_by_paper(assessment)) {
    seek_others(robot, solver, options, answers, assessment);
  }
}

/// Connections, verdict and reasons, once there are an equilibrium and its loads.
Assessment conclude(const model::Robot& robot, Assessment assessment,
                    const solver::EquilibriumOptions& options) {
  if (assessment.equilibrium.outcome == Outcome::kSettled) {
    assess_connections(robot, options.thread_count, assessment);
    assessment.gaps = find_open_gaps(robot, assessment.equilibrium, robot.ranks());
    assessment.lean = find_lean(robot, assessment);
  }
  decide(robot, assessment);
  return assessment;
}

Assessment assess_once(const model::Robot& robot, const solver::EquilibriumOptions& options) {
  Assessment assessment = assess_rigidly(robot, options.has_rigid_figures);
  assessment.is_stable = assessment.is_stable || options.is_bonded;
  solve(robot, options, assessment);
  return conclude(robot, std::move(assessment), options);
}

/// Whether an error no larger than what the range allows for would decide.
bool is_near_limit(const Assessment& assessment) {
  return assessment.is_stable && assessment.equilibrium.outcome == Outcome::kSettled &&
         assessment.equilibrium.open_but_held_count == 0 &&
         (breaks(assessment.load_ratio_range.low) != breaks(assessment.load_ratio_range.high) ||
          (assessment.several &&
           !do_agree(*assessment.several, breaks(assessment.load_ratio_range.low))));
}

/// Where the verdict hangs on the error: the direct solver with all digits, or where that does not
/// fit multigrid with more of them; of large robots the other way round.
std::vector<solver::EquilibriumOptions> finer_options(const model::Robot& robot,
                                                      const solver::EquilibriumOptions& options) {
  std::vector<solver::EquilibriumOptions> list;
  const bool is_large = model::whole_module_count(robot) > kPreciseCountMax;
  if (options.method != solver::Method::kDirect) {
    solver::EquilibriumOptions multigrid = options;
    multigrid.method = solver::Method::kMultigrid;
    if (is_large) {
      multigrid.tolerance = options.tolerance * kFineTolerance;
      list.push_back(multigrid);
    }
    multigrid.precision = solver::Precision::kDouble;
    multigrid.tolerance = options.tolerance * kFinerTolerance;
    list.push_back(multigrid);
  }
  if (options.method != solver::Method::kMultigrid) {
    solver::EquilibriumOptions direct = options;
    direct.method = solver::Method::kDirect;
    direct.is_precise = true;
    direct.fill_max = kPreciseFillMax;
    list.insert(is_large ? list.end() : list.begin(), direct);
  }
  return list;
}

}  // namespace

bool has_pulling_facets(const model::Robot& robot, const Assessment& assessment) {
  const auto& contact = assessment.equilibrium.contact;
  const bool is_any_not_stuck =
      std::ranges::any_of(contact, [&](const auto& state) { return state != mechanics::kStuck; });
  return !is_on_flat_floor(robot) && host::any(robot.ranks(), is_any_not_stuck);
}

Assessment assess_rigidly(const model::Robot& robot, bool has_figures) {
  Assessment assessment;
  assessment.simplified = assess_rigid_body(robot);
  assessment.stability_rule = stability_rule(robot);
  assessment.rigid =
      rigid_stability(robot, assessment.stability_rule, assessment.simplified, has_figures);
  assessment.is_stable = assessment.rigid.holds();
  return assessment;
}

Assessment assess(const model::Robot& robot, const solver::EquilibriumOptions& options) {
  Assessment assessment = assess_once(robot, options);
  if (!is_near_limit(assessment)) {
    return assessment;
  }
  const std::vector<solver::EquilibriumOptions> all_finer = finer_options(robot, options);
  const solver::EquilibriumOptions* known = &options;  // What `assessment` was found with.
  bool is_whole = true;
  for (const solver::EquilibriumOptions& finer : all_finer) {
    // Their memory is needed elsewhere, and they can be had again.
    assessment.connections = std::vector<ConnectionResult>();
    assessment.equilibrium.displacement = std::vector<base::Vec6<double>>();
    is_whole = false;
    Assessment next = assess_once(robot, finer);
    // Solutions that were found once are there, whether or not they are found again.
    const bool is_one_lost = assessment.several && !next.several;
    if (next.equilibrium.outcome != Outcome::kSettled || is_one_lost) {
      continue;
    }
    if (finer.is_precise || !is_near_limit(next)) {
      return next;
    }
    assessment = std::move(next);
    known = &finer;
    is_whole = true;
  }
  return is_whole ? std::move(assessment) : assess_once(robot, *known);
}

Assessment assess_equilibrium(const model::Robot& robot, Equilibrium equilibrium,
                              int thread_count) {
  Assessment assessment = assess_rigidly(robot);
  assessment.equilibrium = std::move(equilibrium);
  assessment.model = model_stability(robot, assessment.equilibrium);
  assessment.contact_model = contact_model(robot, assessment.equilibrium.law, robot.ranks());
  const solver::EquilibriumOptions options = {.thread_count = thread_count};
  if (assessment.equilibrium.outcome == Outcome::kSettled) {
    assess_loads(robot, options, assessment);
  }
  return conclude(robot, std::move(assessment), options);
}

const char* name(Verdict verdict) {
  switch (verdict) {
    case Verdict::kSafe:
      return "safe";
    case Verdict::kOverload:
      return "overload";
    case Verdict::kUnstable:
      return "unstable";
    case Verdict::kUndecided:
      break;
  }
  return "undecided";
}

const char* name(ContactModel model) {
  switch (model) {
    case ContactModel::kRegularised:
      return "regularised";
    case ContactModel::kUnilateral:
      return "unilateral";
    case ContactModel::kBonded:
      return "bonded";
    case ContactModel::kNone:
      break;
  }
  return "none";
}

}  // namespace holdfast::verdict
