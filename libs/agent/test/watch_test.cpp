// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
// The clock that ends every wait, docs/distributed.md, Watching. tests/distributed/watch_test.cpp
// breaks whole robots.
#include <gtest/gtest.h>

#include <algorithm>

#include "tampered_network.hpp"
#include "test_network.hpp"

namespace holdfast::agent::test {
namespace {

std::vector<Place> row(std::int32_t count) {
  std::vector<Place> places;
  for (std::int32_t x = 0; x < count; ++x) {
    places.push_back({.cell = {x, 0, 0}});
  }
  return places;
}

bool is_safe(const Agent& agent) { return agent.answer().verdict == Verdict::kSafe; }

bool is_undecided(const Agent& agent) { return agent.answer().verdict == Verdict::kUndecided; }

void run_ticks(TestNetwork& network, Time ticks) {
  for (Time i = 0; i < ticks; ++i) {
    network.tick();
  }
}

/// The sum of all waits of 8 ticks and twice, four and eight times as long: 5 + 2 + 4 + 14 x 8.
TEST(Watch, a_link_is_lost_after_all_its_retries) {
  EXPECT_EQ(lost_after({.retransmit_after = 8}), 8U * 123);
  EXPECT_EQ(lost_after({.retransmit_after = 8, .retry_count = 4, .lost_after_retries = 4}), 40U);
}

/// Once every ping_after and the time of a sweep, over each of the five links.
TEST(Watch, the_root_says_a_verdict_again_for_as_long_as_it_stands) {
  const auto setup = table_setup();
  TestNetwork network(setup, row(6));
  ASSERT_TRUE(network.run());
  int order_count = 0;
  network.watch = [&](std::size_t, base::Direction, std::span<const std::uint8_t> packet) {
    const bool is_data = packet[0] >> 6U == static_cast<int>(wire::PacketKind::kData);
    order_count += is_data && packet[2] == static_cast<int>(wire::MessageType::kOrder) &&
                           packet[3] == static_cast<int>(wire::Operation::kVerdict)
                       ? 1
                       : 0;
  };
  constexpr Time kTicks = 5'000;
  run_ticks(network, kTicks);
  EXPECT_TRUE(network.is_every(is_safe));
  EXPECT_LE(order_count, 5 * static_cast<int>(kTicks / setup.timing.ping_after));
  EXPECT_GE(order_count, 5 * static_cast<int>(kTicks / (setup.timing.ping_after + 4 * 6)));
}

TEST(Watch, an_undecided_verdict_is_said_once) {
  const auto setup = table_setup();
  auto places = row(6);
  places[4].is_mute = true;
  TestNetwork network(setup, places);
  ASSERT_TRUE(network.run_until(is_undecided));
  run_ticks(network, 1'000);
  // Both neighbours of the silent module greet it from time to time, and nobody says anything else.
  int packet_count = 0;
  int greeting_count = 0;
  network.watch = [&](std::size_t from, base::Direction, std::span<const std::uint8_t> packet) {
    ++packet_count;
    const bool is_greeting = packet[0] >> 6U != static_cast<int>(wire::PacketKind::kData);
    greeting_count += is_greeting && (from == 3 || from == 5) ? 1 : 0;
  };
  constexpr Time kTicks = 20'000;
  run_ticks(network, kTicks);
  EXPECT_EQ(packet_count, greeting_count);
  EXPECT_LE(greeting_count, 2 * static_cast<int>(kTicks / setup.timing.ping_after + 1));
}

/// Nobody says anything any more, and no link tells, as only the root would have sent.
TEST(Watch, without_the_root_a_verdict_ends_in_its_time) {
  const auto setup = table_setup();
  TestNetwork network(setup, row(7));
  ASSERT_TRUE(network.run());
  Time watch_time = 0;
  std::size_t root = 0;
  for (std::size_t i = 0; i < network.size(); ++i) {
    watch_time = std::max(watch_time, network.agent(i).watch_time());
    root = network.agent(i).is_root() ? i : root;
  }
  run_ticks(network, 3'000);
  EXPECT_TRUE(network.is_every(is_safe));
  network.mute(root);
  run_ticks(network, setup.timing.ping_after);
  EXPECT_TRUE(network.is_every(is_safe));
  run_ticks(network, watch_time);
  EXPECT_TRUE(network.is_every(is_undecided));
  EXPECT_EQ(network.agent(root == 0 ? 1 : 0).answer().reason, Reason::kNoAnswer);
}

/// Whatever held the waves up, and whatever a neighbour says: 10 retries a hop, and 32 W for a
/// sweep, behind a silence of 16 (ping_after + 8 retransmit_after).
TEST(Watch, no_wait_is_long_because_waves_were_or_are_said_to_have_been) {
  const LinkTiming timing;
  const Time silence = 16 * (timing.ping_after + 8 * timing.retransmit_after);
  for (const std::uint16_t hops : {std::uint16_t{0}, std::uint16_t{5}, std::uint16_t{65'535}}) {
    const Time most = 10 * (hops + Time{1}) * timing.retransmit_after;
    for (const Time waves : {Time{300'000}, Time{60'000'000}, Time{0xffff'ffff}}) {
      const Time expected = std::min(waves, most);
      Watch watch;
      watch.enter_round({.timing = timing, .now = 0});
      watch.enter_phase(Phase::kTree);
      watch.begin_order(wire::Operation::kPlan, hops, {.timing = timing, .now = waves});
      EXPECT_EQ(watch.wave_time(), expected);
      EXPECT_EQ(watch.at(), waves + silence + 32 * expected);
      watch.set_wave_time(static_cast<std::uint32_t>(waves), hops, timing);
      EXPECT_EQ(watch.verdict_time(timing), timing.ping_after + lost_after(timing) + 2 * expected);
    }
  }
}

/// A line that brings nothing for a while, and is not lost yet, in the middle of the waves.
TEST(Watch, waves_that_were_held_up_make_no_verdict_stand_longer) {
  const auto setup = table_setup();
  const LinkTiming& timing = setup.timing;
  const Time held_up = lost_after(timing) - timing.ping_after;
  TestNetwork network(setup, row(3));
  network.divert = [&](std::size_t from, base::Direction, std::span<const std::uint8_t>) {
    return from == 2 && network.now() > 15 && network.now() < held_up;
  };
  ASSERT_TRUE(network.run_until(is_safe));
  ASSERT_GT(network.now(), held_up);
  for (std::size_t i = 0; i < network.size(); ++i) {
    const Time longest = 2 * 10 * 3 * timing.retransmit_after;
    EXPECT_LE(network.agent(i).watch_time(), timing.ping_after + lost_after(timing) + longest);
    EXPECT_GT(held_up, longest / 2);  // Else nothing is seen.
  }
}

/// A module that crashes again and again begins a round each time; none comes to its end.
TEST(Watch, rounds_that_never_end_are_undecided_until_one_does) {
  const auto setup = table_setup();
  TestNetwork network(setup, row(6));
  ASSERT_TRUE(network.run());
  const auto crash_for = [&](int count) {
    for (int i = 0; i < count; ++i) {
      network.start(3);
      run_ticks(network, 40);
    }
  };
  crash_for(10);
  EXPECT_FALSE(network.is_every(is_undecided));
  crash_for(30);
  for (std::size_t i = 0; i < network.size(); ++i) {
    EXPECT_TRUE(i == 3 || is_undecided(network.agent(i))) << i;
  }
  EXPECT_TRUE(network.run_until(is_safe));
}

/// Retries so quick that the clock of the waves is 2,112 ticks, while they take 2,200 and more
/// here.
TEST(Watch, a_clock_that_was_too_short_changes_no_verdict) {
  auto setup = table_setup();
  setup.timing = {.acknowledge_after = 1, .retransmit_after = 4, .ping_after = 1};
  TestNetwork network(setup, row(560));
  bool was_early = false;
  ASSERT_TRUE(network.run_until([&](const Agent& agent) {
    was_early = was_early || agent.answer().reason == Reason::kNoAnswer;
    return agent.phase() == Phase::kDone && is_safe(agent);
  }));
  EXPECT_TRUE(was_early);
}

/// The last module of a row reports nothing, and says instead, without end, what a module that is
/// late may say: `appoint` of the first wave.
TEST(Watch, a_module_that_talks_without_end_is_not_waited_for_without_end) {
  const auto setup = table_setup();
  const Message late = from_hex("03 01 00 00 00 00 00 00");
  TamperedNetwork tampered(setup, row(4), 3, [](base::Direction, const Message& message) {
    const bool is_report = message[0] == static_cast<int>(wire::MessageType::kReport);
    return is_report ? std::vector<Message>{} : std::vector<Message>{message};
  });
  const auto is_over = [](const Agent& agent) { return agent.answer().verdict != Verdict::kNone; };
  constexpr Time kTicks = 400'000;
  Time ticks = 0;
  while (ticks < kTicks &&
         !(is_over(tampered.network().agent(0)) && is_over(tampered.network().agent(1)) &&
           is_over(tampered.network().agent(2)))) {
    tampered.tick();
    if (++ticks > 200) {
      tampered.say(base::Direction::kMinusX, late);
    }
  }
  EXPECT_LT(ticks, kTicks);
  EXPECT_GT(ticks, 65'535U);  // It was listened to for long, and was not refused.
  EXPECT_EQ(tampered.refused_count(), 0);
  for (const std::size_t module : {0U, 1U, 2U}) {
    EXPECT_TRUE(is_undecided(tampered.network().agent(module)));
  }
}

}  // namespace
}  // namespace holdfast::agent::test
