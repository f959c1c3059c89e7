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

}  // namespace holdfast::agent
