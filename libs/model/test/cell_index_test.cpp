// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
//
// A hash table must answer like a sorted map, whatever collides: the same random insertions and
// questions go to both.
#include "holdfast/model/cell_index.hpp"

#include <gtest/gtest.h>

#include <map>

#include "holdfast/base/rng.hpp"

namespace holdfast::model {
namespace {

using base::Cell;

Cell random_cell(base::Rng& rng, std::uint64_t width) {
  const auto number = [&] {
    return static_cast<std::int32_t>(rng.below(width)) - static_cast<std::int32_t>(width / 2);
  };
  return {number(), number(), number()};
}

TEST(CellIndex, finds_nothing_while_empty) {
  const CellIndex index(0);
  EXPECT_EQ(index.find({0, 0, 0}), CellIndex::kNone);
  EXPECT_EQ(index.find({base::kCoordinateMax, -1, 7}), CellIndex::kNone);
}

TEST(CellIndex, keeps_the_first_index_of_a_cell) {
  CellIndex index(2);
  EXPECT_EQ(index.insert({1, 2, 3}, 5), CellIndex::kNone);
  EXPECT_EQ(index.insert({1, 2, 3}, 6), 5);
  EXPECT_EQ(index.find({1, 2, 3}), 5);
}

TEST(CellIndex, tells_coordinates_and_signs_apart) {
  CellIndex index(8);
  const Cell cells[] = {{1, 2, 3}, {3, 2, 1}, {2, 1, 3}, {-1, 2, 3}, {1, -2, 3}, {1, 2, -3}};
  std::int32_t next = 0;
  for (const Cell& cell : cells) {
    EXPECT_EQ(index.insert(cell, next++), CellIndex::kNone);
  }
  next = 0;
  for (const Cell& cell : cells) {
    EXPECT_EQ(index.find(cell), next++);
  }
  EXPECT_EQ(index.find({-1, -2, -3}), CellIndex::kNone);
}

/// Fills the index with the number of cells that it was made for, from dense to scattered.
void compare_with_map(std::uint64_t width, CellIndex index) {
  base::Rng rng(1);
  std::map<Cell, std::int32_t> expected;
  for (std::int32_t i = 0; expected.size() < 1000; ++i) {
    const Cell cell = random_cell(rng, width);
    const auto [place, is_new] = expected.try_emplace(cell, i);
    EXPECT_EQ(index.insert(cell, i), is_new ? CellIndex::kNone : place->second);
  }
  for (const auto& [cell, number] : expected) {
    EXPECT_EQ(index.find(cell), number);
  }
  for (int i = 0; i < 1000; ++i) {
    const Cell cell = random_cell(rng, width);
    const auto place = expected.find(cell);
    EXPECT_EQ(index.find(cell), place == expected.end() ? CellIndex::kNone : place->second);
  }
}

TEST(CellIndex, answers_like_a_map) {
  for (const std::uint64_t width : {14U, 40U, 1'999'999U}) {
    const auto half = static_cast<std::int32_t>(width / 2);
    compare_with_map(width, CellIndex(1000));
    compare_with_map(width, CellIndex(1000, {-half, -half, -half}, {half, half, half}));
  }
}

TEST(CellIndex, finds_nothing_outside_its_box) {
  CellIndex index(27, {-1, 4, 0}, {1, 6, 2});
  for (std::int32_t i = 0; i < 27; ++i) {
    index.insert({i % 3 - 1, i / 3 % 3 + 4, i / 9}, i);
  }
  EXPECT_EQ(index.find({1, 6, 2}), 26);
  for (const Cell& cell : {Cell{2, 5, 1}, Cell{-2, 5, 1}, Cell{0, 3, 1}, Cell{0, 7, 1},
                           Cell{0, 5, -1}, Cell{0, 5, 3}}) {
    EXPECT_EQ(index.find(cell), CellIndex::kNone);
  }
}

}  // namespace
}  // namespace holdfast::model
