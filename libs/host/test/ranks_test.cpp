// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "holdfast/host/ranks.hpp"

#include <gtest/gtest.h>

#include <limits>

namespace holdfast::host {
namespace {

TEST(SingleRank, says_what_it_is_told) {
  Ranks& single = single_rank();
  EXPECT_FALSE(single.is_shared());
  EXPECT_EQ(single.rank(), 0);
  EXPECT_EQ(single.count(), 1);
  for (const double x : {-1.5, 0.0, 1e300, std::numeric_limits<double>::infinity()}) {
    EXPECT_EQ(sum(single, x), x);
    EXPECT_EQ(max(single, x), x);
  }
  EXPECT_EQ(sum(single, std::array{1.0, -2.0}), (std::array{1.0, -2.0}));
  EXPECT_EQ(total(single, 20'000'000), 20'000'000U);
  for (const bool x : {false, true}) {
    EXPECT_EQ(any(single, x), x);
    EXPECT_EQ(all(single, x), x);
  }
}

TEST(SingleRank, gathers_its_own_items) {
  const std::vector<int> mine = {3, 1, 2};
  EXPECT_EQ(gather<int>(single_rank(), mine), mine);
  EXPECT_TRUE(gather<int>(single_rank(), std::vector<int>()).empty());
  EXPECT_EQ(starts(single_rank(), 7), (std::vector<std::size_t>{0, 7}));
}

TEST(SingleRank, has_no_copies_to_update) {
  std::vector<int> items = {1, 2};
  single_rank().make_halo(items.size(), {})->update(items.data(), sizeof(int));
  EXPECT_EQ(items, (std::vector<int>{1, 2}));
}

TEST(SingleRank, lets_a_task_iterate_until_it_is_over) {
  int iteration_count = 0;
  KrylovTask task;
  task.is_over = [](int iteration, double) { return iteration == 3; };
  task.iterate = [&](const KrylovTask::IsOver& is_over) {
    while (!is_over(iteration_count, 0)) {
      ++iteration_count;
    }
  };
  ASSERT_TRUE(single_rank().is_own_method(task));
  single_rank().watch(task);
  EXPECT_EQ(iteration_count, 3);
}

}  // namespace
}  // namespace holdfast::host
