// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>

#include "holdfast/agent/wire/link.hpp"

namespace holdfast::sim {

/// Knows when an agent wants to wake, where calls cannot be taken back: a call that the agent no
/// longer wants is recognised when it comes.
struct WakeTimer {
  agent::Time wake_at = agent::kNever;
  /// The times of up to two calls that are asked for, earlier first. A call at another time is out
  /// of date.
  agent::Time call_at = agent::kNever;
  agent::Time call_later_at = agent::kNever;

  /// Returns when to be called besides; kNever if the calls that were asked for suffice.
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
