// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "holdfast/host/team.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <bit>
#include <cmath>
#include <memory>
#include <thread>

#if __has_include(<sys/wait.h>) && !defined(__EMSCRIPTEN__)
#include <sys/wait.h>
#include <unistd.h>
#endif

namespace holdfast::host {
namespace {

// Whoever called the team hears of it, after everybody has ended, and the team works on.
TEST(Team, hands_on_what_is_thrown_in_a_thread) {
  for (const int thread_count : {1, 2, 4}) {
    Team team(thread_count);
    constexpr std::size_t kCount = 100 * Team::kChunk;
    for (const std::size_t bad : {std::size_t{0}, kCount / 2, kCount - 1}) {
      EXPECT_THROW(team.share(0, kCount,
                              [&](std::size_t begin, std::size_t end) {
                                if (begin <= bad && bad < end) {
                                  throw std::bad_alloc();
                                }
                              }),
                   std::bad_alloc);
      EXPECT_EQ(team.sum(kCount, [](std::size_t begin,
                                    std::size_t end) { return static_cast<double>(end - begin); }),
                static_cast<double>(kCount));
    }
  }
}

TEST(Team, TouchesEveryIndexOnceFromTheFirstToTheLast) {
  for (const int threads : {1, 2, 3, 7}) {
    Team team(threads);
    for (const std::size_t count : {std::size_t{0}, std::size_t{1}, Team::kChunk - 1, Team::kChunk,
                                    8 * Team::kChunk, std::size_t{100'003}}) {
      std::vector<int> touched(count + 5, 0);
      team.share(5, count + 5, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
          ++touched[i];
        }
      });
      for (std::size_t i = 0; i < touched.size(); ++i) {
        ASSERT_EQ(touched[i], i < 5 ? 0 : 1) << i << " of " << count << " on " << threads;
      }
    }
  }
}

TEST(Team, SumsHaveTheSameBitsWithAnyNumberOfThreads) {
  const auto harmonic = [](std::size_t begin, std::size_t end) {
    double sum = 0;
    for (std::size_t i = begin; i < end; ++i) {
      sum += 1 / static_cast<double>(i + 1);
    }
    return sum;
  };
  Team one(1);
  const double alone = one.sum(100'003, harmonic);
  EXPECT_NEAR(alone, std::log(100'003.5) + 0.57721566490153286, 1e-9);
  for (const int threads : {2, 3, 8}) {
    Team team(threads);
    EXPECT_EQ(std::bit_cast<std::uint64_t>(team.sum(100'003, harmonic)),
              std::bit_cast<std::uint64_t>(alone));
  }
}

/// Far more threads than cores, and loops so short that most come too late for theirs: they find
/// the chunks of a later one.
TEST(Team, ThreadsThatComeLateDoNoHarm) {
  Team team(17);
  constexpr std::size_t kCount = 9 * Team::kChunk + 1;
  std::vector<std::size_t> loop_of(kCount, 0);
  for (std::size_t loop = 1; loop <= 3000; ++loop) {
    team.share(0, kCount, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        loop_of[i] += loop_of[i] + 1 == loop ? 1 : 0;
      }
    });
  }
  EXPECT_EQ(std::ranges::count(loop_of, 3000U), static_cast<std::ptrdiff_t>(kCount));
}

/// Whether a new team finds the sum 1 + 2 + ... + n.
bool adds_up(int thread_count) {
  constexpr std::size_t kCount = 20 * Team::kChunk;
  const double sum = Team(thread_count).sum(kCount, [](std::size_t begin, std::size_t end) {
    double part = 0;
    for (std::size_t i = begin; i < end; ++i) {
      part += static_cast<double>(i + 1);
    }
    return part;
  });
  return sum == kCount * (kCount + 1) / 2;
}

/// Teams take over each other's threads, or find none.
TEST(Team, WorksOneAfterTheOtherAndManyAtOnce) {
  std::atomic<int> wrong_count{0};
  const auto ask = [&] {
    for (int turn = 0; turn < 200; ++turn) {
      wrong_count += adds_up(2 + turn % 2) ? 0 : 1;
    }
  };
  ask();
  std::vector<std::thread> askers;
  for (int i = 0; i < 4; ++i) {
    askers.emplace_back(ask);
  }
  for (std::thread& asker : askers) {
    asker.join();
  }
  EXPECT_EQ(wrong_count.load(), 0);
}

#if __has_include(<sys/wait.h>) && !defined(__EMSCRIPTEN__)
/// Returns when every thread of the team works: each waits in its first piece for all others, who
/// find pieces of their own, and nobody comes to a second one before.
void wait_for_threads(Team& team) {
  std::atomic<int> here{0};
  team.share(0, 100 * Team::kChunk, [&](std::size_t, std::size_t) {
    ++here;
    while (here.load() < team.thread_count()) {
      std::this_thread::yield();
    }
  });
}

/// The threads of a team do not follow it into a forked process. They are at rest at the fork: a
/// thread that is still starting may hold a lock of the allocator of clang's sanitizers, which
/// nobody opens again in the new process. (Unlike the C library's allocator, it knows nothing of
/// forks.)
TEST(Team, WorksInAForkedProcess) {
  EXPECT_TRUE(adds_up(3));
  auto team = std::make_unique<Team>(3);
  wait_for_threads(*team);
  const pid_t child = fork();
  if (child == 0) {
    alarm(200);  // Rather than wait for ever for threads that stayed behind.
    team.reset();
    _exit(adds_up(3) && adds_up(2) ? 0 : 1);
  }
  int status = 0;
  ASSERT_EQ(waitpid(child, &status, 0), child);
  EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 0);
}
#endif

}  // namespace
}  // namespace holdfast::host
