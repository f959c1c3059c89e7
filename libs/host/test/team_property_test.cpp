// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
// What holds for a team whatever its work: every index once, sums in the order of their chunks,
// and whatever is thrown. Sizes lie around the borders of chunks, data are random.
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <bit>
#include <cmath>
#include <random>
#include <stdexcept>
#include <string>
#include <vector>

#include "holdfast/host/team.hpp"

namespace holdfast::host {
namespace {

constexpr int kThreadMax = 8;

/// One below, at and one above so many chunks, and some sizes in between.
std::vector<std::size_t> sizes(std::mt19937_64& random) {
  std::vector<std::size_t> list = {0, 1};
  for (const std::size_t chunks : {1U, 2U, 3U, 4U, 5U, 8U, 9U, 64U}) {
    const std::size_t border = chunks * Team::kChunk;
    list.insert(list.end(), {border - 1, border, border + 1});
    list.push_back(border + random() % Team::kChunk);
  }
  return list;
}

/// Random values of either sign over forty decades: a sum in another order has other bits.
std::vector<double> random_values(std::size_t count, std::mt19937_64& random) {
  std::uniform_real_distribution<double> exponent(-20, 20);
  std::vector<double> values(count);
  for (double& value : values) {
    value = std::pow(10.0, exponent(random)) * (random() % 2 == 0 ? 1 : -1);
  }
  return values;
}

double sum_of(const std::vector<double>& values, std::size_t begin, std::size_t end) {
  double sum = 0;
  for (; begin < end; ++begin) {
    sum += values[begin];
  }
  return sum;
}

/// The chunks' sums one after the other, without a team.
double chunked_sum(const std::vector<double>& values) {
  double sum = 0;
  for (std::size_t begin = 0; begin < values.size(); begin += Team::kChunk) {
    sum += sum_of(values, begin, std::min(begin + Team::kChunk, values.size()));
  }
  return sum;
}

TEST(TeamProperties, a_sum_is_that_of_the_chunks_in_their_order_to_the_last_bit) {
  std::mt19937_64 random(1);
  for (const std::size_t size : sizes(random)) {
    const std::vector<double> values = random_values(size, random);
    const auto expected = std::bit_cast<std::uint64_t>(chunked_sum(values));
    for (int threads = 1; threads <= kThreadMax; ++threads) {
      Team team(threads);
      const double sum = team.sum(
          size, [&](std::size_t begin, std::size_t end) { return sum_of(values, begin, end); });
      EXPECT_EQ(std::bit_cast<std::uint64_t>(sum), expected) << size << " on " << threads;
    }
  }
}

/// Chunks lie where they lie whoever computes them: counted from the first index.
TEST(TeamProperties, a_loop_covers_every_index_once_in_ranges_that_begin_at_chunks) {
  std::mt19937_64 random(2);
  for (const std::size_t size : sizes(random)) {
    const std::size_t first = random() % 1000;
    for (int threads = 1; threads <= kThreadMax; ++threads) {
      Team team(threads);
      std::vector<std::atomic<int>> touched(first + size + 1);
      std::atomic<int> odd_count{0};
      team.share(first, first + size, [&](std::size_t begin, std::size_t end) {
        odd_count += (begin - first) % Team::kChunk == 0 && begin < end ? 0 : 1;
        for (std::size_t i = begin; i < end; ++i) {
          ++touched.at(i);
        }
      });
      EXPECT_EQ(odd_count, 0);
      for (std::size_t i = 0; i < touched.size(); ++i) {
        ASSERT_EQ(touched[i], i >= first && i < first + size ? 1 : 0) << i << " on " << threads;
      }
    }
  }
}

TEST(TeamProperties, a_map_has_a_value_for_every_chunk_in_their_order) {
  std::mt19937_64 random(3);
  for (const std::size_t size : sizes(random)) {
    for (int threads = 1; threads <= kThreadMax; ++threads) {
      Team team(threads);
      std::vector<std::pair<std::size_t, std::size_t>> chunks(7);  // What was there goes.
      team.map(size, chunks,
               [](std::size_t begin, std::size_t end) { return std::pair(begin, end); });
      ASSERT_EQ(chunks.size(), (size + Team::kChunk - 1) / Team::kChunk);
      for (std::size_t i = 0; i < chunks.size(); ++i) {
        EXPECT_EQ(chunks[i].first, i * Team::kChunk);
        EXPECT_EQ(chunks[i].second, std::min((i + 1) * Team::kChunk, size));
      }
    }
  }
}

/// One of several exceptions arrives, as it was thrown, when no thread works any more.
TEST(TeamProperties, one_of_what_is_thrown_arrives_after_all_have_ended) {
  for (int threads = 1; threads <= kThreadMax; ++threads) {
    Team team(threads);
    std::atomic<int> working{0};
    std::string message;
    try {
      team.share(0, 50 * Team::kChunk, [&](std::size_t begin, std::size_t) {
        ++working;
        const std::string own = "at " + std::to_string(begin);
        --working;
        throw std::runtime_error(own);
      });
    } catch (const std::runtime_error& error) {
      message = error.what();
    }
    EXPECT_EQ(working, 0);
    ASSERT_TRUE(message.starts_with("at ")) << message;
    EXPECT_EQ(std::stoul(message.substr(3)) % Team::kChunk, 0U);
  }
}

TEST(TeamProperties, a_team_is_as_large_as_asked_for_and_alone_with_little_to_share) {
  for (int threads = 1; threads <= kThreadMax; ++threads) {
    EXPECT_EQ(Team(threads).thread_count(), threads);
    EXPECT_EQ(Team(threads, Team::kSharedItemMin).thread_count(), threads);
    EXPECT_EQ(Team(threads, Team::kSharedItemMin - 1).thread_count(), 1);
  }
  EXPECT_EQ(Team(Team::kThreadCountMax + 1).thread_count(), Team::kThreadCountMax);
  EXPECT_GE(Team(0).thread_count(), 1);
  EXPECT_LE(Team(0).thread_count(), Team::kThreadCountMax);
}

}  // namespace
}  // namespace holdfast::host
