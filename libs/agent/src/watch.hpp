// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "bits.hpp"
#include "holdfast/agent/agent.hpp"
#include "holdfast/agent/order.hpp"
#include "sweep.hpp"

/// The one clock of a module that ends every wait. When it runs out the module says `undecided`;
/// nothing else changes, so that a clock that was too short does no harm: what comes later counts
/// as if it had come in time.
///
///   before the first round     from the start: nobody has said where this module is
///   waves, waiting for others  from the last message of the round, kWaveSilences long
///   sweeps                     from the last message of the round, silence + kWavesPerSilence W
///   with a verdict             from the root's last order, watch_time()
///
/// W is how long the waves took here, from the first join to the first order. They cross the robot
/// at least three times, so no order is under way much longer on a sound robot, however large and
/// noisy it is. The root says its verdict again `ping_after` after all have reported it (no other
/// module need know why); a robot that is `undecided` already is not watched.
///
/// What ends how, after a verdict:
/// - A module is dead: its parent's link is lost, which starts a new round as ever; who is cut off
///   by it hears no order any more.
/// - A link of the tree is cut: the same, on both sides of it.
/// - A module hangs, and its link still acknowledges: it hands on no order, so the modules below
///   hear none; it reports nothing, so the root gives none.
namespace holdfast::agent {

namespace watch {

/// Silence in a round that no sound neighbour needs: 38 s on Blinky Blocks 1. More than a link's
/// last retry, with time to spare for several of them one behind the other.
constexpr Time silence(const LinkTiming& timing) {
  return 16 * (timing.ping_after + 8 * timing.retransmit_after);
}

/// Nothing is known of the robot's size before it has a tree: 2.6 minutes on Blinky Blocks 1, in
/// which waves cross 3,000 modules in a row and come back. A longer robot is `undecided` meanwhile.
inline constexpr Time kWaveSilences = 4;

/// An order's way down the tree and back is shorter than the waves' by half, but what it sets off
/// can take twenty times as long in every module: the condensed stiffness of a branch is 54
/// messages and a join is one.
inline constexpr Time kWavesPerSilence = 32;

/// Rounds that begin one after the other without an end, as when a module starts again and again;
/// from then on the module is `undecided` until one ends.
inline constexpr std::uint8_t kRoundsWithoutEndMax = 16;

/// Messages between two orders, and orders of one round, that set the clock anew: more than a sound
/// robot ever needs (kDegreeMax vectors twice through each of six faces; kJacobiCountMax steps an
/// order). A neighbour that talks without end is not waited for without end.
inline constexpr std::uint16_t kMessagesMax = 0xffff;
inline constexpr std::uint16_t kOrdersMax = 0xffff;
static_assert(2 * 6 * kDegreeMax < kMessagesMax);

}  // namespace watch

template <class Real>
Time BasicAgent<Real>::watch_time() const {
  return setup_.timing.ping_after + lost_after(setup_.timing) + 2 * Time{wave_time_};
}

/// Something of this module's round has come, or it has begun.
template <class Real>
void BasicAgent<Real>::keep_waiting() {
  if (answer_.verdict == Verdict::kNone && messages_heard_ < watch::kMessagesMax) {
    ++messages_heard_;
    const Time silence = watch::silence(setup_.timing);
    watch_at_ = now_ + (phase_ <= Phase::kTree ? watch::kWaveSilences * silence
                                               : silence + watch::kWavesPerSilence * wave_time_);
  }
}

/// What was true of the robot is so no longer.
template <class Real>
void BasicAgent<Real>::forget_answer() {
  answer_ = {};
  messages_heard_ = 0;
  orders_heard_ = 0;
  if (rounds_without_end_ == watch::kRoundsWithoutEndMax) {
    answer_ = {.verdict = Verdict::kUndecided, .reason = Reason::kNoAnswer};
  }
  keep_waiting();
}

/// An order has come. One that says the verdict again leaves the phase as it is.
template <class Real>
void BasicAgent<Real>::begin_waiting() {
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
template <class Real>
void BasicAgent<Real>::watch_verdict() {
  phase_ = Phase::kDone;
  touched_ = 0x3f;
  if (order_.answer.verdict == Verdict::kUndecided || (parent_ < 0 && children_ == 0)) {
    watch_at_ = kNever;
  } else if (parent_ < 0) {
    watch_at_ = now_ + setup_.timing.ping_after;
  }
}

/// The clock has run out.
template <class Real>
void BasicAgent<Real>::end_watch() {
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
