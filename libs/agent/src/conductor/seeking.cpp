// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "holdfast/agent/conductor/seeking.hpp"

#include "conductor/orders.hpp"
#include "holdfast/agent/features.hpp"
#include "holdfast/mechanics/connector.hpp"

namespace holdfast::agent {
namespace {

using wire::Operation;

/// Trials at most, one of each facet or of each state in which a facet presses alone; a robot with
/// more is not safe. Random robots of up to 60 modules have 11 facets to try on a floor.
constexpr int kTrialsMax = 250;

/// The largest robot of which all states of few facets are tried.
constexpr std::uint32_t kFewModules = 12;

/// A largest load ratio below this is not doubted on a level floor: of 80 further solutions of
/// 7,400 random robots none has more than 1.2 times another's. Elsewhere any is, as one may have
/// 13 times another's.
constexpr double kDoubtedFrom = 0.75;

}  // namespace

void Seeking::reset() {
  if constexpr (kHasAllMethods) {
    stage_ = Stage::kNotYet;
    other_fails_ = false;
    is_by_one_foot_ = false;
    tries_each_state_ = false;
    foot_count_ = 0;
  }
}

void Seeking::end(bool other_fails) {
  stage_ = Stage::kDone;
  other_fails_ = other_fails;
}

bool Seeking::is_active() const {
  return kHasAllMethods && (stage_ == Stage::kTrying || stage_ == Stage::kReturning);
}

bool Seeking::is_by_one_foot() const { return kHasAllMethods && is_by_one_foot_; }

bool Seeking::tries_each_state() const { return kHasAllMethods && tries_each_state_; }

bool Seeking::is_doubted(const Whole& whole, const Law& law, double ratio) const {
  return law.may_differ() && !whole.effort.is_unilateral && stage_ == Stage::kNotYet &&
         (whole.may_fall() || ratio > (whole.is_uneven() ? 0 : kDoubtedFrom)) &&
         !mechanics::breaks(ratio);
}

bool Seeking::may_begin(const Whole& whole, const Law& law, const Iterations& iterations) const {
  return kHasAllMethods && is_doubted(whole, law, iterations.accuracy.ratio) &&
         !iterations.clusters.may_begin(whole);
}

bool Seeking::may_hang_by_foot(const Whole& whole) const {
  return kHasAllMethods && whole.may_fall() && !whole.effort.is_unilateral &&
         stage_ == Stage::kNotYet;
}

bool Seeking::is_back(const Law& law) const {
  return kHasAllMethods && stage_ == Stage::kTrying &&
         (tries_each_state_ || (!is_by_one_foot_ && law.states_hash() == found_hash_));
}

Order Seeking::begin(const Whole& whole, const Law& law, Newton& newton) {
  stage_ = Stage::kTrying;
  found_hash_ = law.states_hash();
  trial_count_ = 0;
  is_trial_lost_ = false;
  was_newton_ = newton.is_used;
  newton.is_used = whole.effort.method == Method::kPolynomial && !whole.is_uneven();
  return seek(0, kRemember);
}

Order Seeking::begin_one_foot(const Whole& whole, const Law& law, Newton& newton) {
  is_by_one_foot_ = true;
  is_front_stale_ = true;
  return begin(whole, law, newton);
}

Order Seeking::seek(std::uint32_t key, std::uint8_t flags) {
  Order order = order_of(Operation::kSeek);
  order.flags = tries_each_state_ ? kEachState : is_by_one_foot_ ? kOneFoot : flags;
  order.mass = static_cast<std::int32_t>(key);
  next_key_ = key;
  return order;
}

Seeking::Move Seeking::after_seek(const Whole& whole, const Report& report, Newton& newton) {
  if (tries_each_state_) {
    return after_given_state(report);
  }
  const bool is_first = next_key_ == 0 && stage_ == Stage::kTrying;
  next_key_ = report.next_key();
  if (is_first && whole.has_fronts() && next_key_ == 0) {
    stage_ = Stage::kDone;
    newton.is_used = was_newton_;
    return {Then::kFoundAgain};
  }
  constexpr std::uint32_t kPressing = mechanics::ContactState::kCodeCount - 1;
  const bool has_few =
      report.count <= kFewFeet * kPressing && whole.effort.module_count <= kFewModules;
  if (is_first && is_by_one_foot_ && has_few && whole.is_exact()) {
    tries_each_state_ = true;
    was_tried_ = false;
    return {Then::kOrder, seek(0)};
  }
  return is_first ? next_trial() : Move{Then::kSolve};
}

bool Seeking::begin_solve(const Whole& whole) {
  foot_ = 0;
  const bool is_stale = whole.has_fronts() && is_by_one_foot_ && is_front_stale_;
  is_front_stale_ = is_front_stale_ && !is_stale;
  return is_stale;
}

/// First facets tell their keys one by one and open, by orders of no state; then all are open.
Seeking::Move Seeking::after_given_state(const Report& report) {
  if ((next_key_ & kStateBits) != 0) {
    return {Then::kOrder, order_of(Operation::kCorners)};
  }
  const std::uint32_t key = report.next_key();
  if (key == 0 || foot_count_ == kFewFeet) {
    other_fails_ = key != 0 || foot_count_ != report.count;  // Two have the same key.
    return {Then::kSolve};
  }
  keys_[foot_count_] = key;
  codes_[foot_count_] = 0;
  ++foot_count_;
  return {Then::kOrder, seek(key)};
}

/// Facets of lesser keys go through their states for each state of those of greater ones, unless
/// the robot stands without them.
Seeking::Move Seeking::next_state() {
  for (; foot_ < foot_count_ && !other_fails_; ++foot_) {
    std::uint8_t& code = codes_[foot_];
    was_tried_ = false;
    if (++code < mechanics::ContactState::kCodeCount) {
      return {Then::kOrder, seek(keys_[foot_] | code)};
    }
    code = 0;
  }
  return {Then::kExactLaw};
}

Seeking::Move Seeking::next_trial() {
  if (tries_each_state_) {
    return next_state();
  }
  other_fails_ = other_fails_ || (next_key_ != 0 && trial_count_ == kTrialsMax);
  const bool has_next = next_key_ != 0 && !other_fails_;
  if (is_by_one_foot_ && !has_next) {
    return {Then::kExactLaw};
  }
  trial_count_ = static_cast<std::uint8_t>(trial_count_ + 1);
  stage_ = has_next ? Stage::kTrying : Stage::kReturning;
  return {Then::kOrder, seek(has_next ? next_key_ : 0)};
}

Seeking::Move Seeking::after_trial(const Whole& whole, const Law& law, Iterations& iterations) {
  const bool is_other = is_by_one_foot_ || law.states_hash() != found_hash_;
  if (tries_each_state_) {
    other_fails_ = true;
    return next_trial();
  }
  if (stage_ == Stage::kTrying) {
    const Accuracy& accuracy = iterations.accuracy;
    other_fails_ = other_fails_ || (is_other && mechanics::breaks(accuracy.ratio + accuracy.error));
    return is_other && whole.may_fall() && !other_fails_
               ? Move{Then::kOrder, order_of(Operation::kCorners)}
               : next_trial();
  }
  if (is_other) {
    return leave_trial(whole, false, iterations.newton);
  }
  iterations.newton.is_used = was_newton_;
  if (seeks_again(whole)) {
    return {Then::kMoreSafely};
  }
  stage_ = Stage::kDone;
  return {Then::kFoundAgain};
}

Seeking::Move Seeking::after_corners(bool is_standing) {
  if (tries_each_state_) {
    return is_standing ? next_trial() : Move{Then::kSolve};
  }
  other_fails_ = !is_standing;
  return next_trial();
}

Seeking::Move Seeking::leave_trial(const Whole& whole, bool is_lost, Newton& newton) {
  if (tries_each_state_ && is_lost && !was_tried_) {
    was_tried_ = true;
    return {Then::kSolve};
  }
  is_trial_lost_ = is_trial_lost_ || is_lost;
  if (stage_ == Stage::kTrying) {
    const bool is_safest = is_by_one_foot_ || whole.effort.method == whole.safest_method();
    other_fails_ = other_fails_ || (is_lost && is_safest);
    return next_trial();
  }
  newton.is_used = was_newton_;
  return {seeks_again(whole) ? Then::kMoreSafely : Then::kAnew};
}

/// A method, on few feet that are nearly open, may converge from rest, but not in a trial.
bool Seeking::seeks_again(const Whole& whole) const {
  return is_trial_lost_ && !other_fails_ && whole.effort.method != whole.safest_method();
}

}  // namespace holdfast::agent
