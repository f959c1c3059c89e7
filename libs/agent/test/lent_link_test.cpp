// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
//
// A link whose queue is lent: more packets under way, to whoever has none, over a line that loses
// one of them.
#include <gtest/gtest.h>

#include <array>
#include <vector>

#include "holdfast/agent/wire/link.hpp"

namespace holdfast::agent {
namespace {

using Bytes = std::vector<std::uint8_t>;

Bytes write(Link& link, Time now, const LinkTiming& timing) {
  std::array<std::uint8_t, wire::kPacketBytesMax> packet{};
  const int size = link.write_packet(packet, timing, now);
  return {packet.begin(), packet.begin() + size};
}

std::vector<Bytes> take(Link& link, const Bytes& packet, Time now, const LinkTiming& timing) {
  std::vector<Bytes> messages;
  auto stream = link.receive(packet, timing, now);
  for (auto message = link.next_message(stream); !message.empty();
       message = link.next_message(stream)) {
    messages.emplace_back(message.begin(), message.end());
  }
  return messages;
}

/// A vector, all of whose reals have this byte.
Bytes vector_message(std::uint8_t label) {
  Bytes bytes(26, label);
  bytes[0] = static_cast<std::uint8_t>(wire::MessageType::kVector);
  return bytes;
}

void open(Link& a, Link& b, const LinkTiming& timing) {
  a.bring_up(0x1234, 0);
  b.bring_up(0xbeef, 0);
  while (a.has_packet(0) || b.has_packet(0)) {
    take(b, write(a, 0, timing), 0, timing);
    take(a, write(b, 0, timing), 0, timing);
  }
  ASSERT_EQ(a.state(), Link::State::kOpen);
  ASSERT_EQ(b.state(), Link::State::kOpen);
}

/// Who has a longer queue has more packets under way; whoever has none takes them all the same, and
/// those behind a lost one again.
TEST(LentLink, a_lent_queue_has_a_longer_window) {
  const LinkTiming timing = {.packet_bytes = wire::kPacketBytesMax};
  std::vector<std::uint8_t> lent(Link::kLentBytes, 0xee);
  for (const std::size_t lost : {std::size_t{99}, std::size_t{0}, std::size_t{7}}) {
    Link a;
    a.lend(lent.data());
    Link b;
    open(a, b, timing);
    std::uint8_t sent_count = 0;
    while (a.send(vector_message(sent_count))) {
      ++sent_count;
    }
    EXPECT_EQ(sent_count, (Link::kLentBytes - Link::kLentWindow) / 26);
    std::vector<Bytes> packets;
    for (Bytes packet = write(a, 0, timing); !packet.empty(); packet = write(a, 0, timing)) {
      packets.push_back(packet);
    }
    EXPECT_EQ(packets.size(), static_cast<std::size_t>(Link::kLentWindow));
    std::vector<Bytes> got;
    Time now = 0;
    const auto deliver = [&](const Bytes& packet) {
      for (const Bytes& message : take(b, packet, now, timing)) {
        got.push_back(message);
      }
    };
    for (std::size_t i = 0; i < packets.size(); ++i) {
      if (i != lost) {
        deliver(packets[i]);
      }
    }
    while (got.size() < sent_count && now < 100 * timing.retransmit_after) {
      now += timing.acknowledge_after;
      take(a, write(b, now, timing), now, timing);
      a.on_time(timing, false, now);
      for (Bytes packet = write(a, now, timing); !packet.empty(); packet = write(a, now, timing)) {
        deliver(packet);
      }
    }
    ASSERT_EQ(got.size(), sent_count);
    for (std::uint8_t i = 0; i < sent_count; ++i) {
      EXPECT_EQ(got[i], vector_message(i));
    }
  }
}

}  // namespace
}  // namespace holdfast::agent
