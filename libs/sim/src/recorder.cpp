// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "holdfast/sim/recorder.hpp"

#include <array>

namespace holdfast::sim {
namespace {

constexpr std::uint64_t kHashPrime = 0x100000001b3U;

/// Powers of the prime.
constexpr std::array<std::uint64_t, 9> kHashPowers = [] {
  std::array<std::uint64_t, 9> powers{1};
  for (std::size_t i = 1; i < powers.size(); ++i) {
    powers[i] = powers[i - 1] * kHashPrime;
  }
  return powers;
}();

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
  received(packet.time, packet.to, base::opposite(packet.face), packet.bytes);
  if (trace_ != nullptr) {
    trace_->packet_delivered(packet);
  }
}

void Recorder::received(Time time, std::int32_t to, base::Direction face,
                        std::span<const std::uint8_t> packet) {
  hash(time, 8);
  hash(static_cast<std::uint64_t>(to), 4);
  hash(static_cast<std::uint64_t>(face), 1);
  hash(static_cast<std::uint64_t>(agent::EventKind::kReceive), 1);
  for (const std::uint8_t byte : packet) {
    hash_ = (hash_ ^ byte) * kHashPrime;
  }
}

void Recorder::lost(const PacketTrace& packet) {
  ++result_.lost_packets;
  if (trace_ != nullptr) {
    trace_->packet_lost(packet);
  }
}

void Recorder::take_packets(Recorder& other) {
  SimulationResult& from = other.result_;
  result_.packets += from.packets;
  result_.bytes += from.bytes;
  result_.data_packets += from.data_packets;
  result_.payload_bytes += from.payload_bytes;
  result_.lost_packets += from.lost_packets;
  for (std::size_t i = 0; i < kPhaseCount; ++i) {
    result_.phases[i].packets += from.phases[i].packets;
    result_.phases[i].bytes += from.phases[i].bytes;
  }
  from = {};
}

void Recorder::note_change(Time now, std::int32_t module, const agent::Agent& agent, Seen& seen) {
  const Change change = take_change(agent, seen);
  if (trace_ != nullptr) {
    if (change.after.epoch != change.before.epoch) {
      trace_->joined(now, module, change.after.epoch);
    }
    if (change.after.phase != change.before.phase) {
      trace_->phase_changed(now, module, change.after.phase);
    }
    if (change.after.verdict != change.before.verdict) {
      trace_->verdict_known(now, module, agent.answer());
    }
  }
  changed(now, change);
}

Change Recorder::take_change(const agent::Agent& agent, Seen& seen) {
  const Seen before = seen;
  seen = {.epoch = agent.epoch(), .phase = agent.phase(), .verdict = agent.answer().verdict};
  return {.before = before, .after = seen, .is_root = agent.is_root()};
}

void Recorder::changed(Time now, const Change& change) {
  const auto& [before, after, is_root] = change;
  if (after.verdict != before.verdict && after.verdict != agent::Verdict::kNone) {
    result_.verdict_time = now;
  }
  if (after.epoch != before.epoch || after.phase != before.phase) {
    reached(now, after.epoch, after.phase, is_root);
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

/// The lowest bytes of a value. Those that are 0 only multiply.
void Recorder::hash(std::uint64_t value, int bytes) {
  for (; value != 0 && bytes > 0; --bytes) {
    hash_ = (hash_ ^ (value & 0xffU)) * kHashPrime;
    value >>= 8U;
  }
  hash_ *= kHashPowers[static_cast<std::size_t>(bytes)];
}

}  // namespace holdfast::sim
