// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
// What lines do to packets: closed forms for times, binomial statistics for noise.
#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <map>
#include <utility>

#include "robots.hpp"

namespace holdfast::sim {
namespace {

using Line = std::pair<std::int32_t, int>;

PacketLog log_of(const LinkModel& link, std::uint64_t seed, SimulationResult* result = nullptr) {
  const model::Robot robot = make_robot(cube(3));
  PacketLog log;
  Simulation simulation(robot, {.link = link, .seed = seed, .trace = &log});
  simulation.run();
  const SimulationResult found = simulation.result();
  EXPECT_TRUE(found.is_quiet);
  EXPECT_TRUE(found.all_agree);
  EXPECT_EQ(found.answer.verdict, agent::Verdict::kSafe);
  if (result != nullptr) {
    *result = found;
  }
  return log;
}

/// Five standard deviations of a binomial count: a failure by chance is one in a million.
void expect_rate(std::size_t count, std::size_t trials, double rate) {
  const auto n = static_cast<double>(trials);
  EXPECT_GT(trials, 5000U);
  EXPECT_NEAR(static_cast<double>(count), n * rate, 5 * std::sqrt(n * rate * (1 - rate)));
}

TEST(Lines, carry_one_packet_at_a_time) {
  const LinkModel link = blinky_blocks_v1();
  const PacketLog log = log_of(link, 1);
  std::map<Line, const SeenPacket*> last;
  std::map<Line, Time> burst_start;
  std::map<Line, Time> burst_time;  // Sum of the line times since then.
  Time burst_max = 0;
  for (const SeenPacket& packet : log.sent) {
    const Line line{packet.from, packet.face};
    ASSERT_EQ(packet.line_time, line_time(link, static_cast<int>(packet.bytes.size())));
    const SeenPacket* before = last[line];
    if (before != nullptr) {
      ASSERT_GE(packet.time, before->time + before->line_time);
    }
    if (before == nullptr || packet.time != before->time + before->line_time) {
      burst_start[line] = packet.time;
      burst_time[line] = 0;
    }
    // Back to back, n packets take the sum of their times.
    ASSERT_EQ(packet.time - burst_start[line], burst_time[line]);
    burst_time[line] += packet.line_time;
    burst_max = std::max(burst_max, burst_time[line]);
    last[line] = &packet;
  }
  // A message of six reals needs three packets: there were bursts.
  EXPECT_GE(burst_max, 3 * line_time(link, 5));
}

TEST(Lines, deliver_after_line_time_and_latency) {
  LinkModel link = blinky_blocks_v2();
  link.latency = 777;
  const PacketLog log = log_of(link, 1);
  std::map<std::uint64_t, const SeenPacket*> sent;
  for (const SeenPacket& packet : log.sent) {
    sent[packet.number] = &packet;
  }
  ASSERT_EQ(log.delivered.size(), log.sent.size());
  for (const SeenPacket& packet : log.delivered) {
    const SeenPacket& origin = *sent.at(packet.number);
    ASSERT_EQ(packet.time, origin.time + origin.line_time + 777);
    ASSERT_EQ(packet.bytes, origin.bytes);
    ASSERT_EQ(packet.from, origin.from);
    ASSERT_EQ(packet.face, origin.face);
  }
}

TEST(Lines, lose_packets_at_the_given_rate) {
  LinkModel link = unit();
  link.loss = 0.1;
  SimulationResult result;
  const PacketLog log = log_of(link, 3, &result);
  expect_rate(log.lost.size(), log.sent.size(), 0.1);
  EXPECT_EQ(result.lost_packets, log.lost.size());
  EXPECT_EQ(result.packets, log.sent.size());
}

TEST(Lines, double_packets_at_the_given_rate) {
  LinkModel link = unit();
  link.duplication = 0.2;
  const PacketLog log = log_of(link, 4);
  expect_rate(log.delivered.size() - log.sent.size(), log.sent.size(), 0.2);
}

TEST(Lines, flip_one_to_three_bits_at_the_given_rate) {
  LinkModel link = unit();
  link.corruption = 0.1;
  const PacketLog log = log_of(link, 5);
  std::map<std::uint64_t, const SeenPacket*> sent;
  for (const SeenPacket& packet : log.sent) {
    sent[packet.number] = &packet;
  }
  std::size_t corrupted = 0;
  for (const SeenPacket& packet : log.delivered) {
    const std::vector<std::uint8_t>& before = sent.at(packet.number)->bytes;
    ASSERT_EQ(packet.bytes.size(), before.size());
    int flipped = 0;
    for (std::size_t i = 0; i < before.size(); ++i) {
      flipped += std::popcount(static_cast<unsigned>(packet.bytes[i] ^ before[i]));
    }
    ASSERT_LE(flipped, 3);
    corrupted += flipped > 0 ? 1 : 0;
  }
  expect_rate(corrupted, log.delivered.size(), 0.1);
}

TEST(Lines, keep_packets_in_order_under_jitter) {
  LinkModel link = blinky_blocks_v1();
  link.jitter = 20'000;  // More than three packets.
  const PacketLog log = log_of(link, 6);
  std::map<Line, std::uint64_t> last;
  for (const SeenPacket& packet : log.delivered) {
    std::uint64_t& before = last[{packet.from, packet.face}];
    ASSERT_GE(packet.number, before);
    before = packet.number;
  }
}

TEST(Lines, let_packets_overtake_at_the_given_rate) {
  LinkModel link = blinky_blocks_v1();
  link.reordering = 0.1;
  link.reordering_delay = 30'000;
  const PacketLog log = log_of(link, 7);
  std::map<std::uint64_t, const SeenPacket*> sent;
  for (const SeenPacket& packet : log.sent) {
    sent[packet.number] = &packet;
  }
  std::size_t late = 0;
  std::size_t overtaken = 0;
  std::map<Line, std::uint64_t> newest;
  for (const SeenPacket& packet : log.delivered) {
    const SeenPacket& origin = *sent.at(packet.number);
    const Time delay = packet.time - origin.time - origin.line_time;
    ASSERT_LE(delay, 30'000U);
    late += delay > 0 ? 1 : 0;
    std::uint64_t& before = newest[{packet.from, packet.face}];
    overtaken += packet.number < before ? 1 : 0;
    before = std::max(before, packet.number);
  }
  expect_rate(late, log.sent.size(), 0.1);
  EXPECT_GT(overtaken, 10U);
}

TEST(Modules, send_only_after_computing) {
  // One packet at a time takes 5.99 ms; with 2 ms of computing for each event no answer comes
  // sooner than 2 ms after what caused it.
  LinkModel link = blinky_blocks_v1();
  SimulationResult quick;
  SimulationResult slow;
  log_of(link, 8, &quick);
  link.compute_time = 2'000;
  const PacketLog log = log_of(link, 8, &slow);
  EXPECT_GT(slow.verdict_time, quick.verdict_time);
  const model::Robot robot = make_robot(cube(3));
  std::map<std::int32_t, Time> busy_until;
  std::size_t delivered = 0;
  for (const SeenPacket& packet : log.sent) {
    // Deliveries up to and including this time; the sender is free again when it sends.
    for (; delivered < log.delivered.size() && log.delivered[delivered].time < packet.time;
         ++delivered) {
      const SeenPacket& seen = log.delivered[delivered];
      const auto& around = robot.neighbours()[static_cast<std::size_t>(seen.from)];
      busy_until[around[static_cast<std::size_t>(seen.face)]] = seen.time + 2'000;
    }
    ASSERT_GE(packet.time, busy_until[packet.from]);
  }
}

TEST(Modules, cope_with_clocks_that_drift) {
  LinkModel link = blinky_blocks_v1();
  link.clock_drift = 0.05;
  link.loss = 0.02;
  SimulationResult result;
  log_of(link, 9, &result);
  EXPECT_EQ(result.epoch, 1U);
}

TEST(Modules, cope_with_everything_at_once) {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    LinkModel link = blinky_blocks_v2();
    link.loss = link.duplication = link.reordering = link.corruption = 0.03;
    link.reordering_delay = 30'000;
    link.jitter = 5'000;
    link.clock_drift = 0.01;
    link.compute_time = 300;
    log_of(link, seed);
  }
}

}  // namespace
}  // namespace holdfast::sim
