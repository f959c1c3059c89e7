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

TEST(Families, to_begin_with_are_robots_of_every_size) {
  for (const Family family : {Family::kArch, Family::kCrane, Family::kStairs, Family::kWall}) {
    for (std::size_t size = family == Family::kArch ? 4 : 3; size < 70; ++size) {
      const std::vector<Cell> cells = family_cells(family, size);
      EXPECT_EQ(cells.size(), family_count(family, size)) << size;
      const auto robot = Robot::create({.existing = cells});
      EXPECT_TRUE(robot) << size << ' ' << (robot ? "" : robot.error().message);
    }
  }
}

TEST(Families, arch_stands_on_two_feet_and_is_as_wide_as_it_says) {
  for (const std::int32_t size : {8, 13, 40}) {
    const std::vector<Cell> cells = family_cells(Family::kArch, static_cast<std::size_t>(size));
    std::set<std::int32_t> feet;
    for (const Cell& cell : cells) {
      if (cell.z == 0) {
        feet.insert(cell.x);
      }
    }
    EXPECT_EQ(feet, (std::set<std::int32_t>{0, 1, size - 2, size - 1}));
    const auto is_mirrored = [&](const Cell& cell) {
      return std::ranges::find(cells, Cell{size - 1 - cell.x, cell.y, cell.z}) != cells.end();
    };
    EXPECT_TRUE(std::ranges::all_of(cells, is_mirrored)) << size;
  }
}

TEST(Families, crane_of_four_is_what_one_draws) {
  // From the side, y = 1: a jib of two to +x, a counter-jib of one, a mast on a foot.
  const std::vector<Cell> cells = family_cells(Family::kCrane, 4);
  std::vector<Cell> expected;
  for (std::int32_t y = 0; y < 3; ++y) {
    for (std::int32_t x = 0; x < 3; ++x) {
      expected.push_back({x, y, 0});
    }
  }
  expected.insert(expected.end(),
                  {{1, 1, 1}, {1, 1, 2}, {0, 1, 3}, {1, 1, 3}, {2, 1, 3}, {3, 1, 3}});
  EXPECT_EQ(cells, expected);
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
