// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "packet_log.hpp"

namespace holdfast::web {
namespace {

namespace wire = agent::wire;

PacketMeaning meaning_of(wire::MessageType type) {
  switch (type) {
    case wire::MessageType::kJoin:
    case wire::MessageType::kEcho:
    case wire::MessageType::kAppoint:
    case wire::MessageType::kMark:
    case wire::MessageType::kAdopt:
      return PacketMeaning::kWave;
    case wire::MessageType::kOrder:
    case wire::MessageType::kBranchDown:
    case wire::MessageType::kFrontDown:
    case wire::MessageType::kCellsDown:
    case wire::MessageType::kReach:
      return PacketMeaning::kOrder;
    case wire::MessageType::kReport:
    case wire::MessageType::kLoop:
    case wire::MessageType::kColumn:
    case wire::MessageType::kBranchUp:
    case wire::MessageType::kFrontUp:
    case wire::MessageType::kCellsUp:
    case wire::MessageType::kNews:
      return PacketMeaning::kReport;
    case wire::MessageType::kVector:
      return PacketMeaning::kVector;
    case wire::MessageType::kPlannedDown:
    case wire::MessageType::kPlannedUp:
      break;
  }
  return PacketMeaning::kPlanned;
}

}  // namespace

void PacketLog::add(LogEvent event, std::array<std::int32_t, 3> values, sim::Time time,
                    sim::Time duration) {
  if (integers_.size() / 4 >= event_count_max_) {
    is_complete_ = false;
    return;
  }
  integers_.push_back(static_cast<std::int32_t>(event));
  integers_.insert(integers_.end(), values.begin(), values.end());
  numbers_.push_back(static_cast<double>(time));
  numbers_.push_back(static_cast<double>(duration));
}

void PacketLog::packet_sent(const sim::PacketTrace& packet, sim::Time line_time) {
  const auto carried = listeners_[{packet.from, packet.to}].follow(packet.bytes);
  const PacketMeaning meaning = carried ? meaning_of(carried->type) : PacketMeaning::kLink;
  add(LogEvent::kPacket, {packet.from, packet.to, static_cast<std::int32_t>(meaning)}, packet.time,
      line_time);
  if (carried && carried->order) {
    add(LogEvent::kOrder, {packet.from, packet.to, static_cast<std::int32_t>(*carried->order)},
        packet.time);
  }
}

void PacketLog::packet_lost(const sim::PacketTrace& packet) {
  add(LogEvent::kLost, {packet.from, packet.to, 0}, packet.time);
}

void PacketLog::phase_changed(sim::Time time, std::int32_t module, agent::Phase phase) {
  add(LogEvent::kPhase, {module, static_cast<std::int32_t>(phase), 0}, time);
}

void PacketLog::verdict_known(sim::Time time, std::int32_t module, const agent::Answer& answer) {
  add(LogEvent::kVerdict, {module, static_cast<std::int32_t>(answer.verdict), 0}, time);
}

}  // namespace holdfast::web
