// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "packet_log.hpp"

#include <algorithm>

namespace holdfast::web {
namespace {

namespace wire = agent::wire;

PacketMeaning meaning_of(std::uint8_t type) {
  switch (static_cast<wire::MessageType>(type)) {
    case wire::MessageType::kJoin:
    case wire::MessageType::kEcho:
    case wire::MessageType::kAppoint:
    case wire::MessageType::kMark:
      return PacketMeaning::kWave;
    case wire::MessageType::kOrder:
      return PacketMeaning::kOrder;
    case wire::MessageType::kReport:
      return PacketMeaning::kReport;
    case wire::MessageType::kVector:
      return PacketMeaning::kVector;
    case wire::MessageType::kBranchDown:
      return PacketMeaning::kOrder;
    case wire::MessageType::kLoop:
    case wire::MessageType::kColumn:
    case wire::MessageType::kBranchUp:
      return PacketMeaning::kReport;
    case wire::MessageType::kPlannedDown:
    case wire::MessageType::kPlannedUp:
      break;
  }
  return PacketMeaning::kPlanned;
}

bool is_order(std::uint8_t type) {
  return static_cast<wire::MessageType>(type) == wire::MessageType::kOrder;
}

bool has_operation(std::uint8_t type) {
  return is_order(type) || static_cast<wire::MessageType>(type) == wire::MessageType::kReport;
}

}  // namespace

PacketLog::Told PacketLog::read_payload(Stream& stream, std::span<const std::uint8_t> payload) {
  Told told{.meaning = stream.meaning};
  bool is_told = stream.bytes_left > 0 || stream.first != 0;
  for (std::size_t at = 0; at < payload.size();) {
    if (stream.bytes_left > 0) {
      const auto taken = std::min(static_cast<std::size_t>(stream.bytes_left), payload.size() - at);
      stream.bytes_left -= static_cast<int>(taken);
      at += taken;
      continue;
    }
    const bool is_second = stream.first != 0;
    const std::uint8_t type = is_second ? stream.first : payload[at];
    stream.meaning = meaning_of(type);
    told.meaning = is_told ? told.meaning : stream.meaning;
    is_told = true;
    const std::size_t second_at = is_second ? at : at + 1;
    stream.first = 0;
    if (has_operation(type) && second_at == payload.size()) {
      stream.first = type;
      break;
    }
    const std::uint8_t second = second_at < payload.size() ? payload[second_at] : std::uint8_t{0};
    told.operation = is_order(type) && told.operation == 0 ? second : told.operation;
    // The type byte may have been the last of the packet before.
    stream.bytes_left = wire::message_bytes(type, second) - (is_second ? 1 : 0);
    if (stream.bytes_left <= 0) {
      break;
    }
  }
  return told;
}

PacketLog::Told PacketLog::follow(Stream& stream, std::span<const std::uint8_t> packet) {
  const int kind = packet[0] >> 6U;
  if (static_cast<wire::PacketKind>(kind) == wire::PacketKind::kHello) {
    const int number = packet[2] | (packet[3] << 8U);
    if (number != stream.number) {
      stream = {.number = number};
    }
    return {};
  }
  const int sequence = packet[0] & 63U;
  if (static_cast<wire::PacketKind>(kind) != wire::PacketKind::kData) {
    return {};
  }
  if (sequence != stream.next_sequence) {
    return {.meaning = stream.meaning};  // sent again
  }
  stream.next_sequence = (stream.next_sequence + 1) % 64;
  return read_payload(stream,
                      packet.subspan(wire::kHeaderBytes,
                                     packet.size() - wire::kHeaderBytes - wire::kChecksumBytes));
}

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
  const Told told = follow(streams_[{packet.from, packet.to}], packet.bytes);
  add(LogEvent::kPacket, {packet.from, packet.to, static_cast<std::int32_t>(told.meaning)},
      packet.time, line_time);
  if (told.operation != 0) {
    add(LogEvent::kOrder, {packet.from, packet.to, told.operation}, packet.time);
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
