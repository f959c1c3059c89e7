// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "holdfast/host/team.hpp"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>

namespace holdfast::host {
namespace {

TEST(Team, TouchesEveryIndexOnceFromTheFirstToTheLast) {
  for (const int threads : {1, 2, 3, 7}) {
    Team team(threads);
    for (const std::size_t count : {0U, 1U, 511U, 512U, 4096U, 100'003U}) {
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

}  // namespace
}  // namespace holdfast::host
