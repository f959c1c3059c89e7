// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "holdfast/agent/wire/listener.hpp"

namespace holdfast::agent::wire {

std::optional<Carried> Listener::follow(std::span<const std::uint8_t> packet) {
  const PacketHeader header = header_of(packet);
  if (header.kind == PacketKind::kHello) {
    const int number = packet[kHeaderBytes] | (packet[kHeaderBytes + 1] << 8U);
    if (number != number_) {
      *this = {};
      number_ = number;
    }
    return {};
  }
  if (header.kind != PacketKind::kData) {
    return {};
  }
  if (header.sequence != next_sequence_) {
    return Carried{.type = type_};  // Sent again.
  }
  next_sequence_ = (next_sequence_ + 1) % kSequenceCount;
  return read(packet.subspan(kHeaderBytes, packet.size() - kHeaderBytes - kChecksumBytes));
}

Carried Listener::read(std::span<const std::uint8_t> payload) {
  Carried carried{.type = type_};
  bool is_told = bytes_left_ > 0 || first_ != 0;
  for (std::size_t at = 0; at < payload.size();) {
    if (bytes_left_ > 0) {
      const auto left = static_cast<std::size_t>(bytes_left_);
      const std::size_t taken = left < payload.size() - at ? left : payload.size() - at;
      bytes_left_ -= static_cast<int>(taken);
      at += taken;
      continue;
    }
    const bool is_second = first_ != 0;  // The type byte was the last of the packet before.
    const std::uint8_t first = is_second ? first_ : payload[at];
    type_ = static_cast<MessageType>(first);
    carried.type = is_told ? carried.type : type_;
    is_told = true;
    const std::size_t second_at = is_second ? at : at + 1;
    if (second_at == payload.size()) {
      first_ = first;
      break;
    }
    first_ = 0;
    const std::uint8_t second = payload[second_at];
    if (type_ == MessageType::kOrder && !carried.order) {
      carried.order = static_cast<Operation>(second);
    }
    bytes_left_ = message_bytes(first, second) - (is_second ? 1 : 0);
    if (bytes_left_ <= 0) {
      break;
    }
  }
  return carried;
}

}  // namespace holdfast::agent::wire
