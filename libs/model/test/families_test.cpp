// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
// Named structures: counts by formula, and random growth as CPython 3's random.Random(1) draws it
// (its cells were printed by a Python program of ten lines, the definition of the family).
#include "holdfast/model/families.hpp"

#include <gtest/gtest.h>

#include <set>

#include "holdfast/model/robot.hpp"

namespace holdfast::model {
namespace {

using base::Cell;

TEST(Families, are_robots_without_double_cells_and_as_many_as_the_formula_says) {
  for (const FamilyInfo& info : families()) {
    for (const std::size_t size : {info.size_min, std::size_t{9}, std::size_t{17}}) {
      if (size < info.size_min) {
        continue;
      }
      const std::vector<Cell> cells = family_cells(info.family, size);
      EXPECT_EQ(cells.size(), family_count(info.family, size)) << info.name << ' ' << size;
      const auto robot = Robot::create({.existing = cells, .lattice = info.lattice});
      EXPECT_TRUE(robot.has_value())
          << info.name << ' ' << size << ' ' << (robot ? "" : robot.error().message);
    }
  }
}

TEST(Families, have_the_sizes_of_the_published_comparison) {
  EXPECT_EQ(family_count(Family::kCube, 46), 97336U);
  EXPECT_EQ(family_count(Family::kScaffold, 61), 38656U);
  EXPECT_EQ(family_count(Family::kPortal, 200), 6272U);
  EXPECT_EQ(family_count(Family::kCube, kModuleCountMax + 1), ~std::size_t{0});
}

TEST(Families, growth_draws_as_python_does) {
  const std::vector<Cell> cells = family_cells(Family::kGrowth, 5000);
  const std::vector<Cell> first = {{0, 0, 0},  {0, -1, 0}, {-1, 0, 0}, {1, 0, 0},
                                   {2, 0, 0},  {1, -1, 0}, {0, 1, 0},  {2, 0, 1},
                                   {1, -1, 1}, {0, 0, 1},  {1, -1, 2}, {0, 2, 0}};
  EXPECT_EQ(std::vector<Cell>(cells.begin(), cells.begin() + 12), first);
  EXPECT_EQ(cells[4999], (Cell{11, 4, 5}));
}

TEST(Families, are_found_by_name) {
  EXPECT_EQ(find_family("portal"), Family::kPortal);
  EXPECT_EQ(find_family("castle"), std::nullopt);
}

}  // namespace
}  // namespace holdfast::model
