// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "holdfast/agent/conductor/whole.hpp"
#include "holdfast/agent/world/stages.hpp"

namespace holdfast::agent {

/// The root learns of its robot, before an equilibrium: what is planned, who emulates it, how many
/// modules there are, what they weigh, whether the rigid body topples. Orders that it returns are
/// the next ones; kVerdict: with the verdict that this is.
class Learning {
 public:
  /// The first order of a round.
  static Order begin();

  /// The order after kPlan and kForget. Planned cells come one by one, in their order. A plan that
  /// has ended is forgotten by all, and then all begins anew: so every withdrawal goes before every
  /// plan. It is only behind the last plan that a robot with too many or disputed ones gives up: by
  /// then another sweep has gone down than the one that found them, as Announcements::settle()
  /// needs.
  Order after_plan(Whole& whole, const Report& report, const Planned& planned);

  static Order after_hosts(Whole& whole, const Report& report, const Planned& planned);

  /// The order after kMass: kAngles, or no order where an equilibrium is next.
  static Order after_mass(Whole& whole, const Setup& setup, const Report& report);

 private:
  Order forget(Whole& whole, const Report& report);

  std::uint8_t forgotten_count_;
};

/// The next order of a step's words, after kWord: one word after the other, then the first stage.
/// kVerdict: they do not fit.
Order after_word(const Report& report, const Stages& stages);

/// The first word is asked for.
Order first_word();

}  // namespace holdfast::agent
