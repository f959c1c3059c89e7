// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>

#include "holdfast/agent/link.hpp"

namespace holdfast::sim {

/// When an agent wants to wake, where calls cannot be taken back: those of which the agent has
/// thought better are recognised when they come.
struct WakeTimer {
  agent::Time wake_at = agent::kNever;
  /// When up to two calls come that are asked for, earlier first. One at another time is out of
  /// date.
  agent::Time call_at = agent::kNever;
  agent::Time call_later_at = agent::kNever;

  /// When to be called, too; kNever if the calls that were asked for will do.
  agent::Time arm(agent::Time now) {
    if (wake_at >= call_at) {
      return agent::kNever;
    }
    call_later_at = call_at;
    call_at = std::max(wake_at, now);
    return call_at;
  }

  /// A call has come. False: it is out of date.
  bool take_call(agent::Time now) {
    if (now != call_at) {
      return false;
    }
    call_at = call_later_at;
    call_later_at = agent::kNever;
    return true;
  }

  bool is_due(agent::Time now) const { return wake_at <= now; }
};

}  // namespace holdfast::sim
