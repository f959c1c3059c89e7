// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "holdfast/agent/link.hpp"
#include "holdfast/agent/round.hpp"
#include "holdfast/base/cell.hpp"

namespace holdfast::agent {

/// The round that a module takes part in, those that its neighbours talk of, and when it starts a
/// new one itself.
class Rounds {
 public:
  const Round& current() const { return current_; }

  /// The round of what comes in on the link of `face`. A link delivers in order, so the last join
  /// or echo tells to which round a message belongs.
  const Round& of(base::Direction face) const { return heard_[static_cast<std::size_t>(face)]; }

  void hear(base::Direction face, const Round& round) {
    heard_[static_cast<std::size_t>(face)] = round;
  }

  void enter(const Round& round) {
    current_ = round;
    restart_at_ = kNever;
  }

  /// The round is over; the next one begins at `at`, or when a neighbour begins it.
  void leave_until(Time at) { restart_at_ = at; }

  /// When this module starts a round.
  Time restart_at() const { return restart_at_; }

  /// Has the round been left, and the next one not begun?
  bool is_left() const { return restart_at_ != kNever; }

 private:
  Round current_;
  std::array<Round, base::kDirectionCount> heard_;
  Time restart_at_ = kNever;
};

}  // namespace holdfast::agent
