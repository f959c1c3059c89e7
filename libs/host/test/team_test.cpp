// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "holdfast/host/team.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>

namespace holdfast::host {
namespace {

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

}  // namespace
}  // namespace holdfast::host
