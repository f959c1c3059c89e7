// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>

#include "clock.hpp"
#include "holdfast/agent/agent.hpp"
#include "holdfast/base/faces.hpp"
#include "holdfast/base/rng.hpp"
#include "holdfast/sim/recorder.hpp"
#include "holdfast/sim/wake_timer.hpp"

/// Stores what the simulation keeps for each module beside its agent.
namespace holdfast::sim {

/// The lines at six faces.
struct Lines {
  std::array<Time, base::kDirectionCount> free_at{};
  std::array<Time, base::kDirectionCount> arrival_last{};  ///< Of what was sent on each.
};

/// The place of a face in its Lines.
constexpr std::size_t line_of(int face) {
  return static_cast<std::size_t>(face < base::kDirectionCount ? face
                                                               : face - base::kDirectionCount);
}

struct Port {
  static constexpr std::uint32_t kNoEvent = ~std::uint32_t{0};

  Lines lines;  ///< Of the first six faces.

  WakeTimer timer;  ///< Its calls are timer events in the queue.

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

  Seen seen;  ///< As the agent was after its last step.

  std::uint16_t wanted = 0;       ///< Faces on which a packet waits.
  std::uint16_t line_events = 0;  ///< Faces with an event in the queue for a free line.
  base::WideFaces cut_faces;      ///< Links that drop everything.
  base::WideFaces open_faces;     ///< Connections that are not closed: there is no neighbour.
  bool is_watching = false;       ///< It wants to wake for watching over a verdict, nothing else.
  bool is_busy = false;           ///< Computing; an event in the queue says when it is done.
  bool is_attached = true;
  bool is_silenced = false;

  bool takes_part() const { return is_attached && !is_silenced; }

  /// Whether the agent has something to do when it wakes but watching.
  bool has_work() const { return timer.wake_at != agent::kNever && !is_watching; }
};

}  // namespace holdfast::sim
