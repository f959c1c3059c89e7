// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "holdfast/host/interruption.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <stdexcept>
#include <thread>

#include "holdfast/host/team.hpp"

/// Work is given up when whoever is asked throws, on one thread and on several; afterwards
/// everything works as before.
namespace holdfast::host {
namespace {

struct Enough : std::runtime_error {
  Enough() : std::runtime_error("enough") {}
};

TEST(Interruption, asks_nobody_where_nobody_wants_to_be_asked) {
  EXPECT_FALSE(is_interruptible());
  ask_whether_to_go_on();
}

TEST(Interruption, asks_the_newest_and_then_the_one_before) {
  int outer = 0;
  int inner = 0;
  const Interruptible first([&] { ++outer; });
  {
    const Interruptible second([&] { ++inner; });
    ask_whether_to_go_on();
  }
  ask_whether_to_go_on();
  EXPECT_EQ(outer, 1);
  EXPECT_EQ(inner, 1);
}

class GivenUpLoop : public testing::TestWithParam<int> {};

/// Every chunk would take a millisecond, all of them ten seconds; it is given up after a few.
TEST_P(GivenUpLoop, ends_soon_on_all_threads_and_the_next_loop_is_whole) {
  constexpr std::size_t kCount = 10'000;
  Team team(GetParam());
  int asked = 0;
  std::atomic<int> done = 0;
  {
    const Interruptible interruptible([&] {
      if (++asked > 20) {
        throw Enough();
      }
    });
    EXPECT_THROW(team.share(0, kCount * Team::kChunk,
                            [&](std::size_t begin, std::size_t end) {
                              for (; begin < end; begin += Team::kChunk) {
                                ask_whether_to_go_on();
                                std::this_thread::sleep_for(std::chrono::milliseconds(1));
                                ++done;
                              }
                            }),
                 Enough);
  }
  EXPECT_LT(done, 1000);
  EXPECT_FALSE(is_interruptible());
  std::atomic<std::size_t> sum = 0;
  team.share(0, kCount * Team::kChunk,
             [&](std::size_t begin, std::size_t end) { sum += end - begin; });
  EXPECT_EQ(sum, kCount * Team::kChunk);
}

INSTANTIATE_TEST_SUITE_P(Threads, GivenUpLoop, testing::Values(1, 2, 5));

/// The thread that called has nothing to do but to wait for another one, which asks nobody; that
/// one is waited for, then it is heard.
TEST(Interruption, is_asked_while_it_waits_for_others) {
  Team team(2);
  int asked = 0;
  const std::thread::id caller = std::this_thread::get_id();
  const Interruptible interruptible([&] {
    if (++asked > 3) {
      throw Enough();
    }
  });
  std::atomic<bool> has_begun = false;
  EXPECT_THROW(team.share(0, 8 * Team::kChunk,
                          [&](std::size_t, std::size_t) {
                            if (std::this_thread::get_id() != caller) {
                              has_begun = true;
                              std::this_thread::sleep_for(std::chrono::milliseconds(50));
                            }
                            while (!has_begun) {
                              std::this_thread::yield();
                            }
                          }),
               Enough);
}

}  // namespace
}  // namespace holdfast::host
