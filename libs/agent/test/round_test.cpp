// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
//
// Which of two rounds is newer: serial number arithmetic [RFC1982], and a robot that has lived
// through more rounds than 16 bits can count.
#include "holdfast/agent/wire/round.hpp"

#include <gtest/gtest.h>

#include "test_network.hpp"

namespace holdfast::agent {
namespace {

using namespace holdfast::agent::test;

TEST(Rounds, what_follows_is_newer_all_around_the_circle) {
  std::uint16_t epoch = 0;
  for (int i = 0; i < 140'000; ++i) {
    const std::uint16_t next = epoch_after(epoch);
    EXPECT_NE(next, 0);
    EXPECT_TRUE(is_newer({.epoch = next, .starter = 1}, {.epoch = epoch, .starter = 2}));
    EXPECT_FALSE(is_newer({.epoch = epoch, .starter = 2}, {.epoch = next, .starter = 1}));
    epoch = next;
  }
}

/// Exactly one of two different rounds is newer, or modules would never agree.
TEST(Rounds, both_sides_think_the_same) {
  for (std::uint32_t a = 0; a <= 0xffff; a += 257) {
    for (std::uint32_t b = 0; b <= 0xffff; b += 16) {
      const Round first{.epoch = static_cast<std::uint16_t>(a), .starter = 7};
      const Round second{.epoch = static_cast<std::uint16_t>(b), .starter = 7};
      EXPECT_EQ(is_newer(first, second) + is_newer(second, first), a == b ? 0 : 1) << a << " " << b;
    }
  }
  EXPECT_TRUE(is_newer({.epoch = 0x8001, .starter = 7}, {.epoch = 1, .starter = 7}));
  EXPECT_TRUE(is_newer({.epoch = 3, .starter = 8}, {.epoch = 3, .starter = 7}));
  EXPECT_TRUE(is_newer({.epoch = 1, .starter = 7}, {.epoch = 0xffff, .starter = 7}));
  EXPECT_TRUE(is_newer({.epoch = 0xffff, .starter = 7}, {.epoch = 0, .starter = 9}));
}

/// Each time a connection opens and closes there is a new round, here more than 131,072 of them.
TEST(Rounds, a_robot_outlives_65_536_of_them_twice) {
  const auto setup = table_setup();
  TestNetwork network(setup, {{.cell = {0, 0, 0}}, {.cell = {1, 0, 0}}});
  ASSERT_TRUE(network.run());
  int wrap_count = 0;
  for (int i = 0; i < 200'000 && wrap_count < 2; ++i) {
    const std::uint16_t before = network.agent(0).epoch();
    network.reconnect(0, base::Direction::kPlusX);
    for (int tick = 0; tick < 9; ++tick) {
      network.tick();
    }
    wrap_count += network.agent(0).epoch() < before ? 1 : 0;
    if (i % 1000 == 0 || network.agent(0).epoch() < before) {
      ASSERT_TRUE(network.run()) << i;
      ASSERT_EQ(network.agent(0).epoch(), network.agent(1).epoch());
      ASSERT_EQ(network.agent(1).answer().verdict, Verdict::kSafe);
    }
  }
  EXPECT_EQ(wrap_count, 2);
}

/// A module that starts anew has heard of no round; it must not be left out because the others'
/// epoch looks older than none.
TEST(Rounds, a_module_that_starts_anew_joins_late_epochs) {
  const auto setup = table_setup();
  TestNetwork network(setup, {{.cell = {0, 0, 0}}, {.cell = {1, 0, 0}}, {.cell = {2, 0, 0}}});
  ASSERT_TRUE(network.run());
  for (int i = 0; network.agent(0).epoch() < 40'000; ++i) {
    ASSERT_LT(i, 60'000);
    network.reconnect(0, base::Direction::kPlusX);
    for (int tick = 0; tick < 9; ++tick) {
      network.tick();
    }
  }
  network.start(2);
  EXPECT_TRUE(network.run_anew());
  EXPECT_GT(network.agent(2).epoch(), 40'000);
}

}  // namespace
}  // namespace holdfast::agent
