// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
//
// What every lattice promises (opposite directions, neighbours one pitch away), and the cubic one
// against the cells' own neighbours.
#include "holdfast/base/lattice.hpp"

#include <gtest/gtest.h>

#include <set>

namespace holdfast::base {
namespace {

TEST(Lattice, has_opposite_directions_in_pairs) {
  for (int d = 0; d < kCubic.direction_count; ++d) {
    const auto direction = static_cast<Direction>(d);
    const Cell there = neighbour(kCubic, Cell{3, -5, 7}, direction);
    EXPECT_EQ(neighbour(kCubic, there, opposite(direction)), (Cell{3, -5, 7}));
    EXPECT_EQ(connector_class(kCubic, direction), connector_class(kCubic, opposite(direction)));
  }
}

TEST(Lattice, has_different_neighbours_one_pitch_away) {
  std::set<Cell> seen;
  for (int d = 0; d < kCubic.direction_count; ++d) {
    const auto direction = static_cast<Direction>(d);
    const auto [x, y, z] = unit_vector(kCubic, direction);
    EXPECT_EQ(x * x + y * y + z * z, 1);
    seen.insert(neighbour(kCubic, Cell{}, direction));
  }
  EXPECT_EQ(seen.size(), static_cast<std::size_t>(kCubic.direction_count));
}

TEST(CubicLattice, has_the_neighbours_of_cubes) {
  for (const Direction direction : kDirections) {
    EXPECT_EQ(neighbour(kCubic, Cell{3, -5, 7}, direction), neighbour(Cell{3, -5, 7}, direction));
    EXPECT_EQ(connector_class(kCubic, direction) == ConnectorClass::kVertical,
              is_vertical(direction));
  }
}

}  // namespace
}  // namespace holdfast::base
