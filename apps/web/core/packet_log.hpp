// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <span>
#include <utility>
#include <vector>

#include "holdfast/distributed.hpp"

/// Logs a simulation as numbers that the page can play.
namespace holdfast::web {

enum class LogEvent : std::int32_t {
  kPacket,   ///< From a module, to a module, PacketMeaning; takes `duration`.
  kLost,     ///< From a module, to a module.
  kPhase,    ///< Module, agent::Phase.
  kVerdict,  ///< Module, agent::Verdict.
  kOrder,    ///< From, to, wire::Operation: an order is on its way.
};

/// The meaning of a packet: kLink is a greeting, ping or acknowledgement; else the first message in
/// it.
enum class PacketMeaning : std::int32_t { kLink, kWave, kOrder, kReport, kVector, kPlanned };

/// Listens to every link, to tell what its packets are.
class PacketLog : public sim::TraceSink {
 public:
  /// Keeps `event_count_max` events and leaves out later ones, as is_complete() tells.
  explicit PacketLog(std::size_t event_count_max) : event_count_max_(event_count_max) {}

  void packet_sent(const sim::PacketTrace& packet, sim::Time line_time) override;
  void packet_lost(const sim::PacketTrace& packet) override;
  void phase_changed(sim::Time time, std::int32_t module, agent::Phase phase) override;
  void verdict_known(sim::Time time, std::int32_t module, const agent::Answer& answer) override;

  /// Four integers and two numbers (time and duration in ticks) for each event.
  std::vector<std::int32_t> take_integers() { return std::move(integers_); }

  std::vector<double> take_numbers() { return std::move(numbers_); }

  bool is_complete() const { return is_complete_; }

 private:
  void add(LogEvent event, std::array<std::int32_t, 3> values, sim::Time time,
           sim::Time duration = 0);

  std::size_t event_count_max_;
  bool is_complete_ = true;
  std::map<std::pair<std::int32_t, std::int32_t>, agent::wire::Listener> listeners_;
  std::vector<std::int32_t> integers_;
  std::vector<double> numbers_;
};

}  // namespace holdfast::web
