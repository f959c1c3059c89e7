// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
//
// Two ends of a line, over a channel that loses, doubles, swaps and spoils packets. What must hold
// is said by link.hpp: messages arrive once, whole and in order, or the link is lost. Times are the
// default ones, in microseconds; expected times are sums of them, written out.
#include "holdfast/agent/wire/link.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <deque>
#include <set>
#include <vector>

#include "holdfast/base/rng.hpp"
#include "test_setup.hpp"

namespace holdfast::agent {
namespace {

using namespace holdfast::agent::test;
using Bytes = std::vector<std::uint8_t>;

constexpr Time kStep = 4'000;  // One packet of 17 bytes on a slow serial line.

Bytes write(Link& link, Time now, const LinkTiming& timing = {}) {
  std::array<std::uint8_t, wire::kPacketBytesMax> packet{};
  const int size = link.write_packet(packet, timing, now);
  return {packet.begin(), packet.begin() + size};
}

/// A message of random type and content.
Bytes random_message(base::Rng& rng) {
  int size = 0;
  Bytes bytes(2);
  while (size == 0) {
    bytes = {static_cast<std::uint8_t>(rng.below(10)), static_cast<std::uint8_t>(rng.below(16))};
    size = wire::message_bytes(bytes[0], bytes[1]);
  }
  while (bytes.size() < static_cast<std::size_t>(size)) {
    bytes.push_back(static_cast<std::uint8_t>(rng.next()));
  }
  return bytes;
}

/// A vector, all of whose reals have this byte.
Bytes vector_message(std::uint8_t label) {
  Bytes bytes(26, label);
  bytes[0] = static_cast<std::uint8_t>(wire::MessageType::kVector);
  return bytes;
}

std::vector<Bytes> take(Link& link, const Bytes& packet, Time now, const LinkTiming& timing = {}) {
  std::vector<Bytes> messages;
  auto stream = link.receive(packet, timing, now);
  for (auto message = link.next_message(stream); !message.empty();
       message = link.next_message(stream)) {
    messages.emplace_back(message.begin(), message.end());
  }
  return messages;
}

/// Open at both ends, nothing left to send.
void open(Link& a, Link& b, std::uint16_t nonce_a = 0x1234, std::uint16_t nonce_b = 0xbeef) {
  a.bring_up(nonce_a, 0);
  b.bring_up(nonce_b, 0);
  while (a.has_packet(0) || b.has_packet(0)) {
    take(b, write(a, 0), 0);
    take(a, write(b, 0), 0);
  }
  ASSERT_EQ(a.state(), Link::State::kOpen);
  ASSERT_EQ(b.state(), Link::State::kOpen);
}

/// Shares in percent of packets.
struct Faults {
  std::uint64_t lost = 0;
  std::uint64_t doubled = 0;
  std::uint64_t late = 0;  ///< Up to three packets later, so that others overtake it.
  std::uint64_t spoilt = 0;
};

/// Two links and two channels. Each end queues its messages as soon as there is room.
class Line {
 public:
  Line(const Faults& faults, const LinkTiming& timing, std::uint64_t seed)
      : faults_(faults), timing_(timing), rng_(seed) {
    for (End& end : ends_) {
      end.link.bring_up(static_cast<std::uint16_t>(rng_.next()), 0);
    }
  }

  struct End {
    Link link;
    std::deque<Bytes> to_send;
    std::vector<Bytes> got;
    std::vector<std::pair<Time, Bytes>> arriving;
  };

  End& end(std::size_t i) { return ends_[i]; }

  std::uint64_t full_count() const { return full_count_; }

  void step() {
    now_ += kStep;
    for (std::size_t i = 0; i < 2; ++i) {
      act(ends_[i], ends_[1 - i]);
    }
    for (End& end : ends_) {
      deliver(end);
    }
  }

 private:
  void act(End& end, End& other) {
    if (end.link.deadline(timing_, true) <= now_) {
      end.link.on_time(timing_, true, now_);
    }
    while (!end.to_send.empty()) {
      if (!end.link.send(end.to_send.front())) {
        ++full_count_;
        break;
      }
      end.to_send.pop_front();
    }
    if (!end.link.has_packet(now_)) {
      return;
    }
    const Bytes packet = write(end.link, now_, timing_);
    EXPECT_LE(packet.size(), static_cast<std::size_t>(timing_.packet_bytes));
    if (hits(faults_.lost)) {
      return;
    }
    for (int copy = hits(faults_.doubled) ? 2 : 1; copy > 0; --copy) {
      const Time delay = hits(faults_.late) ? rng_.below(4) : 0;
      other.arriving.emplace_back(now_ + delay * kStep, spoilt(packet));
    }
  }

  void deliver(End& end) {
    auto late = end.arriving;
    end.arriving.clear();
    for (auto& [at, packet] : late) {
      if (at > now_) {
        end.arriving.emplace_back(at, packet);
        continue;
      }
      for (const Bytes& message : take(end.link, packet, now_, timing_)) {
        end.got.push_back(message);
      }
    }
  }

  bool hits(std::uint64_t percent) { return rng_.below(100) < percent; }

  Bytes spoilt(Bytes packet) {
    if (hits(faults_.spoilt)) {
      for (std::uint64_t flips = 1 + rng_.below(3); flips > 0; --flips) {
        const std::uint64_t bit = rng_.below(8 * packet.size());
        packet[bit / 8] = static_cast<std::uint8_t>(packet[bit / 8] ^ (1U << (bit % 8)));
      }
    }
    return packet;
  }

  Faults faults_;
  LinkTiming timing_;
  base::Rng rng_;
  std::array<End, 2> ends_;
  Time now_ = 0;
  std::uint64_t full_count_ = 0;
};

void expect_all_arrives(const Faults& faults, int packet_bytes, std::uint64_t seed) {
  Line line(faults, {.packet_bytes = packet_bytes}, seed);
  base::Rng rng(seed);
  std::array<std::vector<Bytes>, 2> sent;
  for (std::size_t i = 0; i < 2; ++i) {
    for (int count = 0; count < 150; ++count) {
      sent[i].push_back(random_message(rng));
    }
    line.end(i).to_send.assign(sent[i].begin(), sent[i].end());
  }
  const auto is_done = [&] {
    return line.end(0).got.size() >= sent[1].size() && line.end(1).got.size() >= sent[0].size();
  };
  for (int steps = 0; steps < 100'000 && !is_done(); ++steps) {
    line.step();
  }
  for (int steps = 0; steps < 100; ++steps) {
    line.step();  // Doubles of the last packets must not bring anything any more.
  }
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_EQ(line.end(i).link.state(), Link::State::kOpen) << "seed " << seed;
    EXPECT_EQ(line.end(i).got, sent[1 - i]) << "seed " << seed;
    EXPECT_FALSE(line.end(i).link.take_restarted());
  }
  EXPECT_GT(line.full_count(), 0U);
}

TEST(Link, delivers_all_once_whole_and_in_order) {
  constexpr Faults kFaults[] = {{},           {.lost = 30},   {.doubled = 30},
                                {.late = 30}, {.spoilt = 30}, {20, 20, 20, 20}};
  for (const Faults& faults : kFaults) {
    for (std::uint64_t seed = 1; seed <= 10; ++seed) {
      expect_all_arrives(faults, wire::kPacketBytesMin, seed);
      expect_all_arrives(faults, wire::kPacketBytesMax, seed);
    }
  }
}

/// Bits i, j and k of a packet flipped; equal ones flip once.
Bytes flipped(Bytes packet, const std::set<std::size_t>& bits) {
  for (const std::size_t bit : bits) {
    packet[bit / 8] = static_cast<std::uint8_t>(packet[bit / 8] ^ (0x80U >> (bit % 8)));
  }
  return packet;
}

/// The polynomial finds up to three wrong bits in packets of these sizes; all of them are tried.
TEST(Link, refuses_every_full_packet_with_up_to_three_bits_flipped) {
  Link a;
  Link b;
  open(a, b);
  ASSERT_TRUE(a.send(vector_message(0x55)));
  const Bytes packet = write(a, 0);
  ASSERT_EQ(packet.size(), std::size_t{17});
  const LinkTiming timing;
  Bytes bad = packet;
  const auto flip = [&](std::size_t bit) {
    bad[bit / 8] = static_cast<std::uint8_t>(bad[bit / 8] ^ (0x80U >> (bit % 8)));
  };
  const std::size_t bit_count = 8 * packet.size();
  std::uint64_t accepted_count = 0;
  for (std::size_t i = 0; i < bit_count; ++i) {
    flip(i);
    for (std::size_t j = i; j < bit_count; ++j) {
      flip(j);  // Of i and j alike none is flipped, so that k alone is.
      for (std::size_t k = j + 1; k < bit_count; ++k) {
        flip(k);
        accepted_count += b.receive(bad, timing, 0).empty() ? 0U : 1U;
        flip(k);
      }
      accepted_count += i != j && !b.receive(bad, timing, 0).empty() ? 1U : 0U;
      flip(j);
    }
    flip(i);
  }
  EXPECT_EQ(accepted_count, 0U);
  EXPECT_EQ(b.state(), Link::State::kOpen);
  EXPECT_EQ(b.deadline(timing, false), kNever);
  EXPECT_EQ(b.receive(packet, timing, 0).size(), std::size_t{13});
}

/// The start value of the checksum depends on the kind of packet, so a flipped kind changes it. A
/// data packet as long as a greeting must not become one by up to three flips, in any session.
TEST(Link, takes_no_spoilt_packet_for_a_greeting) {
  const LinkTiming timing;
  base::Rng rng(7);
  int restart_count = 0;
  for (int session = 0; session < 200; ++session) {
    Link a;
    Link b;
    open(a, b, static_cast<std::uint16_t>(rng.next()), static_cast<std::uint16_t>(rng.next()));
    ASSERT_TRUE(a.send(from_hex("04 02 01")));
    ASSERT_TRUE(a.send(from_hex("05 0d")));
    const Bytes packet = write(a, 0);
    ASSERT_EQ(packet.size(), std::size_t{9});
    for (std::size_t j = 1; j < 72; ++j) {
      for (std::size_t k = j; k < 72; ++k) {
        b.receive(flipped(packet, {0, j, k}), timing, 0);
        restart_count += b.take_restarted() ? 1 : 0;
      }
    }
  }
  EXPECT_EQ(restart_count, 0);
}

/// Lets the deadline pass, again and again; the number of packets until the link is lost.
int count_packets_to_silence(Link& link, Time& now, const LinkTiming& timing) {
  int count = 0;
  while (link.state() != Link::State::kLost) {
    if (link.has_packet(now)) {
      count += write(link, now, timing).empty() ? 0 : 1;
    }
    const Time at = link.deadline(timing, true);
    EXPECT_NE(at, kNever);
    EXPECT_GE(at, now);
    now = at;
    link.on_time(timing, true, now);
  }
  return count;
}

/// One packet and 20 retries. They wait 50 ms five times (the first packet and 4 retries), then
/// 100 ms, 200 ms, and 400 ms for the 14 that are left: 6.15 s.
constexpr Time kSilence = 5 * 50'000 + 100'000 + 200'000 + 14 * 400'000;

TEST(Link, is_lost_after_twenty_greetings_without_an_answer) {
  Link link;
  Time now = 1'000;
  link.bring_up(1, now);
  EXPECT_EQ(count_packets_to_silence(link, now, {}), 21);
  EXPECT_EQ(now, 1'000 + kSilence);
  EXPECT_FALSE(link.is_used());
}

TEST(Link, is_lost_after_twenty_retries_without_an_acknowledgement) {
  Link a;
  Link b;
  open(a, b);
  ASSERT_TRUE(a.send(from_hex("05 0d")));
  Time now = 1'000;
  EXPECT_EQ(count_packets_to_silence(a, now, {}), 21);
  EXPECT_EQ(now, 1'000 + kSilence);
}

TEST(Link, is_lost_after_twenty_pings_without_an_answer) {
  Link a;
  Link b;
  open(a, b);
  Time now = 0;
  EXPECT_EQ(count_packets_to_silence(a, now, {}), 21);
  EXPECT_EQ(now, 2'000'000 + kSilence);
}

TEST(Link, other_limits_of_patience_are_kept) {
  Link link;
  Time now = 0;
  link.bring_up(1, now);
  const LinkTiming timing = {.retransmit_after = 10, .retry_count = 1, .lost_after_retries = 3};
  EXPECT_EQ(count_packets_to_silence(link, now, timing), 4);
  EXPECT_EQ(now, Time{10 + 10 + 20 + 40});
}

TEST(Link, a_quiet_open_link_that_nobody_watches_rests) {
  Link a;
  Link b;
  open(a, b);
  EXPECT_EQ(a.deadline({}, false), kNever);
  a.on_time({}, false, 1'000'000'000);
  EXPECT_FALSE(a.has_packet(1'000'000'000));
}

TEST(Link, pings_a_silent_neighbour_and_is_content_with_an_answer) {
  const LinkTiming timing;
  Link a;
  Link b;
  open(a, b);
  EXPECT_EQ(a.deadline(timing, true), timing.ping_after);
  a.on_time(timing, true, timing.ping_after);
  const Bytes ping = write(a, timing.ping_after);
  EXPECT_EQ(ping.size(), std::size_t{4});
  EXPECT_TRUE(take(b, ping, timing.ping_after).empty());
  ASSERT_TRUE(b.has_packet(timing.ping_after));
  take(a, write(b, timing.ping_after), timing.ping_after + kStep);
  EXPECT_EQ(a.deadline(timing, true), 2 * timing.ping_after + kStep);
}

TEST(Link, has_at_most_a_window_of_packets_under_way) {
  const LinkTiming timing;
  Link a;
  Link b;
  open(a, b);
  for (std::uint8_t i = 0; i < 10; ++i) {
    ASSERT_TRUE(a.send(vector_message(i)));
  }
  std::vector<Bytes> packets;
  while (a.has_packet(0)) {
    packets.push_back(write(a, 0));
  }
  EXPECT_EQ(packets.size(), static_cast<std::size_t>(Link::kWindow));
  take(b, packets[0], 0);
  take(b, packets[1], 0);
  take(a, write(b, timing.acknowledge_after), timing.acknowledge_after);
  for (int room = 0; room < 2; ++room) {
    ASSERT_TRUE(a.has_packet(timing.acknowledge_after));
    write(a, timing.acknowledge_after);
  }
  EXPECT_FALSE(a.has_packet(timing.acknowledge_after));
}

TEST(Link, fills_packets_of_every_size) {
  for (const int size : {wire::kPacketBytesMin, 64, wire::kPacketBytesMax}) {
    const LinkTiming timing = {.packet_bytes = size};
    Link a;
    Link b;
    open(a, b);
    for (std::uint8_t i = 0; i < 10; ++i) {
      ASSERT_TRUE(a.send(vector_message(i)));
    }
    std::size_t count = 0;
    const Bytes first = write(a, 0, timing);
    EXPECT_EQ(first.size(), static_cast<std::size_t>(size));
    for (Bytes packet = first; !packet.empty(); packet = write(a, 0, timing)) {
      count += take(b, packet, 0, timing).size();
    }
    const int payload = Link::kWindow * (size - 4);
    EXPECT_EQ(count, static_cast<std::size_t>(std::min(payload / 26, 10)));
  }
}

TEST(Link, notices_a_neighbour_that_has_started_again) {
  Link a;
  Link b;
  open(a, b);
  b.bring_up(0x7777, 0);
  take(a, write(b, 0), 0);
  EXPECT_TRUE(a.take_restarted());
  EXPECT_FALSE(a.take_restarted());  // Says so once.
  // Then both start again, as the agent does.
  a.bring_up(0x4321, 0);
  while (a.has_packet(0) || b.has_packet(0)) {
    take(a, write(b, 0), 0);
    take(b, write(a, 0), 0);
  }
  EXPECT_EQ(a.state(), Link::State::kOpen);
  EXPECT_EQ(b.state(), Link::State::kOpen);
  EXPECT_FALSE(a.take_restarted());
  EXPECT_FALSE(b.take_restarted());
  ASSERT_TRUE(a.send(vector_message(9)));
  take(b, write(a, 0), 0);
  EXPECT_EQ(take(b, write(a, 0), 0).size(), std::size_t{1});
}

/// The number that a greeting names as its sender's.
int greeted_number(const Bytes& greeting) { return greeting[2] | (greeting[3] << 8); }

TEST(Link, takes_another_number_than_the_last_one) {
  for (const bool goes_down : {false, true}) {
    Link link;
    link.bring_up(0x1234, 0);
    EXPECT_EQ(greeted_number(write(link, 0)), 0x1234);
    if (goes_down) {
      link.bring_down();
    }
    link.bring_up(0x1234, 0);
    EXPECT_EQ(greeted_number(write(link, 0)), 0x1235);
    link.bring_up(0, 0);
    EXPECT_EQ(greeted_number(write(link, 0)), 1);
    link.bring_up(0, 0);
    EXPECT_EQ(greeted_number(write(link, 0)), 2);
    link.bring_up(0xffff, 0);
    link.bring_up(0xffff, 0);
    EXPECT_EQ(greeted_number(write(link, 0)), 1);
  }
}

/// A module that has lost its memory draws the number of its last session, and its neighbour has
/// not noticed that it was away. Before, both thought the session went on, one at packet 9, the
/// other at packet 0.
TEST(Link, a_restart_with_the_same_number_is_noticed) {
  Link a;
  Link b;
  open(a, b);
  const Time now = 0;
  for (std::uint8_t i = 0; i < 9; ++i) {
    ASSERT_TRUE(a.send(vector_message(i)));
    take(b, write(a, now), now);
    take(a, write(b, now), now);
  }
  a = Link();
  a.bring_up(0x1234, now);
  bool has_noticed = false;
  for (int i = 0; i < 10; ++i) {
    take(b, write(a, now), now);
    if (b.take_restarted()) {
      has_noticed = true;
      b.bring_up(0xbeef, now);  // As bad: it must differ from its own last one.
    }
    take(a, write(b, now), now);
  }
  EXPECT_TRUE(has_noticed);
  EXPECT_FALSE(a.take_restarted());
  ASSERT_EQ(a.state(), Link::State::kOpen);
  ASSERT_EQ(b.state(), Link::State::kOpen);
  ASSERT_TRUE(a.send(vector_message(42)));
  ASSERT_TRUE(b.send(vector_message(43)));
  EXPECT_TRUE(take(b, write(a, now), now).empty());  // Each takes two packets.
  EXPECT_EQ(take(b, write(a, now), now), std::vector<Bytes>{vector_message(42)});
  EXPECT_TRUE(take(a, write(b, now), now).empty());
  EXPECT_EQ(take(a, write(b, now), now), std::vector<Bytes>{vector_message(43)});
}

TEST(Link, refuses_packets_of_an_old_session) {
  const LinkTiming timing;
  Link a;
  Link b;
  open(a, b);
  ASSERT_TRUE(a.send(from_hex("04 02 01")));
  const Bytes old = write(a, 0);
  open(a, b, 0x1111, 0x2222);
  EXPECT_TRUE(b.receive(old, timing, 0).empty());
  EXPECT_FALSE(b.has_packet(timing.acknowledge_after));  // Not even an acknowledgement.
  // Only one end is new.
  open(a, b, 0x1111, 0xbeef);
  EXPECT_TRUE(b.receive(old, timing, 0).empty());
  // And what a third module has meant for somebody else.
  Link c;
  Link d;
  open(c, d, 0x1111, 0xbee0);
  ASSERT_TRUE(c.send(from_hex("04 02 01")));
  EXPECT_TRUE(b.receive(write(c, 0), timing, 0).empty());
  ASSERT_TRUE(a.send(from_hex("04 02 01")));
  EXPECT_EQ(b.receive(write(a, 0), timing, 0).size(), std::size_t{3});
}

TEST(Link, ignores_other_versions_and_scraps) {
  const LinkTiming timing;
  Link a;
  Link b;
  a.bring_up(0x1234, 0);
  b.bring_up(0xbeef, 0);
  Bytes hello = write(a, 0);
  for (const unsigned version : {0U, 2U, 3U}) {
    Bytes other(hello.begin(), hello.end() - 2);
    other[1] = static_cast<std::uint8_t>(version << 6U);
    const std::uint16_t sum = wire::checksum(other, 0xffff);
    other.push_back(static_cast<std::uint8_t>(sum & 0xffU));
    other.push_back(static_cast<std::uint8_t>(sum >> 8U));
    b.receive(other, timing, 0);
  }
  for (std::size_t size = 0; size < hello.size(); ++size) {
    b.receive(std::span(hello).first(size), timing, 0);
  }
  EXPECT_EQ(to_hex(write(b, 0)).substr(3, 14), "40 ef be 00 00");  // It has heard of nobody.
}

/// Whatever has begun to leave arrives whole, the rest not at all, and what comes later as well.
TEST(Link, drops_whole_messages_only) {
  for (int packets_before = 0; packets_before <= Link::kWindow; ++packets_before) {
    for (const bool is_sent_again : {false, true}) {
      const LinkTiming timing;
      Link a;
      Link b;
      open(a, b);
      for (std::uint8_t label = 1; label <= 4; ++label) {
        ASSERT_TRUE(a.send(vector_message(label)));
      }
      std::vector<Bytes> got;
      for (int i = 0; i < packets_before; ++i) {
        const Bytes packet = write(a, 0);
        const auto messages = is_sent_again ? std::vector<Bytes>{} : take(b, packet, 0);
        got.insert(got.end(), messages.begin(), messages.end());
      }
      Time now = timing.retransmit_after;
      a.on_time(timing, false, is_sent_again ? now : 0);
      a.drop_unsent();
      ASSERT_TRUE(a.send(vector_message(9)));
      for (int i = 0; i < 50; ++i) {
        now += kStep;
        for (const Bytes& message : take(b, write(a, now), now)) {
          got.push_back(message);
        }
        take(a, write(b, now), now);
        a.on_time(timing, false, now);
      }
      std::vector<Bytes> expected;
      const int begun = (13 * packets_before + 25) / 26;  // 13 bytes a packet, 26 a message.
      for (int i = 1; i <= begun; ++i) {
        expected.push_back(vector_message(static_cast<std::uint8_t>(i)));
      }
      expected.push_back(vector_message(9));
      EXPECT_EQ(got, expected) << packets_before << " packets";
    }
  }
}

TEST(Link, a_full_queue_says_so_and_loses_nothing) {
  Link a;
  Link b;
  open(a, b);
  std::uint8_t label = 0;
  while (a.send(vector_message(label))) {
    ++label;
  }
  EXPECT_EQ(label, Link::kQueueBytes / 26);
  EXPECT_FALSE(a.send(vector_message(label)));
  ASSERT_TRUE(a.send(from_hex("05 0d")));  // A short one still fits.
  std::vector<Bytes> got;
  for (Time now = kStep; now < 100 * kStep; now += kStep) {
    for (const Bytes& message : take(b, write(a, now), now)) {
      got.push_back(message);
    }
    take(a, write(b, now), now);
  }
  ASSERT_EQ(got.size(), label + std::size_t{1});
  for (std::uint8_t i = 0; i < label; ++i) {
    EXPECT_EQ(got[i], vector_message(i));
  }
  EXPECT_EQ(got.back(), from_hex("05 0d"));
  EXPECT_TRUE(a.send(vector_message(label)));
}

TEST(Link, drops_what_is_sent_on_a_link_that_is_not_used) {
  Link link;
  EXPECT_TRUE(link.send(vector_message(1)));
  EXPECT_FALSE(link.has_packet(0));
  link.bring_up(5, 0);
  link.bring_down();
  EXPECT_EQ(link.state(), Link::State::kDown);
  EXPECT_TRUE(link.receive(from_hex("c0 40 34 12 00 00 00 00 77 8e"), {}, 0).empty());
  EXPECT_FALSE(link.has_packet(0));
  EXPECT_EQ(link.deadline({}, true), kNever);
}

TEST(Link, waits_for_an_open_link_before_it_sends_data) {
  Link link;
  link.bring_up(5, 0);
  ASSERT_TRUE(link.send(vector_message(1)));
  EXPECT_EQ(write(link, 0).size(), std::size_t{10});
  EXPECT_FALSE(link.has_packet(0));
}

/// Byte 7 of a greeting says what its sender is; cubes know cubes only.
TEST(Link, is_lost_to_modules_of_another_lattice) {
  for (const std::uint8_t lattice : {std::uint8_t{0}, std::uint8_t{1}, std::uint8_t{0xff}}) {
    Link link;
    link.bring_up(5, 0);
    std::vector<std::uint8_t> greeting = {0xc0, 0x40, 0x34, 0x12, 0, 0, 0, lattice};
    const std::uint16_t sum = wire::checksum(greeting, 0xffff);
    greeting.push_back(static_cast<std::uint8_t>(sum & 0xffU));
    greeting.push_back(static_cast<std::uint8_t>(sum >> 8U));
    EXPECT_TRUE(link.receive(greeting, {}, 0).empty());
    EXPECT_EQ(link.state() == Link::State::kLost, lattice != 0) << int{lattice};
  }
}

/// Catoms do the same: they know those of their own lattice only.
TEST(Link, of_another_lattice_is_lost_to_cubes) {
  const LinkTiming timing = {.lattice = wire::kFaceCentredLattice};
  for (const std::uint8_t lattice : {wire::kCubicLattice, wire::kFaceCentredLattice}) {
    Link other;
    other.bring_up(7, 0);
    std::vector<std::uint8_t> greeting(static_cast<std::size_t>(wire::kPacketBytesMax));
    const LinkTiming theirs = {.lattice = lattice};
    greeting.resize(static_cast<std::size_t>(other.write_packet(greeting, theirs, 0)));
    Link link;
    link.bring_up(5, 0);
    EXPECT_TRUE(link.receive(greeting, timing, 0).empty());
    EXPECT_EQ(link.state() == Link::State::kLost, lattice != timing.lattice) << int{lattice};
  }
}

/// A copy that is told the time too early behaves like one that is not.
void expect_idle_before_deadline(const Link& link, const LinkTiming& timing, Time now) {
  const Time at = link.deadline(timing, true);
  if (at <= now) {
    return;
  }
  const Time early = std::min(at - 1, now + 100'000'000);
  Link told = link;
  Link untold = link;
  told.on_time(timing, true, early);
  EXPECT_EQ(told.state(), untold.state());
  EXPECT_EQ(told.deadline(timing, true), at);
  EXPECT_EQ(told.has_packet(early), untold.has_packet(early));
  EXPECT_EQ(write(told, early), write(untold, early));
  if (at != kNever) {
    told = link;
    told.on_time(timing, true, at);
    EXPECT_TRUE(told.has_packet(at) || told.state() == Link::State::kLost);
  }
}

TEST(Link, has_nothing_to_do_before_its_deadline) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const LinkTiming timing = {.lost_after_retries = 5};
    Line line({.lost = 40}, timing, seed);
    base::Rng rng(seed);
    for (Time step = 1; step <= 400; ++step) {
      if (rng.below(10) == 0) {
        line.end(rng.below(2)).to_send.push_back(random_message(rng));
      }
      line.step();
      expect_idle_before_deadline(line.end(0).link, timing, step * kStep);
      expect_idle_before_deadline(line.end(1).link, timing, step * kStep);
    }
  }
}

TEST(Link, an_acknowledgement_waits_for_data_to_ride_on) {
  const LinkTiming timing;
  Link a;
  Link b;
  open(a, b);
  ASSERT_TRUE(a.send(from_hex("05 0d")));
  take(b, write(a, 0), 0);
  EXPECT_FALSE(b.has_packet(timing.acknowledge_after - 1));
  EXPECT_EQ(b.deadline(timing, true), timing.acknowledge_after);
  Link c = b;
  ASSERT_TRUE(b.send(from_hex("05 0e")));
  const Bytes data = write(b, 0);
  EXPECT_EQ(data.size(), std::size_t{6});
  EXPECT_FALSE(b.has_packet(timing.acknowledge_after));
  EXPECT_EQ(write(c, timing.acknowledge_after).size(), std::size_t{4});
  EXPECT_EQ(take(a, data, 0).size(), std::size_t{1});
  EXPECT_EQ(a.deadline(timing, false), timing.acknowledge_after);  // It does not send again.
}

/// Both may have been cut off from each other for long; nobody but they can find out that the line
/// carries again.
TEST(Link, greets_a_silent_neighbour_until_it_is_heard_again) {
  const LinkTiming timing;
  Link a;
  Link b;
  open(a, b);
  ASSERT_TRUE(a.send(vector_message(1)));
  Time now = 0;
  count_packets_to_silence(a, now, timing);
  Bytes greeting;
  for (int i = 0; i < 3; ++i) {
    EXPECT_FALSE(a.has_packet(now));
    EXPECT_EQ(a.deadline(timing, false), now + timing.ping_after);
    now += timing.ping_after;
    a.on_time(timing, false, now);
    greeting = write(a, now);
    EXPECT_EQ(greeting.size(), std::size_t{10});
  }
  take(b, greeting, now);
  EXPECT_FALSE(a.take_restarted());
  take(a, write(b, now), now);
  EXPECT_TRUE(a.take_restarted());
}

TEST(Link, does_not_greet_a_neighbour_that_has_said_what_it_must_not) {
  const LinkTiming timing;
  Link a;
  Link b;
  open(a, b);
  ASSERT_TRUE(a.send(vector_message(1)));
  write(a, 0);
  a.lose();
  EXPECT_FALSE(a.has_packet(0));
  EXPECT_EQ(a.deadline(timing, true), kNever);
}

/// Checksums are right, but what they guard is no message.
TEST(Link, garbage_in_the_stream_makes_it_lost) {
  for (const char* garbage : {"00 00", "15 00", "ff ff", "05 00", "05 7f", "06 ff"}) {
    Link link;
    const Bytes bytes = from_hex(garbage);
    std::span<const std::uint8_t> stream = bytes;
    EXPECT_TRUE(link.next_message(stream).empty());
    EXPECT_TRUE(stream.empty());
    EXPECT_EQ(link.state(), Link::State::kLost) << garbage;
  }
}

TEST(Link, random_bytes_in_the_stream_do_no_harm) {
  base::Rng rng(11);
  for (int round = 0; round < 2000; ++round) {
    Link link;
    Link peer;
    open(link, peer);
    while (link.state() != Link::State::kLost) {
      Bytes bytes(1 + rng.below(13));
      std::generate(bytes.begin(), bytes.end(),
                    [&] { return static_cast<std::uint8_t>(rng.next()); });
      std::span<const std::uint8_t> stream = bytes;
      while (!link.next_message(stream).empty()) {
      }
    }
    EXPECT_FALSE(link.is_used());
  }
}

TEST(Link, sequence_numbers_wrap) {
  const LinkTiming timing;
  Link a;
  Link b;
  open(a, b);
  std::size_t count = 0;
  for (Time i = 1; i <= 300; ++i) {
    ASSERT_TRUE(a.send(from_hex("05 0d")));
    count += take(b, write(a, i * kStep), i * kStep).size();
    take(a, write(b, i * kStep + timing.acknowledge_after), i * kStep + timing.acknowledge_after);
  }
  EXPECT_EQ(count, std::size_t{300});
}

}  // namespace
}  // namespace holdfast::agent
