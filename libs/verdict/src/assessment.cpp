// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "holdfast/verdict/assessment.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "connection_assessment.hpp"
#include "decision.hpp"
#include "pieces/pieces.hpp"
#include "second_order_check.hpp"
#include "several_solutions.hpp"
#include "stability.hpp"

namespace holdfast::verdict {
namespace {

using mechanics::ContactLaw;
using solver::Equilibrium;
using solver::Outcome;

/// The weak springs beside the unilateral contact of a stable robot: they change no load ratio by
/// more than about 1e-8, and keep the matrix regular until the answer is found.
constexpr double kStableGammas[] = {1e-9};

/// The only weak springs that multigrid tries: weaker ones are lost in its single precision, below
/// its own error.
constexpr double kStableGammasMultigrid[] = {1e-6};

/// The weak springs of a toppling robot, which bends elastically while they hold it. If they are
/// stiff, three corners may still touch and look like a hold. The weaker they are, the more the
/// tilt outweighs the bending; the second value serves one robot in ten thousand. Much weaker
/// springs lose the contact states in rounding.
constexpr double kTopplingGammas[] = {1e-6, 1e-7};

/// A toppling robot of more modules is recognised by the rigid body alone, which is certain: its
/// equilibrium is that of the weak springs that would hold it, a large and almost singular problem.
constexpr std::size_t kTopplingCountMax = 1000;

/// The factor of the tolerance with which a verdict that depends on multigrid's error is sought
/// again.
constexpr double kFinerTolerance = 1e-6;

/// The direct solver comes first when a verdict is sought again if no more blocks than this fill in
/// per module: a solid cube of 17, 4,913 modules, has 60.
constexpr std::size_t kPreciseFillMax = 100;

/// The direct solver comes last for robots of more modules, after multigrid with some more digits
/// and with many: a tower of 3 x 3 x 20,000 then takes a sixth of the time and a tenth of the
/// memory.
constexpr std::size_t kPreciseCountMax = 2'000;
constexpr double kFineTolerance = 1e-4;

/// The part of the assessment that the rigid body decides, Sec. III-B.
Assessment look_at_rigid_body(const Situation& here, bool has_figures) {
  Assessment assessment;
  assessment.stability_rule = here.rule;
  assessment.simplified = rigid_body(here);
  assessment.rigid = rigid_stability(here, assessment.simplified, has_figures);
  assessment.is_stable = assessment.rigid.holds();
  return assessment;
}

/// Whether the model's stability is the rigid body's. A margin of zero is unstable by decision, not
/// by mechanics: no model need agree with it. With supports anywhere each is an answer of its own.
bool agrees(const Assessment& assessment) {
  return assessment.model.is_settled &&
         (assessment.stability_rule == StabilityRule::kContactForces ||
          assessment.model.is_stable == assessment.is_stable ||
          assessment.simplified.margin_mm == 0);
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
bool falls_by_other_states(const Situation& here, solver::EquilibriumSolver& solver,
                           const ModelStability& model) {
  if (here.rule != StabilityRule::kContactForces || !model.is_settled || !model.is_stable) {
    return false;
  }
  const auto found = solver.seek_settled(
      {.law = ContactLaw::kRegularised, .gamma = here.robot.material().contact_gamma});
  return std::ranges::any_of(found, [&](const Equilibrium& equilibrium) {
    return !model_stability(here, equilibrium).is_stable;
  });
}

/// The paper's contact law first; the exact one where it has no answer or one that contradicts the
/// rigid body, which is certain on flat ground.
void find_equilibrium(const Situation& here, solver::EquilibriumSolver& solver, bool is_bonded,
                      Assessment& assessment) {
  Equilibrium& found = assessment.equilibrium;
  found =
      solver.solve({.law = ContactLaw::kRegularised, .gamma = here.robot.material().contact_gamma});
  assessment.model = model_stability(here, found);
  const bool is_too_large = found.outcome == Outcome::kTooLarge;
  assessment.contact_model = !here.has_contact            ? ContactModel::kNone
                             : is_bonded && !is_too_large ? ContactModel::kBonded
                                                          : ContactModel::kRegularised;
  if (is_too_large || assessment.contact_model != ContactModel::kRegularised ||
      agrees(assessment)) {
    return;
  }
  for (const double gamma : weak_springs(solver, assessment.is_stable)) {
    found.displacement = std::vector<base::Vec6<double>>();  // To have its memory.
    found.alternative = std::vector<base::Vec6<double>>();
    Equilibrium exact = solver.solve({.law = ContactLaw::kUnilateral, .gamma = gamma});
    exact.begin_with(found);
    found = std::move(exact);
    assessment.model = model_stability(here, found);
    assessment.contact_model = ContactModel::kUnilateral;
    if (agrees(assessment)) {
      break;
    }
  }
  assessment.model.falls_otherwise = falls_by_other_states(here, solver, assessment.model);
}

/// Whether a robot of a settled equilibrium stands by a solution of the paper's law, which may then
/// have others.
bool stands_by_paper(const Assessment& assessment) {
  return assessment.contact_model == ContactModel::kRegularised && assessment.is_stable &&
         agrees(assessment);
}

bool has_pulling_facets(const Situation& here, const Equilibrium& equilibrium) {
  return !here.is_on_flat_floor &&
         host::any(here.robot.ranks(), !solver::are_all_stuck(equilibrium));
}

/// The paper's law's further solutions, and the exact law's answer where there are any, or where
/// open facets may pull.
void look_beside(const Situation& here, solver::EquilibriumSolver& solver,
                 const solver::EquilibriumOptions& options, const LoadRange& answers,
                 Assessment& assessment) {
  solver.seek_others(assessment.equilibrium);
  if (here.has_connections && (!assessment.equilibrium.others.empty() ||
                               has_pulling_facets(here, assessment.equilibrium))) {
    const double gamma = weak_springs(solver, assessment.is_stable).front();
    compare_solutions(here, solver, gamma, options, answers, assessment);
  }
}

/// Whether slips of feet may decide in place of the equilibrium without: on a level floor, where
/// contact forces within friction hold the robot as a rigid body.
bool may_let_slip(const Situation& here, const Assessment& assessment, bool is_bonded) {
  return !here.robot.ranks().is_shared() && touches_one_level(here.robot) && assessment.is_stable &&
         agrees(assessment) && !is_bonded && assessment.equilibrium.open_but_held_count == 0 &&
         find_slip(here.robot, assessment.equilibrium).has_value();
}

/// Whether all equilibria stand by the model, without more sideways than friction.
bool do_hold(const Situation& here, const std::vector<Equilibrium>& all) {
  return !all.empty() && std::ranges::all_of(all, [&](const Equilibrium& one) {
    return !find_slip(here.robot, one) &&
           (here.rule == StabilityRule::kHeld || model_stability(here, one).is_stable);
  });
}

/// The equilibria by the exact law, with slips if it needs them; none where one is not known.
std::vector<Equilibrium> slid_by_exact_law(const Situation& here,
                                           solver::EquilibriumSolver& solver) {
  const solver::ContactOptions contact = {.law = ContactLaw::kUnilateral,
                                          .gamma = kStableGammas[0]};
  const Equilibrium stuck = solver.solve(contact);
  if (stuck.outcome != Outcome::kSettled || stuck.open_but_held_count > 0) {
    return {};
  }
  return find_slip(here.robot, stuck) ? solver.let_slip(stuck, contact)
                                      : std::vector<Equilibrium>{stuck};
}

/// Puts the equilibrium by Coulomb's law in place of one whose feet carry more sideways than their
/// friction. Returns further ones that have to agree: that in which feet that slip turn freely,
/// where they would not; and those by the exact law where open facets may pull. Nothing is changed
/// where slips are not known by all of them, or the robot would not stand by the model.
std::vector<Equilibrium> let_slip(const Situation& here, solver::EquilibriumSolver& solver,
                                  Assessment& assessment) {
  Equilibrium& found = assessment.equilibrium;
  const bool is_exact_law = found.law == ContactLaw::kUnilateral;
  auto slid = solver.let_slip(
      found, {.law = found.law,
              .gamma = is_exact_law ? kStableGammas[0] : here.robot.material().contact_gamma});
  if (!do_hold(here, slid)) {
    return {};
  }
  if (!here.is_on_flat_floor && !is_exact_law &&
      !std::ranges::all_of(slid, solver::are_all_stuck)) {
    const auto exact = slid_by_exact_law(here, solver);
    if (!do_hold(here, exact)) {
      return {};
    }
    slid.insert(slid.end(), exact.begin(), exact.end());
  }
  slid.front().begin_with(found);
  found = std::move(slid.front());
  assessment.model = model_stability(here, found);
  slid.erase(slid.begin());
  return slid;
}

/// Takes another equilibrium's largest load ratio into the range, which is as far off.
void widen_by(const model::Robot& robot, const Equilibrium& other, Assessment& assessment) {
  if (!assessment.load_ratio_max) {
    return;
  }
  LoadRange& range = assessment.load_ratio_range;
  const double ratio = load_ratio_max(robot, other.displacement, other.displacement_low);
  const double margin =
      std::max(*assessment.load_ratio_max - range.low, range.high - *assessment.load_ratio_max);
  range.low = ratio - margin < range.low || std::isnan(ratio) ? ratio - margin : range.low;
  range.high = ratio + margin > range.high || std::isnan(ratio) ? ratio + margin : range.high;
}

/// The equilibrium, its loads, and what there is beside it. Loads come before others are sought, as
/// then the second answer need not wait.
void solve(const Situation& here, const solver::EquilibriumOptions& asked, Assessment& assessment) {
  solver::EquilibriumOptions options = asked;
  options.second_order = second_order_wish(here.robot, asked.second_order);
  solver::EquilibriumSolver solver(here.robot, options);
  find_equilibrium(here, solver, options.is_bonded, assessment);
  if (assessment.equilibrium.outcome != Outcome::kSettled) {
    return;
  }
  const auto further = may_let_slip(here, assessment, options.is_bonded)
                           ? let_slip(here, solver, assessment)
                           : std::vector<Equilibrium>();
  const LoadRange answers = assess_loads(here, options, assessment);
  for (const Equilibrium& other : further) {
    widen_by(here.robot, other, assessment);
  }
  if (stands_by_paper(assessment) && assessment.equilibrium.slip.empty()) {
    look_beside(here, solver, options, answers, assessment);
  }
  const bool is_by_multigrid = assessment.equilibrium.method == solver::Method::kMultigrid;
  const auto left_out =
      is_by_multigrid ? solver::SecondOrderWish::kBesideFactors : solver::SecondOrderWish::kNothing;
  if (assessment.is_stable && options.second_order > left_out) {
    assessment.second_order =
        check_second_order(here, solver, kStableGammas[0], options, assessment);
  }
}

/// Finds connections, verdict and reasons, once there are an equilibrium and its loads.
void conclude(const Situation& here, int thread_count, Assessment& assessment) {
  if (assessment.equilibrium.outcome == Outcome::kSettled) {
    assess_connections(here.robot, thread_count, assessment);
    assessment.gaps = find_open_gaps(here.robot, assessment.equilibrium);
    assessment.lean = find_lean(here.robot, assessment);
  }
  decide(here, assessment);
}

/// All that follows what the rigid body says, `assessment`.
Assessment go_on(const Situation& here, const solver::EquilibriumOptions& options,
                 Assessment assessment) {
  const bool is_small = here.robot.modules().size() <= kTopplingCountMax &&
                        options.method != solver::Method::kMultigrid;
  if (assessment.is_stable || is_small) {
    solve(here, options, assessment);
  } else {
    assessment.equilibrium.outcome = Outcome::kNotSought;
  }
  conclude(here, options.thread_count, assessment);
  return assessment;
}

/// Whether an error no larger than what the range allows for would decide.
bool is_near_limit(const Assessment& assessment) {
  return assessment.is_stable && assessment.equilibrium.outcome == Outcome::kSettled &&
         assessment.equilibrium.open_but_held_count == 0 &&
         (breaks(assessment.load_ratio_range.low) != breaks(assessment.load_ratio_range.high) ||
          (assessment.several &&
           !do_agree(*assessment.several, breaks(assessment.load_ratio_range.low))));
}

/// The options for seeking a verdict again that depends on the error: the direct solver with all
/// digits, or where that does not fit multigrid with more of them; for large robots the other way
/// round.
std::vector<solver::EquilibriumOptions> finer_options(const Situation& here,
                                                      const solver::EquilibriumOptions& options) {
  std::vector<solver::EquilibriumOptions> list;
  const bool is_large = here.module_count > kPreciseCountMax;
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
  return has_pulling_facets(Situation(robot), assessment.equilibrium);
}

Assessment assess_rigidly(const model::Robot& robot, bool has_figures) {
  return look_at_rigid_body(Situation(robot), has_figures);
}

Assessment assess(const model::Robot& robot, const solver::EquilibriumOptions& options) {
  if (!robot.pieces().empty()) {
    return assess_pieces(robot, options);
  }
  const Situation here(robot);
  Assessment start = look_at_rigid_body(here, options.has_rigid_figures);
  start.is_stable = start.is_stable || options.is_bonded;
  Assessment assessment = go_on(here, options, start);
  if (!is_near_limit(assessment)) {
    return assessment;
  }
  const std::vector<solver::EquilibriumOptions> all_finer = finer_options(here, options);
  const solver::EquilibriumOptions* known = &options;  // What `assessment` was found with.
  bool is_whole = true;
  for (const solver::EquilibriumOptions& finer : all_finer) {
    // Their memory is needed elsewhere, and they can be had again.
    assessment.connections = std::vector<ConnectionResult>();
    assessment.equilibrium.displacement = std::vector<base::Vec6<double>>();
    is_whole = false;
    Assessment next = go_on(here, finer, start);
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
  return is_whole ? std::move(assessment) : go_on(here, *known, std::move(start));
}

Assessment assess_equilibrium(const model::Robot& robot, Equilibrium equilibrium,
                              int thread_count) {
  const Situation here(robot);
  Assessment assessment = look_at_rigid_body(here, true);
  assessment.equilibrium = std::move(equilibrium);
  assessment.model = model_stability(here, assessment.equilibrium);
  assessment.contact_model = !here.has_contact ? ContactModel::kNone
                             : assessment.equilibrium.law == ContactLaw::kUnilateral
                                 ? ContactModel::kUnilateral
                                 : ContactModel::kRegularised;
  if (assessment.equilibrium.outcome == Outcome::kSettled) {
    assess_loads(here, {.thread_count = thread_count}, assessment);
  }
  conclude(here, thread_count, assessment);
  return assessment;
}

int severity(Verdict verdict) {
  constexpr std::array kSeverities = {0, 2, 3, 1};  // Safe, overload, unstable, undecided.
  return kSeverities[static_cast<std::size_t>(verdict)];
}

const char* name(Verdict verdict) {
  constexpr std::array kNames = {"safe", "overload", "unstable", "undecided"};
  return kNames[static_cast<std::size_t>(verdict)];
}

const char* name(ContactModel model) {
  constexpr std::array kNames = {"none", "bonded", "regularised", "unilateral"};
  return kNames[static_cast<std::size_t>(model)];
}

}  // namespace holdfast::verdict
