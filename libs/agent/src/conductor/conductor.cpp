// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "holdfast/agent/conductor/conductor.hpp"

#include "algebra/scalar.hpp"
#include "algebra/tolerances.hpp"
#include "conductor/orders.hpp"
#include "holdfast/agent/conductor/bending.hpp"
#include "holdfast/agent/features.hpp"
#include "messages/resume_masks.hpp"

namespace holdfast::agent {
namespace {

using wire::Operation;

/// Larger robots with many loops begin with the polynomial and take fronts if that makes no
/// progress: a cube of 5 takes 6 sweeps with it, and its fronts are the largest there are.
/// Of many planned modules so many more: condensed, they spoil the polynomial.
constexpr std::uint32_t kFrontModulesMax = 80;

/// Changes of contact states that elimination takes, two sweeps each, until fronts solve contact in
/// one go. Where Newton's method settles it takes five at most, but for one robot in hundreds.
constexpr std::uint32_t kChangesBeforeFronts = 3;

/// Changes of contact states that elimination and the polynomial take from states that are kept,
/// before they begin from rest: a start that is worse than none can go round in circles.
constexpr std::uint32_t kChangesFromKept = 3;
constexpr std::uint32_t kIterationChangesFromKept = 5;

/// Changes of contact states that the polynomial takes. It looks states up at solutions that are
/// not accurate, so it may come to a state that Newton's method would not come to, as it did in one
/// robot of 4,400, after 89; half of them take one at most, 99 % of those that settle 40.
constexpr std::uint32_t kIterationChangesMax = 40;

/// Fronts come first if they are asked for; with memory for them they come behind elimination and
/// the polynomial, from which a robot goes on at its next change. Not for the unilateral law.
void choose_method(const Setup& setup, Whole& whole, Law& law, bool is_newton) {
  Effort& effort = whole.effort;
  const bool is_first = setup.method == Method::kFronts || whole.has_fronts();
  const bool has_memory = kHasAllMethods && whole.may_have_fronts && is_first;
  if (whole.has_many_loops || whole.is_any_remote) {
    const std::uint32_t many = whole.planned_count > kPlannedMax ? whole.planned_count : 0U;
    const bool is_small = effort.module_count <= kFrontModulesMax + many;
    effort.method =
        has_memory && (is_small || whole.has_fronts()) ? Method::kFronts : Method::kPolynomial;
    if (effort.method == Method::kPolynomial && !is_newton) {
      law.limit_changes(effort.contact_iterations + kIterationChangesMax);
    }
  } else if (has_memory && effort.method == Method::kElimination) {
    law.limit_changes(effort.contact_iterations + kChangesBeforeFronts);
  }
}

/// Does a facet slip, or may it?
bool may_slip(const Report& report) { return (report.remarks & kFacetSlips) != 0; }

/// The worst connection, as everybody will know it.
void note_worst(Answer& answer, const Report& report) {
  answer.load_ratio_max = report.worst_load_ratio();
  answer.worst_cell = report.cell;
  answer.worst_direction = report.direction;
  answer.remarks = report.remarks & (kLimitBits | kGapOpens);
}

bool keeps_displacements(Method method) {
  return method == Method::kElimination || method == Method::kPolynomial;
}

}  // namespace

/// All orders leave by this. Before a verdict free faces may be judged; one that is none leaves the
/// last one in force.
Order Conductor::ask(Order order) {
  if (order.operation == Operation::kVerdict) {
    answer.verdict = order.answer.verdict;
    answer.reason = order.answer.reason;
    order = order_of(is_bending_due()                      ? Operation::kBend
                     : faces.is_due(whole, answer.verdict) ? Operation::kShape
                                                           : Operation::kVerdict);
    order.answer = answer;
  }
  asked = order.operation != Operation{} ? order.operation : asked;
  return order;
}

/// Is bending asked about before this verdict? Not again, and not where there is no new
/// equilibrium.
bool Conductor::is_bending_due() const {
  return whole.judges_bending && answer.verdict == Verdict::kSafe && asked != Operation::kBend &&
         asked != Operation::kRenew && asked != Operation::kWord && asked != Operation::kStage;
}

Order Conductor::begin(const Setup& setup, const base::Cell& root, std::uint32_t module_count,
                       std::uint16_t depth, const Lent& lent) {
  *this = Conductor();
  whole.root = root;
  whole.census = module_count;
  whole.depth = depth;
  whole.wave_depth = depth;
  whole.effort.method = setup.method;
  whole.judges_bending = setup.judges_bending;
  // They judge by linear theory.
  faces.enter(lent.judges_faces && !setup.judges_bending);
  iterations.enter(setup, lent.deflation);
  if constexpr (kHasAllMethods) {
    whole.may_have_fronts = lent.has_fronts;
    whole.effort.method =
        setup.method == Method::kFronts ? Method::kElimination : whole.effort.method;
  }
  return ask(Learning::begin());
}

Order Conductor::next(const Setup& setup, const Report& report, const Planned& planned) {
  return ask(choose(setup, report, planned));
}

Order Conductor::choose(const Setup& setup, const Report& report, const Planned& planned) {
  switch (asked) {
    case Operation::kPlan:
    case Operation::kForget:
      return learning.after_plan(whole, report, planned);
    case Operation::kHosts:
      return Learning::after_hosts(whole, report, planned);
    case Operation::kMass:
      return after_mass(setup, report);
    case Operation::kAngles:
      return report.feet.range != mechanics::SafeRange::kFull
                 ? verdict_order(Verdict::kUnstable, Reason::kTopples)
                 : begin_law(setup, false);
    case Operation::kBegin:
    case Operation::kClusters:
      iterations.clusters.choose(whole, report);
      return iterations.first(whole, law, asked);
    case Operation::kFactor:
      return tree_iteration();
    case Operation::kResume:
    case Operation::kResumeDeflated:
      return kKeepsAnswers ? after_resume(report) : Order{};
    case Operation::kClose:
      return !report.corners.stable ? after_corners(setup, false) : conclude(setup, report);
    case Operation::kIterate:
    case Operation::kTreeIterate:
      return after_iteration(setup, report);
    case Operation::kIterateDeflated:
    case Operation::kIterateLast:
      return kKeepsAnswers ? after_iteration(setup, iterations.completed(whole, report)) : Order{};
    case Operation::kHold:
      return after_hold(report);
    case Operation::kCorners:
      return after_corners(setup, report.corners.stable);
    case Operation::kLoads:
      return after_loads(setup, report);
    case Operation::kBend:
      return kIsGeneral ? after_bend(setup, report) : Order{};
    case Operation::kShape:
      if (const Order next = kKeepsAnswers ? faces.after_shape(whole, report, answer.verdict,
                                                               iterations.accuracy.error)
                                           : Order{};
          next.operation != Operation{}) {
        return next;
      }
      break;
    case Operation::kSeek:
      return kHasAllMethods ? follow(setup, seeking.after_seek(whole, report, iterations.newton))
                            : Order{};
    case Operation::kNext:
      break;
    default:
      return undecided(Reason::kNotConverged);
  }
  return verdict_order(answer.verdict, answer.reason);
}

/// The robot is known, or in a later scene of a stage its loads are.
Order Conductor::after_mass(const Setup& setup, const Report& report) {
  if (kKeepsAnswers && whole.is_resumed) {
    if (report.count != whole.census) {
      return undecided(Reason::kNeighbourSilent);
    }
    const Planned none;
    const Order order =
        Renewal::weigh(whole, setup, report, none, nullptr) ? resume(setup) : Order{};
    return order.operation == Operation{} ? undecided(Reason::kTooLarge) : order;
  }
  const Order order = Learning::after_mass(whole, setup, report);
  return order.operation == Operation{} ? begin_law(setup, false) : order;
}

// ---- Equilibrium.

Order Conductor::begin_law(const Setup& setup, bool is_unilateral) {
  const bool is_renewed = asked == Operation::kRenew ||
                          (kKeepsAnswers && whole.is_resumed && asked == Operation::kMass);
  renewal.has_motion = renewal.has_motion && is_renewed;
  renewal.has_factors = renewal.has_factors && is_renewed;
  whole.effort.is_unilateral = is_unilateral;
  iterations.begin(whole, renewal.has_motion);
  law.begin(is_unilateral, whole.effort.contact_iterations);
  seeking.reset();
  // The unilateral law is for what takes its time.
  if (is_unilateral) {
    take_safest_method();
  } else {
    choose_method(setup, whole, law, iterations.newton.is_used);
  }
  law.forget_seen();
  iterations.newton.begin(whole);
  const bool is_polynomial = whole.effort.method == Method::kPolynomial;
  Order begin =
      order_of(iterations.clusters.may_begin(whole) ? Operation::kClusters : Operation::kBegin);
  const bool starts = is_polynomial && !whole.is_any_remote;
  begin.count = starts ? iterations.degree(whole) : std::uint16_t{0};
  begin.flags = static_cast<std::uint8_t>((is_unilateral ? kUnilateralLaw : 0U) | kOneSweep |
                                          (is_polynomial ? kWithIterations : 0U) |
                                          (whole.has_fronts() ? kWithFronts : 0U));
  begin.reals[0] = static_cast<float>(is_unilateral ? law.gamma() : setup.contact_gamma);
  begin.reals[1] = static_cast<float>(static_cast<double>(whole.extent + 1) * setup.section.length);
  return begin;
}

void Conductor::take_safest_method() {
  whole.effort.method = whole.safest_method();
  iterations.newton.is_used = whole.effort.method == Method::kPolynomial;
}

Order Conductor::after_iteration(const Setup& setup, const Report& report) {
  using Outcome = Iterations::Outcome;
  ++whole.effort.iterations;
  law.note(report);
  switch (iterations.judge(setup, whole, report, seeking.tries_each_state())) {
    case Outcome::kSettled:
      return settled(setup, &report);
    case Outcome::kJumped:
      return after_jump(setup, report);
    case Outcome::kOutOfRoom:
      return leave_fronts(setup, true);
    case Outcome::kWithoutState:
      return leave_fronts(setup, false);
    case Outcome::kStagnant:
      // Only displacements that are kept may have led nowhere: then the same from rest.
      return kKeepsAnswers && renewal.has_motion && !seeking.is_active()
                 ? begin_law(setup, false)
                 : leave_one_sweep(setup, false);
    case Outcome::kStuck:
      return leave_one_sweep(setup, false);
    case Outcome::kClustersStuck:
      iterations.clusters.has_left = true;
      return begin_law(setup, false);
    case Outcome::kGoesOn:
      break;
  }
  return iterations.next(whole, law, report);
}

/// Some facets want other states than those in use.
Order Conductor::after_jump(const Setup& setup, const Report& report) {
  Effort& effort = whole.effort;
  ++effort.contact_iterations;
  if (seeking.is_back(law)) {
    return follow(setup, seeking.next_trial());
  }
  if (kKeepsAnswers && renewal.has_motion &&
      effort.contact_iterations >
          (whole.is_exact() ? kChangesFromKept : kIterationChangesFromKept)) {
    return begin_law(setup, false);
  }
  // With fronts a facet that has changed is never asked again.
  const bool is_newton = iterations.newton.is_used;
  const bool is_cycle = !whole.has_fronts() && (iterations.was_accurate() || is_newton) &&
                        law.was_seen(report.states_hash(), seeking.is_by_one_foot());
  if (is_cycle || law.is_beyond(effort.contact_iterations)) {
    // Only exact iterations are certain to go round in circles: others give way to a safer method.
    const bool is_sure = whole.is_exact() || is_newton || whole.is_uneven();
    return leave_one_sweep(setup, is_cycle && is_sure);
  }
  if (iterations.is_beyond_clusters(whole)) {
    iterations.clusters.has_left = true;
    return begin_law(setup, false);
  }
  return iterations.jumped(whole, law, report);
}

/// Fronts that find no room anywhere, or no contact state: the next safer method, the next law.
Order Conductor::leave_fronts(const Setup& setup, bool has_no_room) {
  if (seeking.is_active()) {
    return follow(setup, seeking.leave_trial(whole, has_no_room, iterations.newton));
  }
  if (has_no_room) {
    whole.may_have_fronts = false;
    whole.effort.method = Method::kPolynomial;
    return begin_law(setup, whole.effort.is_unilateral);
  }
  return whole.effort.is_unilateral || seeking.may_hang_by_foot(whole)
             ? leave_one_sweep(setup, true)
             : begin_law(setup, true);
}

/// All gives way to fronts where there is memory for them, else to Newton's method, and that to the
/// next law.
Order Conductor::leave_one_sweep(const Setup& setup, bool is_unilateral) {
  const bool was_unilateral = whole.effort.is_unilateral;
  if (seeking.is_active()) {
    return follow(setup, seeking.leave_trial(whole, !is_unilateral, iterations.newton));
  }
  if (whole.has_fronts() && was_unilateral && law.stiffens_springs(whole)) {
    return begin_law(setup, true);
  }
  if (kHasAllMethods && whole.may_have_fronts && !whole.has_fronts() && !was_unilateral) {
    whole.effort.method = Method::kFronts;
    return begin_law(setup, false);
  }
  if (is_unilateral && seeking.may_hang_by_foot(whole)) {
    return follow(setup,
                  {Seeking::Then::kOrder, seeking.begin_one_foot(whole, law, iterations.newton)});
  }
  if (iterations.newton.is_used) {
    return is_unilateral && !was_unilateral ? begin_law(setup, true) : give_up(setup);
  }
  whole.may_have_fronts = whole.may_have_fronts && !whole.has_fronts();
  take_safest_method();
  return begin_law(setup, is_unilateral);
}

/// The safest method leads nowhere: the next law, or no answer.
Order Conductor::give_up(const Setup& setup) {
  if (whole.effort.iterations > setup.iteration_count_max) {
    return undecided(Reason::kNotConverged);
  }
  if (!whole.effort.is_unilateral) {
    law.give_up();
    return begin_law(setup, true);
  }
  if (law.stiffens_springs(whole)) {
    return begin_law(setup, true);
  }
  const bool is_settled_but_close = iterations.accuracy.error <= kRatioTolerance;
  return undecided(is_settled_but_close ? Reason::kTooClose : Reason::kNotConverged);
}

Order Conductor::settled(const Setup& setup, [[maybe_unused]] const Report* last) {
  const bool is_unilateral = whole.effort.is_unilateral;
  if (!law.is_comparing() && !seeking.is_active()) {
    iterations.end_deflation(whole);
  }
  whole.effort.ratio_error = static_cast<float>(iterations.accuracy.error);
  renewal.has_motion = !is_unilateral;
  renewal.has_factors = renewal.has_motion && whole.effort.method == Method::kElimination;
  if (law.is_comparing()) {
    return whole.may_fall() ? order_of(Operation::kCorners) : decide();
  }
  if (seeking.is_active()) {
    return follow(setup, seeking.after_trial(whole, law, iterations));
  }
  if (seeking.may_begin(whole, law, iterations)) {
    return follow(setup, {Seeking::Then::kOrder, seeking.begin(whole, law, iterations.newton)});
  }
  if (whole.is_fixed && !whole.is_uneven()) {
    // Under the exact law a facet that has let go no longer holds sideways.
    return is_unilateral ? release_open() : order_of(Operation::kLoads);
  }
  if constexpr (kKeepsAnswers) {
    if (last != nullptr && asked == Operation::kIterateLast) {
      const Report worst = worst_of(*last);
      return !worst.corners.stable ? after_corners(setup, false) : conclude(setup, worst);
    }
  }
  return order_of(kKeepsAnswers && whole.is_resumed && !is_unilateral ? Operation::kClose
                                                                      : Operation::kCorners);
}

/// What the search for further solutions wants.
Order Conductor::follow(const Setup& setup, const Seeking::Move& move) {
  using Then = Seeking::Then;
  const bool other_fails = seeking.other_fails();
  switch (move.then) {
    case Then::kOrder:
      renewal.has_motion = renewal.has_motion && move.order.operation != Operation::kSeek;
      return move.order;
    case Then::kFoundAgain:
      return settled(setup);
    case Then::kSolve: {
      law.limit_changes(whole.effort.contact_iterations + Seeking::kChangesOfTrial);
      if (!seeking
               .is_by_one_foot()) {  // Else from states seen in another trial it went the same way.
        law.forget_seen();
      }
      iterations.begin_trial(whole);
      if (seeking.begin_solve(whole)) {
        return factor();
      }
      return whole.has_fronts() ? tree_iteration() : iterations.first(whole, law, asked);
    }
    case Then::kMoreSafely:
      take_safest_method();
      return begin_law(setup, false);
    case Then::kExactLaw:
    case Then::kAnew:
      break;
  }
  const Order begin = begin_law(setup, move.then == Then::kExactLaw);
  seeking.end(other_fails);
  return begin;
}

// ---- The end.

Order Conductor::after_corners(const Setup& setup, bool is_standing) {
  if (seeking.is_active()) {
    return follow(setup, seeking.after_corners(is_standing));
  }
  if (kIsGeneral && law.is_comparing()) {
    // With open feet freed, without which only weak springs may hold the robot.
    return is_standing ? decide() : undecided(Reason::kAmbiguousFeet);
  }
  law.note_standing(is_standing);
  if (!whole.effort.is_unilateral) {
    if (is_standing) {
      return order_of(Operation::kLoads);
    }
    // On a level floor the rigid body stands, so the corners are wrong; else they decide.
    return whole.is_uneven() ? verdict_order(Verdict::kUnstable, Reason::kTopples)
                             : begin_law(setup, true);
  }
  // Whether facets slip is asked of both laws.
  return law.is_second() && setup.has_friction ? order_of(Operation::kLoads) : release_open();
}

/// A verdict by weak springs that may pull is given only if the law without them agrees.
Order Conductor::after_loads(const Setup& setup, const Report& report) {
  if (report.module_count() != whole.effort.module_count) {
    return undecided(Reason::kNeighbourSilent);
  }
  if (law.is_second()) {
    // It counts if no open facet has to let go.
    answer.reason = may_slip(report) ? Reason::kMaySlip : Reason::kNone;
    return release_open();
  }
  return conclude(setup, report);
}

/// The load ratio is known.
Order Conductor::conclude(const Setup& setup, const Report& worst) {
  note_worst(answer, worst);
  if (may_slip(worst)) {
    return undecided(Reason::kMaySlip);
  }
  if (whole.effort.is_unilateral) {
    return law.is_any_held_open() ? law.free_open_feet() : decide();
  }
  if (kHasAllMethods &&
      (seeking.other_fails() || seeking.is_doubted(whole, law, iterations.accuracy.ratio))) {
    return undecided(Reason::kAmbiguousFeet);
  }
  if (law.may_pull()) {
    law.ask_second();
    return begin_law(setup, true);
  }
  return decide();
}

/// Open facets have let go, or none had to.
Order Conductor::after_hold(const Report& report) {
  if (law.is_comparing() || report.count > 0) {
    iterations.begin_again(whole);
    law.forget_seen();
    return whole.has_fronts() ? tree_iteration() : iterations.first(whole, law, asked);
  }
  law.note_held(report.open_held_count());
  if (law.is_second()) {
    if (answer.reason == Reason::kMaySlip) {
      return undecided(Reason::kMaySlip);
    }
    const Order verdict = decide();
    const bool is_final = !law.is_any_held_open() || verdict.answer.verdict == Verdict::kUndecided;
    return is_final ? verdict : law.free_open_feet();
  }
  if (whole.is_uneven() && !law.is_standing()) {
    return verdict_order(Verdict::kUnstable, Reason::kTopples);
  }
  return law.is_toppling() ? undecided(Reason::kNotConverged) : order_of(Operation::kLoads);
}

Order Conductor::decide() {
  const Answer found =
      law.verdict(whole, static_cast<double>(answer.load_ratio_max), iterations.accuracy.ratio,
                  iterations.accuracy.error, seeking.other_fails());
  return verdict_order(found.verdict, found.reason);
}

/// A robot that linear theory calls safe may be undecided.
Order Conductor::after_bend(const Setup& setup, const Report& report) {
  const double ratio = static_cast<double>(answer.load_ratio_max) + iterations.accuracy.error;
  return is_bending_small(setup, whole, report, ratio)
             ? verdict_order(answer.verdict, answer.reason)
             : undecided(Reason::kSecondOrder);
}

// ---- From one verdict to the next.

/// The unilateral law and fronts keep more than displacements, and clusters are found by the order
/// that begins them.
bool Conductor::can_renew(const Setup& setup) const {
  const bool is_decided = answer.verdict != Verdict::kNone && answer.verdict != Verdict::kUndecided;
  return setup.keeps_answers && asked == Operation::kVerdict && is_decided &&
         keeps_displacements(setup.method) && !whole.effort.is_unilateral &&
         !iterations.clusters.has;
}

Order Conductor::renew(const Setup& setup, const News& news, const Planned& planned,
                       const Environment* environment) {
  if ((news.flags & (kIsFulfilled | kIsGrown)) != 0) {
    faces.forget();
  }
  return ask(renewal.begin(whole, setup, news, planned, environment));
}

Order Conductor::after_renew(const Setup& setup, const Report& report, const Planned& planned,
                             const Environment* environment) {
  const Order order = renewal.after_renew(whole, setup, report, planned, environment);
  if (order.operation == Operation::kVerdict) {
    return ask(verdict_order(answer.verdict, answer.reason));
  }
  return ask(order.operation == Operation::kResume ? resume(setup) : order);
}

/// The order that begins an equilibrium, with all that went before it.
Order Conductor::resume(const Setup& setup) {
  Order resume = begin_law(setup, false);
  if (resume.operation != Operation::kBegin || !keeps_displacements(whole.effort.method)) {
    return {};
  }
  const bool is_exact = whole.is_exact();
  const bool deflates = !is_exact && iterations.deflates(whole);
  resume.operation = deflates ? Operation::kResumeDeflated : Operation::kResume;
  // A planned module between others closes a loop.
  renewal.has_factors = renewal.has_factors && whole.effort.method == Method::kElimination;
  resume.flags = static_cast<std::uint8_t>(
      resume.flags | (renewal.has_factors ? kKeepsFactors : 0U) |
      (renewal.has_motion ? kKeepsMotion : 0U) | (whole.is_fixed ? 0U : kRests));
  resume.count = is_exact ? std::uint16_t{0} : iterations.degree(whole);
  resume.index = iterations.place_of_change();
  resume.mass = whole.mass;
  resume.moment = whole.moment;
  resume.masks = resume_masks(whole.totals, face_count(setup));
  law.forget_comparison();
  return resume;
}

Order Conductor::after_resume(const Report& report) {
  if (!is_each_hosted(whole, report)) {
    return undecided(Reason::kPlannedDetached);
  }
  if (!whole.is_fixed && report.feet.range != mechanics::SafeRange::kFull) {
    return verdict_order(Verdict::kUnstable, Reason::kTopples);
  }
  if (!whole.is_exact()) {
    if (asked == Operation::kResumeDeflated) {
      iterations.begin_deflation(report);
    }
    return iterations.first(whole, law, asked);
  }
  ++whole.effort.solves;
  iterations.expect_nothing();
  return tree_iteration();
}

// ---- Stages of a step.

Order Conductor::after_stage(const Setup& setup, const Report& report, const Stages& stages,
                             const Lent& lent) {
  if (asked == Operation::kWord) {
    return ask(after_word(report, stages));
  }
  if (stages.stage() == Stage::kNone) {
    answer = stages.overall();
    return ask(verdict_order(answer.verdict, answer.reason));
  }
  if ((report.flags & kNewLinks) != 0) {
    return {};
  }
  // The next scene, which differs in its loads, starts from the displacements of the last one.
  const bool can_resume = setup.keeps_answers && keeps_displacements(setup.method) &&
                          keeps_displacements(whole.effort.method) && renewal.has_motion &&
                          !whole.effort.is_unilateral && !iterations.clusters.has &&
                          !iterations.clusters.may_begin(whole);
  if (stages.stage() == Stage::kConnect || !can_resume) {
    const base::Cell root = whole.root;  // Begin() resets the one that is kept.
    return begin(setup, root, whole.census, whole.depth, lent);
  }
  whole.is_resumed = true;
  renewal.has_factors = false;
  Order mass = order_of(Operation::kMass);
  mass.cell = whole.root;
  return ask(mass);
}

Order Conductor::end_scene(const Stages& stages, const Answer& scene) {
  const bool is_over = stages.scene() + 1 >= stages.scene_count(stages.stage());
  const auto here = static_cast<std::uint8_t>(stages.stage());
  Order next = order_of(Operation::kStage);
  next.flags = here;
  next.index = static_cast<std::uint8_t>(!is_over ? here : here == kStageCount ? 0 : here + 1);
  next.count = static_cast<std::uint16_t>(is_over ? 0 : stages.scene() + 1);
  next.answer = scene;
  return ask(next);
}

}  // namespace holdfast::agent
