// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "holdfast/sim/recorder.hpp"

namespace holdfast::sim {
namespace {

constexpr std::uint64_t kHashPrime = 0x100000001b3U;

std::size_t index(agent::Phase phase) { return static_cast<std::size_t>(phase); }

}  // namespace

bool is_data(std::span<const std::uint8_t> packet) {
  return agent::wire::header_of(packet).kind == agent::wire::PacketKind::kData;
}

void Recorder::sent(const PacketTrace& packet, agent::Phase phase, Time line_time) {
  constexpr std::size_t kOverhead = agent::wire::kHeaderBytes + agent::wire::kChecksumBytes;
  const std::size_t size = packet.bytes.size();
  ++result_.packets;
  result_.bytes += size;
  PhaseStatistics& statistics = result_.phases[index(phase)];
  ++statistics.packets;
  statistics.bytes += size;
  if (size > kOverhead && is_data(packet.bytes)) {
    ++result_.data_packets;
    result_.payload_bytes += size - kOverhead;
  }
  if (trace_ != nullptr) {
    trace_->packet_sent(packet, line_time);
  }
}

void Recorder::delivered(const PacketTrace& packet) {
  hash(packet.time, 8);
  hash(static_cast<std::uint64_t>(packet.to), 4);
  hash(static_cast<std::uint64_t>(base::opposite(packet.face)), 1);
  hash(static_cast<std::uint64_t>(agent::EventKind::kReceive), 1);
  for (const std::uint8_t byte : packet.bytes) {
    hash_ = (hash_ ^ byte) * kHashPrime;
  }
  if (trace_ != nullptr) {
    trace_->packet_delivered(packet);
  }
}

void Recorder::lost(const PacketTrace& packet) {
  ++result_.lost_packets;
  if (trace_ != nullptr) {
    trace_->packet_lost(packet);
  }
}

void Recorder::note_change(Time now, std::int32_t module, const agent::Agent& agent, Seen& seen) {
  if (agent.epoch() != seen.epoch && trace_ != nullptr) {
    trace_->joined(now, module, agent.epoch());
  }
  if (agent.phase() != seen.phase && trace_ != nullptr) {
    trace_->phase_changed(now, module, agent.phase());
  }
  if (agent.answer().verdict != seen.verdict) {
    if (agent.answer().verdict != agent::Verdict::kNone) {
      result_.verdict_time = now;
    }
    if (trace_ != nullptr) {
      trace_->verdict_known(now, module, agent.answer());
    }
  }
  const bool has_moved = agent.epoch() != seen.epoch || agent.phase() != seen.phase;
  seen = {.epoch = agent.epoch(), .phase = agent.phase(), .verdict = agent.answer().verdict};
  if (has_moved) {
    reached(now, seen.epoch, seen.phase, agent.is_root());
  }
}

/// A module is in this phase of this epoch from now on. The root alone leads back to an earlier
/// one, as from load ratios to another equilibrium.
void Recorder::reached(Time time, std::uint16_t epoch, agent::Phase phase, bool is_root) {
  const bool is_same = epoch == result_.epoch;
  const bool is_newer = agent::is_newer({.epoch = epoch}, {.epoch = result_.epoch});
  const bool is_next = is_root ? phase != phase_ : phase > phase_;
  if (is_same ? !is_next : !is_newer) {
    return;
  }
  leave_phase(time, result_);
  phase_since_ = time;
  phase_rounds_ = result_.rounds;
  phase_ = phase;
  result_.epoch = epoch;
}

SimulationResult Recorder::result() const {
  SimulationResult result = result_;
  result.trace_hash = hash_;
  leave_phase(result.time, result);
  return result;
}

/// Books what has passed since the robot came into its phase.
void Recorder::leave_phase(Time time, SimulationResult& result) const {
  PhaseStatistics& statistics = result.phases[index(phase_)];
  statistics.time += time - phase_since_;
  statistics.rounds += result.rounds - phase_rounds_;
}

void Recorder::hash(std::uint64_t value, int bytes) {
  for (int i = 0; i < bytes; ++i) {
    hash_ = (hash_ ^ (value & 0xffU)) * kHashPrime;
    value >>= 8U;
  }
}

}  // namespace holdfast::sim
