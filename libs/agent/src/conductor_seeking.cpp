// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
//
// Further solutions of the regularised law, as the exact solver seeks them
// (solver/other_solutions.cpp): a facet that does not press all over, and is pulled sideways by
// more than it presses, may be held where it is open, or let go where it presses. So each is put
// into that state, one at a time, and Newton's method goes on from there. Most go back at once. No
// robot is safe of which another solution breaks a connection or falls.
//
// Where Newton's method settles nowhere, and contact states say whether the robot falls, it is
// those that fall that are sought: who falls hangs by one foot, so each foot is tried as all that
// presses, all over and by each edge and corner. The exact law decides whether what is not found to
// fall is safe. Of few feet all states are gone through in which the feet that press have all their
// corners on one line: a state that the law prescribes for what it leads to falls. Where others
// press the robot stands, and nobody has to solve for it.
#include "holdfast/agent/conductor.hpp"
#include "holdfast/mechanics/connector.hpp"
#include "methods.hpp"
#include "scalar.hpp"
#include "tolerances.hpp"

namespace holdfast::agent {
namespace {

using wire::Operation;

/// Trials at most, one of each facet or of each state in which a facet presses alone; a robot with
/// more is not safe. Random robots of up to 60 modules have 11 facets to try on a floor.
constexpr int kTrialsMax = 250;

/// Changes of contact states in one trial.
constexpr std::uint32_t kChangesOfTrial = 20;

/// Of so many facets all states are tried, as by the exact solver, in a robot of so few modules: a
/// hundred solves, which take larger ones five times as long as trials of one foot.
constexpr std::uint8_t kFewFeet = 3;
constexpr std::uint32_t kFewModules = 12;

/// On a level floor a largest load ratio below this is not doubted: of 80 further solutions of
/// 7,400 random robots none has more than 1.2 times another's. Elsewhere any is, as one may have
/// 13 times another's.
constexpr double kDoubtedFrom = 0.75;

}  // namespace

bool Conductor::is_seeking() const {
  return kSeeksOthers && (seeking_ == Seeking::kTrying || seeking_ == Seeking::kReturning);
}

/// May there be another solution, and has nobody sought it?
bool Conductor::is_doubted() const {
  return may_differ_ && !is_unilateral_ && seeking_ == Seeking::kNotYet &&
         (may_fall() || ratio_ > (is_uneven() ? 0 : kDoubtedFrom)) && !mechanics::breaks(ratio_);
}

/// Clusters of modules keep what would have to be forgotten: robots with them are not safe where
/// they are doubted.
bool Conductor::may_seek() const { return kSeeksOthers && is_doubted() && !may_have_clusters(); }

/// Do contact states say whether it falls?
bool Conductor::may_fall() const { return is_uneven() && !is_fixed_; }

/// States go round in circles. May there be a solution that falls?
bool Conductor::may_hang_by_foot() const {
  return kSeeksOthers && may_fall() && !is_unilateral_ && seeking_ == Seeking::kNotYet;
}

/// Are the states those that were found first, and want to be? Or not those that were tried?
bool Conductor::is_back() const {
  return kSeeksOthers && seeking_ == Seeking::kTrying &&
         (tries_each_state_ || (!is_by_one_foot_ && states_hash_ == found_hash_));
}

bool Conductor::is_by_one_foot() const { return kSeeksOthers && is_by_one_foot_; }

bool Conductor::tries_each_state() const { return kSeeksOthers && tries_each_state_; }

Order Conductor::begin_seeking() {
  seeking_ = Seeking::kTrying;
  found_hash_ = states_hash_;
  trial_count_ = 0;
  is_trial_lost_ = false;
  was_newton_ = is_newton_;
  is_newton_ = effort_.method == Method::kPolynomial && !is_uneven();
  return seek(0, kRemember);
}

Order Conductor::begin_one_foot() {
  is_by_one_foot_ = true;
  is_front_stale_ = true;
  return begin_seeking();
}

Order Conductor::seek(std::uint32_t key, std::uint8_t flags) {
  Order order = ask(Operation::kSeek);
  order.flags = tries_each_state_ ? kEachState : is_by_one_foot_ ? kOneFoot : flags;
  order.mass = static_cast<std::int32_t>(key);
  next_key_ = key;
  has_motion_ = false;
  return order;
}

/// The first report, of what was found, only names the first facet. Where there are fronts it is
/// the first that leads elsewhere, and if there is none nobody has to go back.
Order Conductor::after_seek(const Setup& setup, const Report& report) {
  if (tries_each_state_) {
    return after_given_state(report);
  }
  const bool is_first = next_key_ == 0 && seeking_ == Seeking::kTrying;
  next_key_ = report.next_key();
  if (is_first && has_fronts() && next_key_ == 0) {
    seeking_ = Seeking::kDone;
    is_newton_ = was_newton_;
    return settled(setup);
  }
  constexpr std::uint32_t kPressing = mechanics::ContactState::kCodeCount - 1;
  const bool has_few = report.count <= kFewFeet * kPressing && effort_.module_count <= kFewModules;
  if (is_first && is_by_one_foot_ && has_few && is_exact()) {
    tries_each_state_ = true;
    was_tried_ = false;
    return seek(0);
  }
  return is_first ? next_trial(setup) : try_states();
}

/// From the states that facets have now.
Order Conductor::try_states() {
  foot_ = 0;
  error_ = kUnbounded;
  error_best_ = kUnbounded;
  stagnation_count_ = 0;
  target_ = kRatioTolerance;
  contact_iterations_max_ = effort_.contact_iterations + kChangesOfTrial;
  const std::uint8_t seen_count = seen_count_;
  begin_states();
  // From states that another trial has come to this one would go the same way.
  seen_count_ = is_by_one_foot_ ? seen_count : std::uint8_t{0};
  if (has_fronts() && is_by_one_foot_ && is_front_stale_) {
    is_front_stale_ = false;
    return factor();
  }
  if (has_fronts()) {
    return tree_iteration();
  }
  return first_iteration();
}

/// First facets tell their keys one by one and open, by orders of no state; then all are open.
Order Conductor::after_given_state(const Report& report) {
  if ((next_key_ & kStateBits) != 0) {
    return ask(Operation::kCorners);
  }
  const std::uint32_t key = report.next_key();
  if (key == 0 || foot_count_ == kFewFeet) {
    other_fails_ = key != 0 || foot_count_ != report.count;  // Two have the same key.
    return try_states();
  }
  seen_[foot_count_] = key;
  seen_[kFewFeet + foot_count_] = 0;
  ++foot_count_;
  return seek(key);
}

/// Facets of lesser keys go through their states for each state of those of greater ones, unless
/// the robot stands without them.
Order Conductor::next_state(const Setup& setup) {
  for (; foot_ < foot_count_ && !other_fails_; ++foot_) {
    std::uint32_t& code = seen_[kFewFeet + foot_];
    was_tried_ = false;
    if (++code < mechanics::ContactState::kCodeCount) {
      return seek(seen_[foot_] | code);
    }
    code = 0;
  }
  take_safest_method();
  return begin_anew(setup, true);
}

/// The next facet; behind the last one all go back to what was found.
Order Conductor::next_trial(const Setup& setup) {
  if (tries_each_state_) {
    return next_state(setup);
  }
  other_fails_ = other_fails_ || (next_key_ != 0 && trial_count_ == kTrialsMax);
  const bool has_next = next_key_ != 0 && !other_fails_;
  if (is_by_one_foot_ && !has_next) {
    take_safest_method();
    return begin_anew(setup, true);
  }
  trial_count_ = static_cast<std::uint8_t>(trial_count_ + 1);
  seeking_ = has_next ? Seeking::kTrying : Seeking::kReturning;
  return seek(has_next ? next_key_ : 0);
}

/// A solution: another one, or, in the end, the first one again.
Order Conductor::after_trial(const Setup& setup) {
  const bool is_other = is_by_one_foot_ || states_hash_ != found_hash_;
  if (tries_each_state_) {
    other_fails_ = true;
    return next_trial(setup);
  }
  if (seeking_ == Seeking::kTrying) {
    other_fails_ = other_fails_ || (is_other && mechanics::breaks(ratio_ + error_));
    return is_other && may_fall() && !other_fails_ ? ask(Operation::kCorners) : next_trial(setup);
  }
  if (is_other) {
    return leave_trial(setup, false);
  }
  is_newton_ = was_newton_;
  if (seeks_again()) {
    return seek_more_safely(setup);
  }
  seeking_ = Seeking::kDone;
  return settled(setup);
}

/// Of other states than those of the verdict: those of a trial, or with open feet freed, without
/// which only weak springs may hold the robot.
Order Conductor::after_corners_otherwise(const Setup& setup, bool is_standing) {
  if (!is_seeking()) {
    return is_standing ? decide() : finish(Verdict::kUndecided, Reason::kAmbiguousFeet);
  }
  if (tries_each_state_) {
    return is_standing ? next_trial(setup) : try_states();
  }
  other_fails_ = !is_standing;
  return next_trial(setup);
}

/// A trial whose states go round in circles has no solution. Of one that is lost, as the method did
/// not converge, nobody knows: a safer method tries all again, and behind the safest one the robot
/// is not safe. What was found first is found again from rest. Given states are tried once more
/// from where that has led, as feet that tilt are not solved for by a method that is certain to
/// converge.
Order Conductor::leave_trial(const Setup& setup, bool is_lost) {
  if (tries_each_state_ && is_lost && !was_tried_) {
    was_tried_ = true;
    return try_states();
  }
  is_trial_lost_ = is_trial_lost_ || is_lost;
  if (seeking_ == Seeking::kTrying) {
    other_fails_ = other_fails_ || (is_lost && (is_by_one_foot_ || is_safest_method()));
    return next_trial(setup);
  }
  is_newton_ = was_newton_;
  if (seeks_again()) {
    return seek_more_safely(setup);
  }
  return begin_anew(setup, false);
}

/// From rest, seeking no more.
Order Conductor::begin_anew(const Setup& setup, bool is_unilateral) {
  const bool other_fails = other_fails_;
  const Order begin = begin_law(setup, is_unilateral);
  seeking_ = Seeking::kDone;
  other_fails_ = other_fails;
  return begin;
}

/// On few feet that are nearly open a method may converge from rest, but not in a trial.
bool Conductor::seeks_again() const {
  return kSeeksOthers && is_trial_lost_ && !other_fails_ && !is_safest_method();
}

/// All of it from the beginning.
Order Conductor::seek_more_safely(const Setup& setup) {
  take_safest_method();
  return begin_law(setup, false);
}

/// The load ratio is known, by the regularised law.
Order Conductor::conclude(const Setup& setup) {
  if (kSeeksOthers && (other_fails_ || is_doubted())) {
    return finish(Verdict::kUndecided, Reason::kAmbiguousFeet);
  }
  if (may_pull()) {
    is_second_ = true;
    return begin_unilateral(setup);
  }
  return decide();
}

/// Open facets have let go, or none had to.
Order Conductor::after_hold(const Report& report) {
  if (is_comparing_ || report.count > 0) {
    error_best_ = kUnbounded;
    stagnation_count_ = 0;
    target_ = is_uneven() ? kUnevenTolerance : kRatioTolerance;
    begin_states();
    return has_fronts() ? tree_iteration() : first_iteration();
  }
  open_held_count_ = report.open_held_count();
  if (kHasSurroundings && is_second_) {
    if (answer_.reason == Reason::kMaySlip) {
      return finish(Verdict::kUndecided, Reason::kMaySlip);
    }
    const Order verdict = decide();
    const bool is_final = open_held_count_ == 0 || answer_.verdict == Verdict::kUndecided;
    return is_final ? verdict : free_open_feet();
  }
  if (is_uneven() && !is_standing_) {
    return finish(Verdict::kUnstable, Reason::kTopples);
  }
  if (kHasSurroundings && weak_springs_ == WeakSprings::kToppling) {
    return finish(Verdict::kUndecided, Reason::kNotConverged);
  }
  return ask(Operation::kLoads);
}

}  // namespace holdfast::agent
