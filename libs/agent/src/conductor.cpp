// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "holdfast/agent/conductor.hpp"

#include "holdfast/agent/occupied_cells.hpp"
#include "holdfast/mechanics/connector.hpp"
#include "methods.hpp"
#include "scalar.hpp"
#include "tolerances.hpp"

namespace holdfast::agent {

using wire::Operation;

Order Conductor::ask(Operation operation) {
  asked_ = operation;
  return {.operation = operation};
}

Order Conductor::begin(const Setup& setup, const base::Cell& root, std::uint32_t module_count,
                       std::uint16_t depth, const Lent& lent) {
  *this = Conductor();
  root_ = root;
  census_ = module_count;
  depth_ = depth;
  wave_depth_ = depth;
  effort_.method = setup.method;
  judges_faces_ = kJudgesFaces && lent.judges_faces;
  has_left_clusters_ = setup.only_one_sweep || !setup.is_cubic();
  deflation_ = lent.deflation;
#ifndef HOLDFAST_AGENT_FLOOR_ONLY
  slack_bits_ = setup.slack_bits;
#endif
  if constexpr (kHasAllMethods) {
    may_have_fronts_ = lent.has_fronts;
    effort_.method = setup.method == Method::kFronts ? Method::kElimination : setup.method;
  }
  Order first = ask(Operation::kPlan);
  first.index = kNoPlanned;
  return first;
}

Order Conductor::next(const Setup& setup, const Report& report, const Planned& planned) {
  switch (asked_) {
    case Operation::kPlan:
    case Operation::kForget:
      return after_plan(report, planned);
    case Operation::kHosts:
      return after_hosts(report, planned);
    case Operation::kMass:
      return after_mass(setup, report);
    case Operation::kAngles:
      return after_angles(setup, report);
    case Operation::kBegin:
    case Operation::kClusters:
      choose_clusters(report);
      return first_iteration();
    case Operation::kFactor:
      return tree_iteration();
    case Operation::kResume:
    case Operation::kResumeDeflated:
    case Operation::kClose:
      if constexpr (kKeepsAnswers) {
        return asked_ != Operation::kClose ? after_resume(report) : after_close(setup, report);
      }
      break;
    case Operation::kIterate:
    case Operation::kTreeIterate:
      return after_iteration(setup, report);
    case Operation::kIterateDeflated:
    case Operation::kIterateLast:
      return kKeepsAnswers ? after_iteration(setup, completed(report)) : say_answer();
    case Operation::kHold:
      return after_hold(report);
    case Operation::kCorners:
      return after_corners(setup, report);
    case Operation::kLoads:
      return after_loads(setup, report);
    case Operation::kShape:
      return kJudgesFaces ? after_shape(report) : say_answer();
    case Operation::kNext:
      return say_answer();
    case Operation::kSeek:
      return kSeeksOthers ? after_seek(setup, report) : say_answer();
    default:
      break;
  }
  return finish(Verdict::kUndecided, Reason::kNotConverged);
}

// ---- Planned modules, mass, rigid body.

/// One planned cell after the other, by their order. A plan that has ended is forgotten by all, and
/// then all begins anew: so every withdrawal goes before every plan. It is only behind the last
/// plan that a robot with too many or disputed ones gives up: by then another sweep has gone down
/// than the one that found them, as Announcements::settle() needs.
Order Conductor::after_plan(const Report& report, const Planned& planned) {
  if ((report.flags & kEnded) != 0) {
    return forget(report);
  }
  if (planned_count_ > planned.capacity()) {
    return finish(Verdict::kUndecided, Reason::kPlannedTooMany);
  }
  if (planned_count_ > 0 && (!kPlansMany || planned_count_ <= kMasksOfPart)) {
    totals_[planned_count_ - 1U] = report.mask;
  }
  if ((report.flags & kFound) != 0) {
    // One too many is asked for, too: it may be one that has ended.
    Order plan = ask(Operation::kPlan);
    plan.index = planned_count_++;
    plan.cell = report.cell;
    return plan;
  }
  if ((report.flags & (kTooManyAnnounced | kDisputed)) != 0) {
    return finish(Verdict::kUndecided, (report.flags & kDisputed) != 0 ? Reason::kPlanDisputed
                                                                       : Reason::kPlannedTooMany);
  }
  if (kJudgesStages && (report.flags & kStepTold) != 0) {
    return ask_word(kNoWord, {.number = bits_of({.kind = StepWord::Kind::kAttach})});
  }
  return ask_hosts(planned);
}

/// Of many planned modules the masks go down in parts. `planned` has those of the later ones.
Order Conductor::ask_hosts([[maybe_unused]] const Planned& planned) {
  Order hosts = ask(Operation::kHosts);
  hosts.masks = totals_;
#ifndef HOLDFAST_AGENT_FLOOR_ONLY
  if (planned_count_ > kMasksOfPart) {
    const int first = planned.parts_here() * kMasksOfPart;
    hosts.index = static_cast<std::uint8_t>(planned.parts_here());
    for (std::size_t i = 0; i < hosts.masks.size(); ++i) {
      const int k = first + static_cast<int>(i);
      hosts.masks[i] = k < planned.count() ? planned.touching(k).mask() : FaceMask{0};
    }
  }
#endif
  return hosts;
}

Order Conductor::forget(const Report& report) {
  if (forgotten_count_++ == kForgottenMax) {
    return finish(Verdict::kUndecided, Reason::kNotConverged);
  }
  planned_count_ = 0;
  totals_ = {};
  Order forget = ask(Operation::kForget);
  forget.cell = report.cell;
  forget.flags = (report.flags & kFulfilled) != 0 ? kIsFulfilled : std::uint8_t{0};
  return forget;
}

Order Conductor::after_hosts(const Report& report, [[maybe_unused]] const Planned& planned) {
#ifndef HOLDFAST_AGENT_FLOOR_ONLY
  if (!planned.has_all_parts()) {
    return ask_hosts(planned);
  }
#endif
  is_any_remote_ = (report.mask & kAnyRemote) != 0;
  if (!is_all_hosted(report, planned)) {
    return finish(Verdict::kUndecided, Reason::kPlannedDetached);
  }
  Order mass = ask(Operation::kMass);
  mass.cell = root_;
  return mass;
}

/// Does somebody emulate every planned module? Reports have room for few; of many the root knows
/// it.
bool Conductor::is_all_hosted(const Report& report, [[maybe_unused]] const Planned& planned) const {
#ifndef HOLDFAST_AGENT_FLOOR_ONLY
  if (planned_count_ > kPlannedMax) {
    return !planned.is_any_detached();
  }
#endif
  const unsigned all = (1U << planned_count_) - 1;
  return (report.mask & 0x7fU) == all;
}

namespace {

/// Do loads pull a robot away from the plane of all its supports? But for rounding to units.
bool is_pulled_away(const Setup& setup, const Report& report) {
#ifdef HOLDFAST_AGENT_FLOOR_ONLY
  static_cast<void>(setup);
  static_cast<void>(report);
  return false;
#else
  const auto pressure = static_cast<std::int32_t>(report.mass());
  return setup.has_plane && (report.flags & kSumOverflow) == 0 &&
         pressure < -static_cast<std::int64_t>(report.count);
#endif
}

/// In a plane of supports; what does not fit there is left to the equilibrium.
bool fits_plane_check(const Setup& setup, const Report& report, std::uint16_t extent) {
  constexpr std::int64_t kMost = 0x7fffffff;
  const auto fits = [](std::int64_t moment) { return -kMost <= moment && moment <= kMost; };
  return (report.flags & kSumOverflow) == 0 && fits(report.moment[0]) && fits(report.moment[1]) &&
         fits_plane_check(setup, static_cast<std::int32_t>(report.mass()), report.count, extent);
}

}  // namespace

Order Conductor::after_mass(const Setup& setup, const Report& report) {
  if (kJudgesStages && is_resumed_) {
    return resume_stage(setup, report);
  }
  if (report.count != census_ + planned_count_) {
    return finish(Verdict::kUndecided, Reason::kNeighbourSilent);
  }
  effort_.module_count = report.count;
  is_fixed_ = (report.flags & kAnyFixed) != 0;
  is_uneven_ = (report.flags & kUneven) != 0;
  extent_ = report.extent;
  has_many_loops_ = (report.flags & kManyLoops) != 0;
  if (extent_ > kExtentMax || depth_ > kExtentMax) {
    return finish(Verdict::kUndecided, Reason::kTooLarge);
  }
  if (is_uneven() && !is_fixed_ && is_pulled_away(setup, report)) {
    return finish(Verdict::kUnstable, Reason::kTopples);
  }
  if (is_fixed_ || (is_uneven() && !fits_plane_check(setup, report, extent_))) {
    return begin_law(setup, false);
  }
  constexpr std::int64_t kMost = 0x7fffffff;
  const auto is_large = [](std::int64_t moment) { return moment < -kMost || moment > kMost; };
  const auto [x, y, z] = report.moment;
  if ((report.flags & kSumOverflow) != 0 || is_large(x) || is_large(y) ||
      !fits_exact_check(setup, report.mass())) {
    return finish(Verdict::kUndecided, Reason::kTooLarge);
  }
  Order angles = ask(Operation::kAngles);
  angles.cell = root_;
  angles.mass = static_cast<std::int32_t>(report.mass());
  angles.moment = {static_cast<std::int32_t>(x), static_cast<std::int32_t>(y)};
  return angles;
}

Order Conductor::after_angles(const Setup& setup, const Report& report) {
  if (report.feet.range != mechanics::SafeRange::kFull) {
    return finish(Verdict::kUnstable, Reason::kTopples);
  }
  return begin_law(setup, false);
}

// ---- Equilibrium.

Order Conductor::begin_law(const Setup& setup, bool is_unilateral) {
  const bool is_renewed =
      asked_ == Operation::kRenew || (kJudgesStages && is_resumed_ && asked_ == Operation::kMass);
  has_motion_ = has_motion_ && is_renewed;
  has_factors_ = has_factors_ && is_renewed;
  if (kKeepsAnswers && deflation_ != nullptr && !has_motion_) {
    deflation_->forget();
  }
  is_unilateral_ = is_unilateral;
  if (kHasSurroundings && !is_unilateral) {
    has_given_up_ = false;
    is_second_ = false;
    weak_springs_ = WeakSprings::kWeakest;
  }
  effort_.is_unilateral = is_unilateral;
  is_tilting_ = false;
  contact_iterations_max_ = effort_.contact_iterations + kContactIterationsMax;
  stagnation_count_ = 0;
  error_ = kUnbounded;
  error_best_ = kUnbounded;
  target_ = is_fixed_ ? kRatioTolerance : kStateTolerance;
  kept_states_ = false;
  may_differ_ = false;
  if constexpr (kSeeksOthers) {
    seeking_ = Seeking::kNotYet;
    other_fails_ = false;
    is_by_one_foot_ = false;
    tries_each_state_ = false;
    foot_count_ = 0;
  }
  choose_one_sweep(setup, is_unilateral);
  had_clusters_ = false;
  Order begin = ask(may_have_clusters() ? Operation::kClusters : Operation::kBegin);
  const bool starts = effort_.method == Method::kPolynomial && !is_any_remote_;
  begin.count = starts ? iteration_degree() : std::uint16_t{0};
  begin_states();
  begin.flags =
      static_cast<std::uint8_t>((is_unilateral ? kUnilateralLaw : 0U) | kOneSweep |
                                (effort_.method == Method::kPolynomial ? kWithIterations : 0U) |
                                (has_fronts() ? kWithFronts : 0U));
  begin.reals[0] = static_cast<float>(is_unilateral ? unilateral_gamma() : setup.contact_gamma);
  begin.reals[1] = static_cast<float>(static_cast<double>(extent_ + 1) * setup.section.length);
  return begin;
}

/// What a residual's report says of contact.
void Conductor::note_facets(const Report& report) {
  is_tilting_ = (report.flags & kAnyTilting) != 0;
  may_pull_ = (report.flags & kMayPull) != 0;
  if constexpr (kKeepsAnswers) {
    is_spoiled_ = is_spoiled_ || report.changed_count() > 0;
  }
  may_differ_ = (report.flags & kMayDiffer) != 0;
  if constexpr (kSeeksOthers) {
    states_hash_ = report.states_hash();
  }
}

/// The present way leads nowhere: the next safer method, the next law, or no answer.
Order Conductor::give_up(const Setup& setup) {
  if (is_seeking()) {
    return leave_trial(setup, true);
  }
  if (effort_.iterations > setup.iteration_count_max) {
    return finish(Verdict::kUndecided, Reason::kNotConverged);
  }
  if (!is_unilateral_) {
    has_given_up_ = true;
    return begin_law(setup, true);
  }
  if (stiffens_springs()) {
    return begin_law(setup, true);
  }
  const bool is_settled_but_close = error_ <= kRatioTolerance;
  return finish(Verdict::kUndecided,
                is_settled_but_close ? Reason::kTooClose : Reason::kNotConverged);
}

/// The next stiffer weak springs of the unilateral law; false: there are none.
bool Conductor::stiffens_springs() {
  const bool is_weakest = weak_springs_ == WeakSprings::kWeakest;
  const bool may_topple = weak_springs_ == WeakSprings::kStiffer && !is_fixed_ && !is_second_;
  if (!is_uneven() || !(is_weakest || may_topple)) {
    return false;
  }
  weak_springs_ = is_weakest ? WeakSprings::kStiffer : WeakSprings::kToppling;
  is_comparing_ = false;
  return true;
}

/// Those seen last are last. Where it is full the trials of one foot forget what was not seen for
/// the longest time, so that states to which many trials come are kept.
bool Conductor::was_seen(std::uint32_t hash) {
  std::uint8_t place = 0;
  while (place < seen_count_ && seen_[place] != hash) {
    ++place;
  }
  const bool is_new = place == seen_count_;
  if (is_new && seen_count_ == kSeenMax) {
    if (!is_by_one_foot()) {
      return true;
    }
    place = 0;
  } else if (is_new) {
    ++seen_count_;
  }
  for (; place + 1U < seen_count_; ++place) {
    seen_[place] = seen_[place + 1U];
  }
  seen_[place] = hash;
  return !is_new;
}

// ---- The end.

namespace {

/// Do supports hold by friction, so that forces say whether they slip?
bool has_friction([[maybe_unused]] const Setup& setup) {
#ifdef HOLDFAST_AGENT_FLOOR_ONLY
  return false;
#else
  return setup.has_friction;
#endif
}

}  // namespace

Order Conductor::after_corners(const Setup& setup, const Report& report) {
  if (is_seeking() || (kHasSurroundings && is_comparing_)) {
    return after_corners_otherwise(setup, report.corners.stable);
  }
  is_standing_ = report.corners.stable;
  if (!is_unilateral_) {
    if (is_standing_) {
      return ask(Operation::kLoads);
    }
    // On a level floor the rigid body stands, so the corners are wrong; else they decide.
    return is_uneven() ? finish(Verdict::kUnstable, Reason::kTopples) : begin_unilateral(setup);
  }
  // Whether facets slip is asked of both laws.
  if (kHasSurroundings && is_second_ && has_friction(setup)) {
    return ask(Operation::kLoads);
  }
  Order hold = ask(Operation::kHold);
  hold.flags = kReleaseOpen;
  return hold;
}

/// The law that has an answer for every robot.
Order Conductor::begin_unilateral(const Setup& setup) {
  take_safest_method();
  return begin_law(setup, true);
}

/// The worst connection, as everybody will know it.
void Conductor::note_worst(const Report& report) {
  answer_.load_ratio_max = report.worst_load_ratio();
  answer_.worst_cell = report.cell;
  answer_.worst_direction = report.direction;
#ifndef HOLDFAST_AGENT_FLOOR_ONLY
  answer_.remarks = report.remarks & (kLimitBits | kGapOpens);
#endif
}

/// A verdict by weak springs that may pull is given only if the law without them agrees.
Order Conductor::after_loads(const Setup& setup, const Report& report) {
  if (report.module_count() != effort_.module_count) {
    return finish(Verdict::kUndecided, Reason::kNeighbourSilent);
  }
  if (kHasSurroundings && is_second_) {
    // It counts if no open facet has to let go.
    answer_.reason = may_slip(report) ? Reason::kMaySlip : Reason::kNone;
    Order hold = ask(Operation::kHold);
    hold.flags = kReleaseOpen;
    return hold;
  }
  note_worst(report);
  if (may_slip(report)) {
    return finish(Verdict::kUndecided, Reason::kMaySlip);
  }
  if (!is_unilateral_) {
    return conclude(setup);
  }
  return open_held_count_ == 0 ? decide() : free_open_feet();
}

Order Conductor::free_open_feet() {
  is_comparing_ = true;
  Order hold = ask(Operation::kHold);
  hold.flags = kFreeOpen;
  return hold;
}

Order Conductor::decide() {
  const auto first = static_cast<double>(answer_.load_ratio_max);
  const bool breaks = mechanics::breaks(first);
  const double springs = is_unilateral_ ? kRatioPerGamma * unilateral_gamma() : 0;
  const double least = springs * (1 + absolute(ratio_));
  const double doubt = (error_ > kErrorLeast ? error_ : kErrorLeast) + least;
  // Away from a level floor the robot may fall by the law that was given up.
  if (!is_number(first) || !is_number(ratio_) || (is_uneven() && has_given_up_)) {
    return finish(Verdict::kUndecided, Reason::kNotConverged);
  }
  if (absolute(ratio_ - 1) <= doubt) {
    return finish(Verdict::kUndecided, Reason::kTooClose);
  }
  const bool falls = kHasSurroundings && (other_fails_ || (is_second_ && !is_standing_));
  if (mechanics::breaks(ratio_) != breaks || (falls && !breaks)) {
    return finish(Verdict::kUndecided, Reason::kAmbiguousFeet);
  }
  return finish(breaks ? Verdict::kOverload : Verdict::kSafe,
                breaks ? Reason::kBreaks : Reason::kHolds);
}

Order Conductor::finish(Verdict verdict, Reason reason) {
  answer_.verdict = verdict;
  answer_.reason = reason;
  const bool judges = kJudgesFaces && judges_faces_ && !has_judged_ && planned_count_ == 0 &&
                      verdict != Verdict::kUndecided;
  return judges ? ask(Operation::kShape) : say_answer();
}

/// Every free face is judged before the verdict is said, once for every robot.
Order Conductor::after_shape(const Report& report) {
  has_judged_ = true;
  if (!OccupiedCells::fits(report.cell, report.far_cell()) || report.count > 0xffffU) {
    return say_answer();
  }
  Order next = ask(Operation::kNext);
  const bool has_forces = answer_.verdict != Verdict::kUnstable;
  next.flags =
      static_cast<std::uint8_t>((is_fixed_ ? kIsHeld : 0U) | (has_forces ? kHasForces : 0U) |
                                (is_unilateral_ ? kIsUnilateral : 0U));
  next.cell = report.cell;
  next.set_far_cell(report.far_cell());
  next.count = static_cast<std::uint16_t>(report.count);
  const double doubt = error_ > kErrorLeast ? error_ : kErrorLeast;
  // The only foot of a robot that stands presses all over, whatever it carries.
  const bool is_one_foot = report.count == 1 && report.facet_margin() > 0;
  next.reals = {static_cast<float>(has_forces ? doubt + kFaceTolerance : 0), report.ratio_below(),
                is_one_foot ? kNoFacetMargin : report.facet_margin()};
  return next;
}

Order Conductor::say_answer() {
  Order last = ask(Operation::kVerdict);
  last.answer = answer_;
  return last;
}

}  // namespace holdfast::agent
