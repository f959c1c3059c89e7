// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "holdfast/agent/tree/watch.hpp"

#include "holdfast/agent/features.hpp"

namespace holdfast::agent {
namespace {

/// Silence in a round that no sound neighbour needs: 38 s on Blinky Blocks 1. More than a link's
/// last retry, with time to spare for several of them one behind the other.
constexpr Time silence(const LinkTiming& timing) {
  return 16 * (timing.ping_after + 8 * timing.retransmit_after);
}

/// Nothing is known of the robot's size before it has a tree: 2.6 minutes on Blinky Blocks 1, in
/// which waves cross 3,000 modules in a row and come back. A longer robot is `undecided` meanwhile.
constexpr Time kWaveSilences = 4;

/// An order's way down the tree and back is shorter than the waves' by half, but what it sets off
/// can take twenty times as long in every module: the condensed stiffness of a branch is 54
/// messages and a join is one.
constexpr Time kWavesPerSilence = 32;

/// Waves cross the robot six times, there and back; each hop of a quiet line takes a tenth of
/// `retransmit_after`, and with one packet in ten lost a third. The longest of a module's ways to
/// where waves began is a quarter of the robot's longest way or more: one of those is an end of it,
/// one its middle.
constexpr std::uint32_t kRetriesPerHop = 10;

/// Rounds that begin one after the other without an end, as when a module starts again and again;
/// from then on the module is `undecided` until one ends.
constexpr std::uint8_t kRoundsWithoutEndMax = 16;

/// Messages between two orders, and orders of one round, that set the clock anew: more than a sound
/// robot ever needs (kDegreeMax vectors twice through each of six faces). A neighbour that talks
/// without end is not waited for without end.
constexpr std::uint16_t kMessagesMax = 0xffff;
constexpr std::uint16_t kOrdersMax = 0xffff;
static_assert(2 * 6 * kDegreeMax < kMessagesMax);

}  // namespace

Time Watch::verdict_time(const LinkTiming& timing) const {
  return timing.ping_after + lost_after(timing) + 2 * Time{wave_time_};
}

void Watch::start(const Clock& clock) { at_ = clock.now + silence(clock.timing); }

void Watch::leave_round(const Clock& clock) {
  phase_ = Phase::kDiscovery;
  forget_answer(clock);
}

void Watch::enter_round(const Clock& clock) {
  phase_ = Phase::kCoordinates;
  wave_time_ = static_cast<std::uint32_t>(clock.now);
  rounds_without_end_ = static_cast<std::uint8_t>(
      rounds_without_end_ + (rounds_without_end_ < kRoundsWithoutEndMax ? 1 : 0));
  forget_answer(clock);
}

void Watch::withdraw(const Clock& clock) {
  phase_ = Phase::kMass;
  forget_answer(clock);
  messages_heard_ = kMessagesMax;
  at_ = clock.now + clock.timing.ping_after + 2 * Time{wave_time_};
}

void Watch::forget_answer(const Clock& clock) {
  answer_ = {};
  messages_heard_ = 0;
  orders_heard_ = 0;
  if (rounds_without_end_ == kRoundsWithoutEndMax) {
    answer_ = {.verdict = Verdict::kUndecided, .reason = Reason::kNoAnswer};
  }
  keep_waiting(clock);
}

void Watch::keep_waiting(const Clock& clock) {
  if (answer_.verdict == Verdict::kNone && messages_heard_ < kMessagesMax) {
    ++messages_heard_;
    const Time quiet = silence(clock.timing);
    at_ = clock.now +
          (phase_ <= Phase::kTree ? kWaveSilences * quiet : quiet + kWavesPerSilence * wave_time_);
  }
}

void Watch::set_wave_time(std::uint32_t time, std::uint16_t hops, const LinkTiming& timing) {
  const Time most = kRetriesPerHop * (hops + 1U) * timing.retransmit_after;
  wave_time_ = time < most ? time : static_cast<std::uint32_t>(most);
}

void Watch::begin_order(wire::Operation operation, std::uint16_t hops, const Clock& clock) {
  if (phase_ <= Phase::kTree) {
    set_wave_time(static_cast<std::uint32_t>(clock.now) - wave_time_, hops, clock.timing);
  }
  if (kKeepsAnswers && operation == wire::Operation::kRenew) {
    withdraw(clock);
  }
  const bool is_verdict = operation == wire::Operation::kVerdict;
  if (!is_verdict || phase_ != Phase::kDone) {
    phase_ = phase_of(operation);
  }
  if (is_verdict) {
    rounds_without_end_ = 0;
    at_ = clock.now + verdict_time(clock.timing);
  } else if (orders_heard_ < kOrdersMax) {
    ++orders_heard_;
    messages_heard_ = 0;
    keep_waiting(clock);
  }
}

void Watch::end_verdict(bool is_watched, bool is_root, const Clock& clock) {
  phase_ = Phase::kDone;
  if (!is_watched) {
    at_ = kNever;
  } else if (is_root) {
    at_ = clock.now + clock.timing.ping_after;
  }
}

void Watch::give_up(bool has_cell) {
  at_ = kNever;
  if (answer_.verdict != Verdict::kUndecided) {
    answer_ = {.verdict = Verdict::kUndecided,
               .reason = has_cell ? Reason::kNoAnswer : Reason::kNoAnchor};
  }
}

}  // namespace holdfast::agent
