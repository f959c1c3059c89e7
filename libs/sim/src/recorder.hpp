// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>

#include "holdfast/sim/simulation_result.hpp"
#include "holdfast/sim/trace.hpp"

/// Counts and hashes what happens, keeps the robot's phase, passes everything on to the trace.
namespace holdfast::sim {

/// Does the packet carry messages?
bool is_data(std::span<const std::uint8_t> packet);

class Recorder {
 public:
  /// `trace` may be null.
  explicit Recorder(TraceSink* trace) : trace_(trace) {}

  TraceSink* trace() const { return trace_; }

  void sent(const PacketTrace& packet, agent::Phase phase, Time line_time);
  void delivered(const PacketTrace& packet);
  void lost(const PacketTrace& packet);

  /// A module is in this phase of this epoch from now on.
  void reached(Time time, std::uint16_t epoch, agent::Phase phase);

  /// A chain of so many packets has come to an end.
  void chained(std::uint64_t rounds) {
    result_.rounds = rounds > result_.rounds ? rounds : result_.rounds;
  }

  void verdict_known(Time time) { result_.verdict_time = time; }

  /// A module has handled an event.
  void handled(Time time) {
    result_.time = time;
    ++result_.events;
  }

  Time verdict_time() const { return result_.verdict_time; }

  std::uint64_t event_count() const { return result_.events; }

  /// The counts, with the time of the present phase up to the last event.
  SimulationResult result() const;

 private:
  void leave_phase(Time time, SimulationResult& result) const;
  void hash(std::uint64_t value, int bytes);

  TraceSink* trace_;
  SimulationResult result_;
  std::uint64_t hash_ = 0xcbf29ce484222325U;
  agent::Phase phase_ = agent::Phase::kDiscovery;
  Time phase_since_ = 0;
  std::uint64_t phase_rounds_ = 0;  ///< At that time.
};

}  // namespace holdfast::sim
