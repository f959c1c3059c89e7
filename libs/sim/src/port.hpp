// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>

#include "clock.hpp"
#include "holdfast/agent/agent.hpp"
#include "holdfast/base/rng.hpp"

/// What the simulation keeps for each module beside its agent.
namespace holdfast::sim {

struct Port {
  static constexpr std::uint32_t kNoEvent = ~std::uint32_t{0};

  std::array<Time, base::kDirectionCount> line_free_at{};
  std::array<Time, base::kDirectionCount> arrival_last{};  ///< Of what was sent on each face.

  /// When the agent wants to wake, and the times of up to two timer events in the queue, earlier
  /// first. An event with another time is out of date: the agent has changed its mind.
  Time wake_at = agent::kNever;
  Time timer_at = agent::kNever;
  Time timer_later_at = agent::kNever;

  // Only with a compute time: events wait here, first come, first served.
  Time busy_until = 0;
  std::uint32_t waiting_first = kNoEvent;
  std::uint32_t waiting_last = kNoEvent;

  base::Rng rng{0};
  Clock clock;
  std::uint64_t bytes_sent = 0;
  std::uint64_t packets_sent = 0;
  std::uint64_t rounds = 0;  ///< Length of the longest chain of packets that ends here.
  std::uint16_t random = 0;  ///< Of the last link-up.

  // As the agent was after its last step.
  std::uint16_t epoch = 0;
  agent::Phase phase = agent::Phase::kDiscovery;
  agent::Verdict verdict = agent::Verdict::kNone;

  std::uint8_t wanted = 0;       ///< Faces on which a packet waits.
  std::uint8_t line_events = 0;  ///< Faces with an event in the queue for a free line.
  std::uint8_t cut_faces = 0;    ///< Links that drop everything.
  bool is_watching = false;      ///< wake_at is for watching over a verdict, nothing else.
  bool is_busy = false;          ///< Computing; an event in the queue says when it is done.
  bool is_attached = true;
  bool is_silenced = false;

  bool takes_part() const { return is_attached && !is_silenced; }

  /// Has the agent something to do at wake_at but watching?
  bool has_work() const { return wake_at != agent::kNever && !is_watching; }
};

}  // namespace holdfast::sim
