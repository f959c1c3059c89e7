// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "holdfast/agent/links/links.hpp"
#include "holdfast/agent/messages/order.hpp"
#include "holdfast/agent/wire/operations.hpp"

/// The one clock of a module that ends every wait. When it runs out the module says `undecided`;
/// nothing else changes, so that a clock that was too short does no harm: what comes later counts
/// as if it had come in time. Where a verdict is withdrawn a round begins instead.
///
///   before the first round     from the start: nobody has said where this module is
///   waves, waiting for others  from the last message of the round, kWaveSilences long
///   sweeps                     from the last message of the round, silence + kWavesPerSilence W
///   with a verdict             from the root's last order, watch_time()
///   with a withdrawn one       from its withdrawal, ping_after + 2 W
///
/// W is how long the waves took here, from the first join to the first order. They cross the robot
/// at least three times, so no order is under way much longer on a sound robot, however large and
/// noisy it is. Packets that belong to nobody can hold waves up, and a neighbour can say any W to a
/// module that comes; so W is no more than kRetriesPerHop `retransmit_after` for each hop to where
/// a wave began, of the longest of the three. The root says its verdict again `ping_after` after
/// all have reported it (no other module need know why); a robot that is `undecided` already is not
/// watched.
///
/// What ends how, after a verdict:
/// - A module is dead: its parent's link is lost, which starts a new round as ever; who is cut off
///   by it hears no order any more.
/// - A link of the tree is cut: the same, on both sides of it.
/// - A module hangs, and its link still acknowledges: it hands on no order, so the modules below
///   hear none; it reports nothing, so the root gives none.
namespace holdfast::agent {

/// What a module waits for and how long yet, and the answer that ends its waiting.
class Watch {
 public:
  /// The verdict as far as this module knows it; kNone while it is being worked out.
  const Answer& answer() const { return answer_; }

  Phase phase() const { return phase_; }

  /// When the clock runs out, or when the root says its verdict again; kNever if there is nothing
  /// to wait for.
  Time at() const { return at_; }

  /// How long a verdict stands that the root does not say again.
  Time verdict_time(const LinkTiming& timing) const;

  void start(const Clock& clock);

  /// What was true of the robot is so no longer.
  void leave_round(const Clock& clock);
  void enter_round(const Clock& clock);

  /// The verdict is one no more, the tree stands. The root's answer comes within `ping_after` + 2
  /// W, whatever else is heard: what tells it of the change goes up the tree, waits for one sweep
  /// at most, and the order comes down, a third of what the waves took each.
  void withdraw(const Clock& clock);

  /// How long the waves took, as a module that comes later is told by its parent.
  std::uint32_t wave_time() const { return wave_time_; }

  /// `hops`: to where a wave began, the longest way.
  void set_wave_time(std::uint32_t time, std::uint16_t hops, const LinkTiming& timing);

  void enter_phase(Phase phase) { phase_ = phase; }

  void set_answer(const Answer& answer) { answer_ = answer; }

  /// Something of this module's round has come.
  void keep_waiting(const Clock& clock);

  /// An order has come. One that says the verdict again leaves the phase as it is. `hops` as above.
  void begin_order(wire::Operation operation, std::uint16_t hops, const Clock& clock);

  /// The sweep of a verdict is over here. `is_watched`: it is to be said again.
  void end_verdict(bool is_watched, bool is_root, const Clock& clock);

  /// There is nothing to wait for.
  void stop() { at_ = kNever; }

  /// The clock has run out.
  void give_up(bool has_cell);

 private:
  void forget_answer(const Clock& clock);

  Time at_ = kNever;
  /// How long the waves took; before they are over, when the round began. Modulo 2^32.
  std::uint32_t wave_time_ = 0;
  /// Messages of the round since the last order; they set the clock anew.
  std::uint16_t messages_heard_ = 0;
  std::uint16_t orders_heard_ = 0;  ///< Orders heard in the round.
  std::uint8_t rounds_without_end_ = 0;
  Phase phase_ = Phase::kDiscovery;
  Answer answer_;
};

}  // namespace holdfast::agent
