// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "watch.hpp"

namespace holdfast::agent {

Time Agent::watch_time() const {
  return setup_.timing.ping_after + lost_after(setup_.timing) + 2 * Time{wave_time_};
}

/// Something of this module's round has come, or it has begun.
void Agent::keep_waiting() {
  if (answer_.verdict == Verdict::kNone && messages_heard_ < watch::kMessagesMax) {
    ++messages_heard_;
    const Time silence = watch::silence(setup_.timing);
    watch_at_ = now_ + (phase_ <= Phase::kTree ? watch::kWaveSilences * silence
                                               : silence + watch::kWavesPerSilence * wave_time_);
  }
}

/// What was true of the robot is so no longer.
void Agent::forget_answer() {
  answer_ = {};
  messages_heard_ = 0;
  orders_heard_ = 0;
  if (rounds_without_end_ == watch::kRoundsWithoutEndMax) {
    answer_ = {.verdict = Verdict::kUndecided, .reason = Reason::kNoAnswer};
  }
  keep_waiting();
}

/// An order has come. One that says the verdict again leaves the phase as it is.
void Agent::begin_waiting() {
  if (phase_ <= Phase::kTree) {
    wave_time_ = static_cast<std::uint32_t>(now_) - wave_time_;
  }
  const bool is_verdict = order_.operation == wire::Operation::kVerdict;
  if (!is_verdict || phase_ != Phase::kDone) {
    phase_ = phase_of(order_.operation);
  }
  if (is_verdict) {
    rounds_without_end_ = 0;
    watch_at_ = now_ + watch_time();
  } else if (orders_heard_ < watch::kOrdersMax) {
    ++orders_heard_;
    messages_heard_ = 0;
    keep_waiting();
  }
}

/// The sweep of a verdict is over here.
void Agent::watch_verdict() {
  phase_ = Phase::kDone;
  touched_ = 0x3f;
  if (order_.answer.verdict == Verdict::kUndecided || (parent_ < 0 && children_ == 0)) {
    watch_at_ = kNever;
  } else if (parent_ < 0) {
    watch_at_ = now_ + setup_.timing.ping_after;
  }
}

/// The clock has run out.
void Agent::end_watch() {
  if (phase_ == Phase::kDone && parent_ < 0 && !is_sweeping_) {
    next_order_ = order_;
    has_next_order_ = true;
    is_busy_ = true;
    watch_at_ = kNever;
    return;
  }
  watch_at_ = kNever;
  touched_ = 0x3f;
  if (answer_.verdict != Verdict::kUndecided) {
    answer_ = {.verdict = Verdict::kUndecided,
               .reason = has_cell_ ? Reason::kNoAnswer : Reason::kNoAnchor};
  }
}

}  // namespace holdfast::agent
