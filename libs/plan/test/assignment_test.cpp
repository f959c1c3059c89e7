// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
//
// Cheapest assignments beside all permutations; and large ones beside a second bound, the prices of
// an auction [Bertsekas 1988], which a matching of the same cost meets.
#include "slides/assignment.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <limits>
#include <numeric>

#include "holdfast/base/rng.hpp"
#include "seeds.hpp"

namespace holdfast::plan {
namespace {

std::vector<int> random_costs(std::size_t count, int most, base::Rng& rng) {
  std::vector<int> costs(count * count);
  for (int& cost : costs) {
    cost = static_cast<int>(rng.below(static_cast<std::uint64_t>(most) + 1));
  }
  return costs;
}

std::int64_t cheapest_of_all(std::span<const int> costs, std::size_t count) {
  std::vector<std::size_t> columns(count);
  std::iota(columns.begin(), columns.end(), std::size_t{0});
  std::int64_t best = std::numeric_limits<std::int64_t>::max();
  do {
    std::int64_t cost = 0;
    for (std::size_t row = 0; row < count; ++row) {
      cost += costs[row * count + columns[row]];
    }
    best = std::min(best, cost);
  } while (std::ranges::next_permutation(columns).found);
  return best;
}

/// Rows bid for columns, all costs scaled by count + 1 so that bids of 1 end at an optimum.
std::int64_t auction(std::span<const int> costs, std::size_t count) {
  const auto scale = static_cast<std::int64_t>(count) + 1;
  constexpr std::size_t kNobody = std::numeric_limits<std::size_t>::max();
  std::vector<std::int64_t> price(count);
  std::vector<std::size_t> owner(count, kNobody);
  std::vector<std::size_t> bidders(count);
  std::iota(bidders.begin(), bidders.end(), std::size_t{0});
  while (!bidders.empty()) {
    const std::size_t row = bidders.back();
    bidders.pop_back();
    std::int64_t best = std::numeric_limits<std::int64_t>::max();
    std::int64_t second = best;
    std::size_t wanted = 0;
    for (std::size_t column = 0; column < count; ++column) {
      const std::int64_t pays = costs[row * count + column] * scale + price[column];
      if (pays < best) {
        second = best;
        best = pays;
        wanted = column;
      } else {
        second = std::min(second, pays);
      }
    }
    price[wanted] += second - best + 1;
    if (owner[wanted] != kNobody) {
      bidders.push_back(owner[wanted]);
    }
    owner[wanted] = row;
  }
  std::int64_t cost = 0;
  for (std::size_t column = 0; column < count; ++column) {
    cost += costs[owner[column] * count + column];
  }
  return cost;
}

/// The assigned pairs are a permutation of the stated cost, and no permutation costs less than the
/// prices, which sum up to the same.
void expect_proved(const Assignment& found, std::span<const int> costs, std::size_t count) {
  std::vector<bool> is_taken(count);
  std::int64_t cost = 0;
  std::int64_t prices = 0;
  std::size_t overpriced = 0;
  for (std::size_t row = 0; row < count; ++row) {
    ASSERT_LT(found.column_of[row], count);
    EXPECT_FALSE(is_taken[found.column_of[row]]);
    is_taken[found.column_of[row]] = true;
    cost += costs[row * count + found.column_of[row]];
    prices += found.row_price[row] + found.column_price[row];
    for (std::size_t column = 0; column < count; ++column) {
      overpriced +=
          found.row_price[row] + found.column_price[column] > costs[row * count + column] ? 1 : 0;
    }
  }
  EXPECT_EQ(cost, found.cost);
  EXPECT_EQ(prices, found.cost);
  EXPECT_EQ(overpriced, 0U);
}

TEST(Assignment, of_few_is_the_cheapest_of_all_permutations) {
  base::Rng rng(1);
  const std::uint64_t case_count = holdfast::test::campaign(400U, 100U);
  for (std::uint64_t i = 0; i < case_count; ++i) {
    const std::size_t count = 1 + rng.below(7);
    const std::vector<int> costs = random_costs(count, i % 2 == 0 ? 3 : 100, rng);
    const Assignment found = assign(costs, count);
    EXPECT_EQ(found.cost, cheapest_of_all(costs, count)) << "case " << i;
    expect_proved(found, costs, count);
  }
}

TEST(Assignment, of_none_costs_nothing) { EXPECT_EQ(assign({}, 0).cost, 0); }

TEST(Assignment, of_many_is_that_of_an_auction) {
  base::Rng rng(2);
  for (const std::size_t count : {60U, 150U, 300U}) {
    for (const int most : {5, 1000}) {
      const std::vector<int> costs = random_costs(count, most, rng);
      const Assignment found = assign(costs, count);
      EXPECT_EQ(found.cost, auction(costs, count));
      expect_proved(found, costs, count);
    }
  }
}

TEST(Assignment, of_a_line_to_a_wall_pays_its_prices) {
  // Distances of cubes along a line to the cells of a standing square, many of them equal.
  constexpr int kSide = 15;
  constexpr std::size_t kCount = kSide * kSide;
  std::vector<int> costs;
  for (int row = 0; row < kSide * kSide; ++row) {
    for (int column = 0; column < kSide * kSide; ++column) {
      const int x = std::abs(row - column % kSide);
      const int z = column / kSide;
      costs.push_back(std::max({x, z, (x + z + 1) / 2}));
    }
  }
  const Assignment found = assign(costs, kCount);
  EXPECT_EQ(found.cost, auction(costs, kCount));
  expect_proved(found, costs, kCount);
}

}  // namespace
}  // namespace holdfast::plan
