// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
//
// A listener beside the golden conversation of docs/wire.md, cut into packets of every length: what
// each of them carries is known from where the messages begin.
#include "holdfast/agent/wire/listener.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "golden.hpp"
#include "test_setup.hpp"

namespace holdfast::agent {
namespace {

using namespace holdfast::agent::test;
using wire::MessageType;
using Packet = std::vector<std::uint8_t>;

struct Part {
  MessageType type{};
  std::optional<wire::Operation> begins;  ///< The operation byte of an order is here.
};

/// What every byte of a stream belongs to.
std::vector<Part> parts_of(const GoldenStream& golden, Packet& stream) {
  std::vector<Part> parts;
  for (const std::string_view text : golden.messages) {
    const Packet message = from_hex(text);
    const auto type = static_cast<MessageType>(message[0]);
    parts.insert(parts.end(), message.size(), Part{.type = type, .begins = {}});
    if (type == MessageType::kOrder) {
      parts[stream.size() + 1].begins = static_cast<wire::Operation>(message[1]);
    }
    stream.insert(stream.end(), message.begin(), message.end());
  }
  return parts;
}

Packet data_packet(int sequence, std::span<const std::uint8_t> payload) {
  constexpr std::size_t kHeaderBytes = 2;
  Packet packet(kHeaderBytes + payload.size() + wire::kChecksumBytes);
  packet[0] = static_cast<std::uint8_t>(sequence % wire::kSequenceCount);
  packet[1] = 0x40;
  std::ranges::copy(payload, packet.begin() + kHeaderBytes);
  return packet;
}

TEST(Listener, tells_what_packets_of_any_length_carry) {
  for (const GoldenStream& golden : kGoldenTrace) {
    Packet stream;
    const std::vector<Part> parts = parts_of(golden, stream);
    for (std::size_t length = 1; length <= 60; ++length) {
      wire::Listener listener;
      int sequence = 0;
      for (std::size_t at = 0; at < stream.size(); at += length) {
        const auto payload = std::span(stream).subspan(at, std::min(length, stream.size() - at));
        const auto carried = listener.follow(data_packet(sequence++, payload));
        ASSERT_TRUE(carried);
        EXPECT_EQ(carried->type, parts[at].type);
        const auto here = std::span(parts).subspan(at, payload.size());
        const auto order = std::ranges::find_if(here, [](const Part& p) { return !!p.begins; });
        EXPECT_EQ(carried->order, order == here.end() ? std::nullopt : order->begins);
      }
    }
  }
}

TEST(Listener, takes_what_is_sent_again_for_what_it_was) {
  const Packet order = from_hex("05 0c 02");
  const Packet hello = from_hex(kGoldenHello);
  wire::Listener listener;
  EXPECT_FALSE(listener.follow(hello));
  EXPECT_EQ(listener.follow(data_packet(0, order))->order, wire::Operation::kHold);
  const auto again = listener.follow(data_packet(0, order));
  EXPECT_EQ(again->type, MessageType::kOrder);
  EXPECT_FALSE(again->order);
  // The same greeting goes on with the session, another one begins anew.
  EXPECT_FALSE(listener.follow(hello));
  EXPECT_EQ(listener.follow(data_packet(1, order))->order, wire::Operation::kHold);
  Packet other = hello;
  other[2] ^= 1U;
  EXPECT_FALSE(listener.follow(other));
  EXPECT_EQ(listener.follow(data_packet(0, order))->order, wire::Operation::kHold);
}

TEST(Listener, hears_nothing_in_pings_and_acknowledgements) {
  wire::Listener listener;
  EXPECT_FALSE(listener.follow(from_hex(kGoldenPing)));
  EXPECT_FALSE(listener.follow(from_hex(kGoldenAcknowledge)));
}

}  // namespace
}  // namespace holdfast::agent
