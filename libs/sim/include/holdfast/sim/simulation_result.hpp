// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <string_view>

#include "holdfast/agent/agent.hpp"

namespace holdfast::sim {

using agent::Time;

inline constexpr std::size_t kPhaseCount = static_cast<std::size_t>(agent::Phase::kDone) + 1;

/// Returns "discovery", "coordinates" and so on.
std::string_view name(agent::Phase phase);

/// Whether the answers are the same in every respect, their load ratios to the last bit.
bool is_same(const agent::Answer& a, const agent::Answer& b);

struct PhaseStatistics {
  std::uint64_t packets = 0;  ///< By the phase of the sender when it hands out the packet.
  std::uint64_t bytes = 0;
  /// The time in which this was the phase of the newest epoch: the largest phase that any module
  /// had reached, until the root led back to an earlier one.
  Time time = 0;
  std::uint64_t rounds = 0;  ///< By how much the rounds grew meanwhile.
};

/// The result of a simulation. Bytes are those of packets, without the line's framing.
struct SimulationResult {
  Time time = 0;          ///< Of the last event that a module handled.
  Time verdict_time = 0;  ///< When the last module came to know its verdict.
  /// The longest chain of data packets of which each was sent after its sender had received the one
  /// before: what a synchronous network would need at least. Acknowledgements hand on the count.
  std::uint64_t rounds = 0;
  std::uint64_t events = 0;  ///< Handed to modules.
  bool is_quiet = false;     ///< It ended by itself: nothing can happen but watching.

  std::uint64_t packets = 0;  ///< Sent, acknowledgements and repetitions included.
  std::uint64_t bytes = 0;
  std::uint64_t data_packets = 0;        ///< Those that carry messages.
  std::uint64_t payload_bytes = 0;       ///< Of messages, in them.
  std::uint64_t lost_packets = 0;        ///< By noise, faults, or because nobody was there.
  std::uint64_t packets_module_max = 0;  ///< Sent by the busiest module (most bytes).
  std::uint64_t bytes_module_max = 0;
  std::array<PhaseStatistics, kPhaseCount> phases{};

  bool all_agree = false;   ///< Every living, attached module knows the same answer.
  agent::Answer answer;     ///< Of the first of them.
  std::int32_t root = -1;   ///< The module that conducted, if there is one.
  agent::Effort effort;     ///< Of the root.
  std::uint16_t epoch = 0;  ///< The newest.

  std::size_t bytes_per_module = sizeof(agent::Agent);
  /// The FNV-1a sum over time, receiver, face, kind and bytes of every packet delivered, in order.
  std::uint64_t trace_hash = 0;
};

}  // namespace holdfast::sim
