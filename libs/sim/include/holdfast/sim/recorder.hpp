// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>

#include "holdfast/sim/simulation_result.hpp"
#include "holdfast/sim/trace.hpp"

/// Counts and hashes what happens to a robot's agents, keeps the robot's phase, passes everything
/// on to the trace. For whoever runs agents, in this simulation or in another one.
namespace holdfast::sim {

/// Whether the packet carries messages.
bool is_data(std::span<const std::uint8_t> packet);

/// The state of an agent as far as it is recorded.
struct Seen {
  std::uint16_t epoch = 0;
  agent::Phase phase = agent::Phase::kDiscovery;
  agent::Verdict verdict = agent::Verdict::kNone;
};

/// What a step has changed of that.
struct Change {
  Seen before;
  Seen after;
  bool is_root = false;  ///< Afterwards.
};

class Recorder {
 public:
  /// `trace` may be null.
  explicit Recorder(TraceSink* trace) : trace_(trace) {}

  TraceSink* trace() const { return trace_; }

  void sent(const PacketTrace& packet, agent::Phase phase, Time line_time);
  void delivered(const PacketTrace& packet);
  /// A packet is delivered that nobody traces: at this time, to this module, at this face of it.
  void received(Time time, std::int32_t to, base::Direction face,
                std::span<const std::uint8_t> packet);
  void lost(const PacketTrace& packet);

  /// Adds the packets that another recorder has counted as sent and lost, and lets it begin anew.
  void take_packets(Recorder& other);

  /// Notes what has changed in an agent since it was `seen` last, after its every step.
  void observe(Time now, std::int32_t module, const agent::Agent& agent, Seen& seen) {
    if (has_changed(agent, seen)) {
      note_change(now, module, agent, seen);
    }
  }

  static bool has_changed(const agent::Agent& agent, const Seen& seen) {
    return agent.epoch() != seen.epoch || agent.phase() != seen.phase ||
           agent.answer().verdict != seen.verdict;
  }

  /// Brings what was seen of an agent up to date.
  static Change take_change(const agent::Agent& agent, Seen& seen);

  /// Notes a change that nobody traces.
  void changed(Time now, const Change& change);

  /// A chain of so many packets has come to an end.
  void chained(std::uint64_t rounds) {
    result_.rounds = rounds > result_.rounds ? rounds : result_.rounds;
  }

  /// A module has handled an event, or several.
  void handled(Time time, std::uint64_t count = 1) {
    result_.time = count > 0 ? time : result_.time;
    result_.events += count;
  }

  Time verdict_time() const { return result_.verdict_time; }

  std::uint64_t event_count() const { return result_.events; }

  /// The counts, with the time of the present phase up to the last event.
  SimulationResult result() const;

 private:
  void note_change(Time now, std::int32_t module, const agent::Agent& agent, Seen& seen);
  void reached(Time time, std::uint16_t epoch, agent::Phase phase, bool is_root);
  void leave_phase(Time time, SimulationResult& result) const;
  void hash(std::uint64_t value, int bytes);

  TraceSink* trace_;
  SimulationResult result_;
  std::uint64_t hash_ = 0xcbf29ce484222325U;
  agent::Phase phase_ = agent::Phase::kDiscovery;
  Time phase_since_ = 0;
  std::uint64_t phase_rounds_ = 0;  ///< At that time.
};

/// The state of a module in the end.
struct ModuleOutcome {
  const agent::Agent& agent;
  bool takes_part = true;  ///< Is it attached and not silenced?
  std::uint64_t packets_sent = 0;
  std::uint64_t bytes_sent = 0;
};

/// Puts together what the modules say, one after the other, by ascending index.
class Outcome {
 public:
  explicit Outcome(const SimulationResult& counts) : result_(counts) {}

  void add(std::int32_t module, const ModuleOutcome& outcome);

  SimulationResult result() const;

 private:
  SimulationResult result_;
  bool agree_ = true;
  bool is_empty_ = true;
};

}  // namespace holdfast::sim
