// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <iosfwd>
#include <memory>
#include <span>
#include <string>

#include "holdfast/model/robot.hpp"
#include "holdfast/sim/fault.hpp"
#include "holdfast/sim/link_model.hpp"
#include "holdfast/sim/simulation_result.hpp"

/// Watching a simulation: what it tells, and two ways of writing it down.
namespace holdfast::sim {

struct PacketTrace {
  Time time = 0;
  std::uint64_t number = 0;  ///< Of the packet; copies share it.
  std::int32_t from = 0;
  std::int32_t to = 0;
  base::Direction face = base::Direction::kPlusX;  ///< Of the sender.
  std::span<const std::uint8_t> bytes = {};
};

/// Receives what happens in a simulation, in the order of time. Modules are indices in the robot.
class TraceSink {
 public:
  virtual ~TraceSink() = default;

  /// Begins the trace, once, before everything else. Both arguments outlive the calls that follow.
  virtual void begin(const model::Robot& /*robot*/, const LinkModel& /*link*/) {}

  virtual void packet_sent(const PacketTrace& /*packet*/, Time /*line_time*/) {}

  virtual void packet_delivered(const PacketTrace& /*packet*/) {}

  virtual void packet_lost(const PacketTrace& /*packet*/) {}

  /// A wave of a new epoch has reached the module.
  virtual void joined(Time /*time*/, std::int32_t /*module*/, std::uint16_t /*epoch*/) {}

  virtual void phase_changed(Time /*time*/, std::int32_t /*module*/, agent::Phase /*phase*/) {}

  /// The module knows the verdict; kNone: not any more.
  virtual void verdict_known(Time /*time*/, std::int32_t /*module*/,
                             const agent::Answer& /*answer*/) {}

  virtual void fault_happened(const Fault& /*fault*/) {}

  virtual void announced(const Announcement& /*announcement*/) {}

  /// Ends the trace, once, when the simulation is over; not if it is given up before.
  virtual void end(const SimulationResult& /*result*/) {}
};

struct PerfettoOptions {
  std::uint64_t event_count_max = 1'000'000;  ///< Later ones are left out.
  bool has_packets = true;
};

/// Writes Chrome trace-event JSON, for ui.perfetto.dev: a thread for every module, its phases as
/// slices, packets as arrows, lost packets, verdicts and faults as instants. Time is in
/// microseconds; in ticks where they have no length. The text is complete JSON after end() or the
/// destructor.
class PerfettoTrace : public TraceSink {
 public:
  explicit PerfettoTrace(std::ostream& out, const PerfettoOptions& options = {});
  ~PerfettoTrace() override;

  void begin(const model::Robot& robot, const LinkModel& link) override;
  void packet_sent(const PacketTrace& packet, Time line_time) override;
  void packet_delivered(const PacketTrace& packet) override;
  void packet_lost(const PacketTrace& packet) override;
  void phase_changed(Time time, std::int32_t module, agent::Phase phase) override;
  void verdict_known(Time time, std::int32_t module, const agent::Answer& answer) override;
  void fault_happened(const Fault& fault) override;
  void announced(const Announcement& announcement) override;
  void end(const SimulationResult& result) override;

 private:
  struct Writer;
  std::unique_ptr<Writer> writer_;
};

/// Describes a module's answer in words: "knows the verdict: safe (...), load ratio ...".
std::string describe(const agent::Answer& answer, const base::Lattice& lattice = base::kCubic);

struct StoryOptions {
  bool tells_every_module = true;  ///< False: phases and waves only when the first module is there.
};

/// Writes a text for people: one line for each notable happening but packets, totals at the end.
class StoryTrace : public TraceSink {
 public:
  explicit StoryTrace(std::ostream& out, const StoryOptions& options = {});
  ~StoryTrace() override;

  void begin(const model::Robot& robot, const LinkModel& link) override;
  void joined(Time time, std::int32_t module, std::uint16_t epoch) override;
  void phase_changed(Time time, std::int32_t module, agent::Phase phase) override;
  void verdict_known(Time time, std::int32_t module, const agent::Answer& answer) override;
  void fault_happened(const Fault& fault) override;
  void announced(const Announcement& announcement) override;
  void end(const SimulationResult& result) override;

 private:
  struct Writer;
  std::unique_ptr<Writer> writer_;
};

}  // namespace holdfast::sim
