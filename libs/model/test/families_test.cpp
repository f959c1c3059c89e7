// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
// Named structures: counts by formula, and random growth as CPython 3's random.Random(1) draws it
// (its cells were printed by a Python program of ten lines, the definition of the family).
#include "holdfast/model/families.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <optional>
#include <set>
#include <utility>

#include "holdfast/base/algebra.hpp"
#include "holdfast/base/rng.hpp"
#include "holdfast/model/robot.hpp"

namespace holdfast::model {
namespace {

using base::at;
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

/// Random boxes in small structures are denied only if a walk through their cells finds no module.
TEST(Families, are_denied_only_where_no_cell_is) {
  std::size_t denied_count = 0;
  for (const FamilyInfo& info : families()) {
    const std::size_t size = std::max<std::size_t>(info.size_min, 9);
    const std::optional<CellBox> all = family_box(info.family, size);
    if (!all) {
      continue;
    }
    base::Rng rng(7);
    for (int i = 0; i < 2000; ++i) {
      const auto within = [&](std::int32_t low, std::int32_t high) {
        const auto begin = low + static_cast<std::int32_t>(rng.below(at(high - low)));
        const auto end = begin + 1 + static_cast<std::int32_t>(rng.below(at(high - begin)));
        return std::pair(begin, end);
      };
      const auto [x, x_end] = within(all->low.x, all->high.x);
      const auto [y, y_end] = within(all->low.y, all->high.y);
      const auto [z, z_end] = within(all->low.z, all->high.z);
      bool has_any = false;
      for (base::Cell cell = {x, y, z}; cell.z < z_end; ++cell.z) {
        for (cell.y = y; cell.y < y_end; ++cell.y) {
          for (cell.x = x; cell.x < x_end; ++cell.x) {
            has_any = has_any || family_has(info.family, size, cell);
          }
        }
      }
      const bool may_have = family_may_have(info.family, size, {{x, y, z}, {x_end, y_end, z_end}});
      EXPECT_TRUE(may_have || !has_any) << info.name << " from " << x << ' ' << y << ' ' << z;
      denied_count += may_have ? 0 : 1;
    }
  }
  EXPECT_GT(denied_count, 100U) << "the hollow of a shell and a portal";
}

}  // namespace holdfast::model
