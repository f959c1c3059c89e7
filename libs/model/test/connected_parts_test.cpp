// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
//
// Parts of random graphs against the reachability of all pairs.
#include "holdfast/model/connected_parts.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <utility>
#include <vector>

#include "holdfast/base/rng.hpp"
#include "holdfast/model/robot.hpp"

namespace holdfast::model {
namespace {

TEST(ConnectedParts, are_those_that_reach_each_other) {
  base::Rng rng(7);
  std::size_t list_count = 0;
  for (int round = 0; round < 200; ++round) {
    const std::size_t count = 1 + rng.below(12);
    std::vector<std::vector<bool>> reaches(count, std::vector<bool>(count));
    ConnectedParts parts(count);
    for (std::size_t i = 0; i < count; ++i) {
      reaches[i][i] = true;
    }
    for (std::uint64_t edges = rng.below(count + 3); edges > 0; --edges) {
      const std::size_t a = rng.below(count);
      const std::size_t b = rng.below(count);
      reaches[a][b] = reaches[b][a] = true;
      parts.join(static_cast<std::int32_t>(a), static_cast<std::int32_t>(b));
    }
    for (std::size_t k = 0; k < count; ++k) {
      for (std::size_t i = 0; i < count; ++i) {
        for (std::size_t j = 0; j < count; ++j) {
          reaches[i][j] = reaches[i][j] || (reaches[i][k] && reaches[k][j]);
        }
      }
    }
    std::vector<std::vector<std::int32_t>> expected;
    for (std::size_t i = 0; i < count; ++i) {
      std::vector<std::int32_t> list;
      for (std::size_t j = 0; j < count; ++j) {
        if (reaches[i][j]) {
          list.push_back(static_cast<std::int32_t>(j));
        }
      }
      EXPECT_EQ(parts.first_of(static_cast<std::int32_t>(i)), list.front());
      if (list.front() == static_cast<std::int32_t>(i)) {
        expected.push_back(std::move(list));
      }
    }
    EXPECT_EQ(parts.lists(), expected);
    list_count += expected.size();
  }
  EXPECT_GT(list_count, 200U);
}

TEST(ConnectedParts, of_a_robot_fall_apart_where_it_is_cut) {
  const Robot robot = Robot::create({.existing = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}}}).value();
  ConnectedParts parts = connected_parts(
      robot.connections(), 3,
      [&](std::size_t index, const Connection& pair) { return index != 0 && pair.a != 0; });
  EXPECT_EQ(parts.lists(), (std::vector<std::vector<std::int32_t>>{{0}, {1, 2}}));
  EXPECT_EQ(parts.lists(2), (std::vector<std::vector<std::int32_t>>{{0}, {1}}));
}

}  // namespace
}  // namespace holdfast::model
