// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
//
// The cubic lattice: six face directions that come in opposite pairs, one step each. The steps are
// written out by hand in the order of the enumerators.
#include "holdfast/base/cell.hpp"

#include <gtest/gtest.h>

#include <set>

namespace holdfast::base {
namespace {

constexpr Cell kSteps[kDirectionCount] = {{1, 0, 0},  {-1, 0, 0}, {0, 1, 0},
                                          {0, -1, 0}, {0, 0, 1},  {0, 0, -1}};

TEST(Cell, has_a_neighbour_one_step_away_in_every_direction) {
  const Cell cell{3, -5, 7};
  for (const Direction direction : kDirections) {
    const Cell step = kSteps[index(direction)];
    EXPECT_EQ(neighbour(cell, direction), (Cell{3 + step.x, -5 + step.y, 7 + step.z}));
  }
}

TEST(Cell, is_the_neighbour_of_its_neighbour_in_the_opposite_direction) {
  const Cell cell{-1, 2, 0};
  for (const Direction direction : kDirections) {
    EXPECT_NE(opposite(direction), direction);
    EXPECT_EQ(opposite(opposite(direction)), direction);
    EXPECT_EQ(neighbour(neighbour(cell, direction), opposite(direction)), cell);
  }
}

TEST(Cell, can_have_neighbours_outside_the_allowed_range) {
  const Cell corner{kCoordinateMax, -kCoordinateMax, kCoordinateMax};
  EXPECT_EQ(neighbour(corner, Direction::kPlusX).x, 1'000'001);
  EXPECT_EQ(neighbour(corner, Direction::kMinusY).y, -1'000'001);
  EXPECT_EQ(neighbour(corner, Direction::kPlusZ).z, 1'000'001);
}

TEST(Cell, is_ordered_by_x_then_y_then_z) {
  EXPECT_LT((Cell{0, 9, 9}), (Cell{1, 0, 0}));
  EXPECT_LT((Cell{1, 0, 9}), (Cell{1, 1, 0}));
  EXPECT_LT((Cell{1, 1, -1}), (Cell{1, 1, 0}));
  EXPECT_EQ((Cell{1, 2, 3}), (Cell{1, 2, 3}));
}

TEST(Direction, lists_six_different_ones_by_index) {
  std::set<Direction> seen;
  for (int i = 0; i < kDirectionCount; ++i) {
    const Direction direction = kDirections[static_cast<std::size_t>(i)];
    EXPECT_EQ(index(direction), i);
    seen.insert(direction);
  }
  EXPECT_EQ(seen.size(), 6U);
}

TEST(Direction, is_vertical_along_z_only) {
  for (const Direction direction : kDirections) {
    EXPECT_EQ(is_vertical(direction), kSteps[index(direction)].z != 0);
  }
}

}  // namespace
}  // namespace holdfast::base
