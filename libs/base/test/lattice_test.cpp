// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
//
// What every lattice promises: opposite directions in pairs, neighbours one pitch away and nobody
// nearer, the same coordinates as VisibleSim's. The cubic one against the cells' own neighbours.
#include "holdfast/base/lattice.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "holdfast/base/double_double.hpp"

namespace holdfast::base {
namespace {

constexpr double kTolerance = 1e-15;

double distance(const std::array<double, 3>& a, const std::array<double, 3>& b) {
  return std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
}

class EveryLattice : public testing::TestWithParam<Lattice> {};

INSTANTIATE_TEST_SUITE_P(Lattices, EveryLattice,
                         testing::Values(kCubic, kFaceCentred, kHexagonal, kHexagonalPrism));

/// Cells in even and odd layers, above and below zero.
const std::array<Cell, 4> kSomewhere = {{{0, 0, 0}, {3, -5, 7}, {-2, 4, -3}, {1, 1, -8}}};

TEST_P(EveryLattice, has_opposite_directions_in_pairs) {
  for (const Direction direction : directions(GetParam())) {
    for (const Cell& cell : kSomewhere) {
      const Cell there = neighbour(GetParam(), cell, direction);
      EXPECT_EQ(neighbour(GetParam(), there, opposite(direction)), cell);
    }
    EXPECT_EQ(connector_class(GetParam(), direction),
              connector_class(GetParam(), opposite(direction)));
  }
}

TEST_P(EveryLattice, has_its_neighbours_one_pitch_away_along_unit_vectors) {
  for (const Cell& cell : kSomewhere) {
    std::set<Cell> seen;
    for (const Direction direction : directions(GetParam())) {
      const Cell there = neighbour(GetParam(), cell, direction);
      const auto from = node_place(GetParam(), cell);
      const auto to = node_place(GetParam(), there);
      const auto n = unit_vector(GetParam(), direction);
      EXPECT_NEAR(distance(from, to), 1, kTolerance * 20);
      EXPECT_NEAR(distance(to, {from[0] + n[0], from[1] + n[1], from[2] + n[2]}), 0,
                  kTolerance * 20);
      seen.insert(there);
    }
    EXPECT_EQ(seen.size(), directions(GetParam()).size());
  }
}

TEST_P(EveryLattice, has_no_other_cell_within_a_pitch) {
  const Lattice& lattice = GetParam();
  std::set<Cell> near;
  for (std::int32_t x = -3; x <= 3; ++x) {
    for (std::int32_t y = -3; y <= 3; ++y) {
      for (std::int32_t z = -3; z <= 3; ++z) {
        const double there = distance(node_place(lattice, {x, y, z}), {0, 0, 0});
        if (there > 0 && there < 1.0001) {
          near.insert({x, y, z});
        }
      }
    }
  }
  std::set<Cell> neighbours;
  for (const Direction direction : directions(lattice)) {
    neighbours.insert(neighbour(lattice, {}, direction));
  }
  if (lattice == kHexagonal) {  // Sheets beside each other touch, but are not connected.
    near.erase({0, 1, 0});
    near.erase({0, -1, 0});
  }
  EXPECT_EQ(near, neighbours);
}

TEST_P(EveryLattice, has_axial_coordinates_that_lead_back) {
  for (const Cell& cell : kSomewhere) {
    EXPECT_EQ(cell_of(GetParam(), axial_of(GetParam(), cell)), cell);
    for (const Direction direction : directions(GetParam())) {
      const Cell step = GetParam().steps[static_cast<std::size_t>(index(direction))];
      const Cell from = axial_of(GetParam(), cell);
      EXPECT_EQ(axial_of(GetParam(), neighbour(GetParam(), cell, direction)),
                (Cell{from.x + step.x, from.y + step.y, from.z + step.z}));
    }
  }
}

TEST_P(EveryLattice, has_a_direction_straight_down_for_floors) {
  const auto n = unit_vector(GetParam(), down(GetParam()));
  EXPECT_EQ(n, (std::array<double, 3>{0, 0, -1}));
  const std::size_t count = directions(GetParam()).size();
  EXPECT_EQ(facet_directions(GetParam()).size(),
            static_cast<std::size_t>(index(down(GetParam()))) < count ? count : count + 1);
}

/// VisibleSim shifts every other layer by half a cell: FCCLattice and HLattice.
TEST(FaceCentredLattice, has_odd_layers_half_a_cell_further) {
  for (const std::int32_t z : {-4, -1, 0, 1, 2, 5}) {
    const auto place = node_place(kFaceCentred, {2, 3, z});
    const double shift = z % 2 == 0 ? 0 : 0.5;
    EXPECT_NEAR(place[0], 2 + shift, kTolerance * 20);
    EXPECT_NEAR(place[1], 3 + shift, kTolerance * 20);
    EXPECT_NEAR(place[2], z * std::sqrt(0.5), kTolerance * 20);
  }
}

TEST(HexagonalLattice, has_odd_rows_half_a_cell_further) {
  for (const std::int32_t z : {-4, -1, 0, 1, 2, 5}) {
    const auto place = node_place(kHexagonal, {2, 0, z});
    EXPECT_NEAR(place[0], 2 + (z % 2 == 0 ? 0 : 0.5), kTolerance * 20);
    EXPECT_NEAR(place[2], z * std::sqrt(0.75), kTolerance * 20);
  }
}

TEST(Root, has_all_digits_of_either_type) {
  for (const double square : {0.25, 0.5, 0.75}) {
    EXPECT_NEAR(root(square), std::sqrt(square), kTolerance);
    const auto precise = root(DoubleDouble(square));
    EXPECT_NEAR(static_cast<double>(precise * precise - DoubleDouble(square)), 0, 1e-31);
  }
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
