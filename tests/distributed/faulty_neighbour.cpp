// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "faulty_neighbour.hpp"

#include <algorithm>
#include <bit>
#include <iterator>

#include "holdfast/agent/wire/operations.hpp"

namespace holdfast::test {
namespace {

namespace wire = agent::wire;
using wire::PacketKind;

constexpr std::size_t kNumbers = wire::kSequenceCount;

/// The start of the checksum of a session: docs/wire.md, "Packets".
std::uint16_t session(std::uint16_t sender, std::uint16_t receiver) {
  const auto mixed = static_cast<std::uint16_t>(sender ^ std::rotl(receiver, 5));
  return static_cast<std::uint16_t>(mixed ^ (std::popcount(mixed) & 1));
}

bool is_complete(const std::vector<std::uint8_t>& message) {
  return message.size() >= 2 &&
         static_cast<int>(message.size()) == wire::message_bytes(message[0], message[1]);
}

}  // namespace

FaultyNeighbour::FaultyNeighbour(const model::Robot& robot, const FaultyOptions& options)
    : robot_(robot),
      options_(options),
      rng_(options.seed),
      streams_(robot.modules().size() * base::kDirectionCount) {}

FaultyNeighbour::Stream& FaultyNeighbour::stream(std::int32_t module, base::Direction face) {
  const auto first = static_cast<std::size_t>(module) * base::kDirectionCount;
  return streams_[first + static_cast<std::size_t>(base::index(face))];
}

int FaultyNeighbour::tamper(sim::Time now, std::int32_t module, base::Direction face,
                            std::span<std::uint8_t> packet, int size) {
  constexpr std::size_t kOverhead = wire::kHeaderBytes + wire::kChecksumBytes;
  Stream& out = stream(module, face);
  const wire::PacketHeader header = wire::header_of(packet);
  if (header.kind == PacketKind::kHello) {
    const auto number = static_cast<std::uint16_t>(packet[2] | packet[3] << 8U);
    if (number != out.number) {
      out = {};
      out.number = number;
    }
    return size;
  }
  if (header.kind != PacketKind::kData || module != options_.module) {
    return size;
  }
  const auto payload =
      packet.subspan(wire::kHeaderBytes, static_cast<std::size_t>(size) - kOverhead);
  const std::size_t number = header.sequence;
  Sent& sent = out.sent[number];
  if (!std::ranges::equal(sent.original, payload)) {
    sent.original.assign(payload.begin(), payload.end());
    sent.changed = change(now, out, payload, packet.size() - kOverhead);
    // A number that comes round again is another packet.
    for (std::size_t ahead = kNumbers / 4; ahead < kNumbers / 2; ++ahead) {
      out.sent[(number + ahead) % kNumbers] = {};
    }
  }
  std::ranges::copy(sent.changed, packet.begin() + wire::kHeaderBytes);
  const std::size_t body = wire::kHeaderBytes + sent.changed.size();
  const auto neighbour = robot_.neighbours()[static_cast<std::size_t>(module)]
                                            [static_cast<std::size_t>(base::index(face))];
  const std::uint16_t sum = wire::checksum(
      packet.first(body), session(out.number, stream(neighbour, base::opposite(face)).number));
  packet[body] = static_cast<std::uint8_t>(sum & 0xffU);
  packet[body + 1] = static_cast<std::uint8_t>(sum >> 8U);
  return static_cast<int>(body) + wire::kChecksumBytes;
}

/// The bytes that go out instead of the payload. A liar's messages leave whole.
FaultyNeighbour::Bytes FaultyNeighbour::change(sim::Time now, Stream& out,
                                               std::span<const std::uint8_t> payload,
                                               std::size_t room) {
  if (options_.kind == FaultyOptions::Kind::kHangs) {
    const bool hangs = now >= options_.at;
    change_count_ += hangs ? 1 : 0;
    return hangs ? Bytes{} : Bytes(payload.begin(), payload.end());
  }
  Bytes changed;
  for (const std::uint8_t byte : payload) {
    out.message.push_back(byte);
    if (!is_complete(out.message)) {
      continue;
    }
    const std::size_t before = changed.size();
    if (now >= options_.at && rng_.below(options_.one_in) == 0) {
      add_changed(changed, out.message);
      ++change_count_;
    } else {
      changed.insert(changed.end(), out.message.begin(), out.message.end());
    }
    if (changed.size() > room) {
      changed.resize(before);
    }
    out.message.clear();
  }
  return changed;
}

void FaultyNeighbour::add_changed(Bytes& payload, Bytes message) {
  const auto add = [&](const Bytes& bytes) {
    payload.insert(payload.end(), bytes.begin(), bytes.end());
  };
  switch (rng_.below(5)) {
    case 0:  // Lost.
      return;
    case 1:  // Twice.
      add(message);
      break;
    case 2:  // Something else before it.
      add(random_message());
      break;
    case 3:
      message = random_message();
      break;
    default:
      spoil(message);
  }
  add(message);
}

/// Some bytes of the body take other values; type and operation stay, so that the size does.
void FaultyNeighbour::spoil(Bytes& message) {
  constexpr std::array<std::uint8_t, 8> kExtremes = {0, 1, 5, 6, 0x7f, 0x80, 0xfe, 0xff};
  const auto type = static_cast<wire::MessageType>(message[0]);
  const bool has_operation =
      type == wire::MessageType::kOrder || type == wire::MessageType::kReport;
  const std::size_t first = has_operation ? 2 : 1;
  for (std::uint64_t left = 1 + rng_.below(4); left > 0 && message.size() > first; --left) {
    const std::size_t at = first + rng_.below(message.size() - first);
    const bool is_extreme = rng_.below(2) == 0;
    message[at] = is_extreme ? kExtremes[rng_.below(kExtremes.size())]
                             : static_cast<std::uint8_t>(rng_.below(256));
  }
}

FaultyNeighbour::Bytes FaultyNeighbour::random_message() {
  constexpr auto kTypes = static_cast<std::uint64_t>(wire::MessageType::kNews);
  Bytes message(2);
  message[0] = static_cast<std::uint8_t>(1 + rng_.below(kTypes));
  const auto place = rng_.below(std::size(agent::kOperations));
  message[1] = static_cast<std::uint8_t>(agent::kOperations[place].operation);
  message.resize(static_cast<std::size_t>(wire::message_bytes(message[0], message[1])));
  for (std::size_t i = 2; i < message.size(); ++i) {
    message[i] = static_cast<std::uint8_t>(rng_.below(256));
  }
  return message;
}

}  // namespace holdfast::test
