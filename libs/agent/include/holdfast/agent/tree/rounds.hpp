// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "holdfast/agent/links/more_faces.hpp"
#include "holdfast/agent/wire/link.hpp"
#include "holdfast/agent/wire/round.hpp"
#include "holdfast/base/cell.hpp"

namespace holdfast::agent {

/// The round that a module takes part in, those that its neighbours talk of, and when it starts a
/// new one itself.
class Rounds {
 public:
  const Round& current() const { return current_; }

  /// The round of what comes in on the link of `face`. A link delivers in order, so the last join
  /// or echo tells to which round a message belongs.
  const Round& of(const MoreFaces* more, base::Direction face) const {
    return at_face(heard_, more, &MoreFaces::heard, face);
  }

  void hear(MoreFaces* more, base::Direction face, const Round& round) {
    at_face(heard_, more, &MoreFaces::heard, face) = round;
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
  ByFace<Round> heard_;
  Time restart_at_ = kNever;
};

}  // namespace holdfast::agent
