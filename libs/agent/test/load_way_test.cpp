// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
//
// What a way would carry: eight numbers against every connection by itself, and bounds against a
// weight that two ways share, for which the closed form is known.
#include "holdfast/agent/free_faces/load_way.hpp"

#include <gtest/gtest.h>

#include <vector>

#include "holdfast/agent/cells/occupied_cells.hpp"
#include "holdfast/base/rng.hpp"
#include "holdfast/mechanics/connector.hpp"
#include "test_setup.hpp"

namespace holdfast::agent::test {
namespace {

using base::Cell;
using base::Direction;

struct Step {
  Cell cell;
  Direction direction;
  MiddleLoad now;
};

/// Outward from the root's cell, in any directions.
std::vector<Step> random_way(base::Rng& rng) {
  std::vector<Step> way;
  Cell cell = {};
  for (std::uint64_t i = 2 + rng.below(20); i > 0; --i) {
    const Direction outward = base::kDirections[rng.below(6)];
    cell = base::neighbour(cell, outward);
    const auto load = [&](double most) {
      return most * (static_cast<double>(rng.below(2001)) - 1000) / 1000;
    };
    way.push_back(
        {.cell = cell,
         .direction = base::opposite(outward),
         .now = {.axial_n = load(5), .bending_x_nmm = load(200), .bending_y_nmm = load(200)}});
  }
  return way;
}

/// Eq. (17) with the lever arms written out, in the global frame.
double ratio_with(const Setup& setup, const Step& step, const Cell& module) {
  const double pitch = setup.section.length;
  const Cell inner = base::neighbour(step.cell, step.direction);
  const double x = pitch * (module.x - (step.cell.x + inner.x) / 2.0);
  const double y = pitch * (module.y - (step.cell.y + inner.y) / 2.0);
  const base::Vec6<double> added = mechanics::to_local<double>(
      step.direction, {0, 0, -setup.weight_n, -setup.weight_n * y, setup.weight_n * x, 0});
  const base::Vec6<double> middle = {0,
                                     0,
                                     step.now.axial_n + added[2],
                                     step.now.bending_x_nmm + added[3],
                                     step.now.bending_y_nmm + added[4],
                                     0};
  return mechanics::load_ratio(
      mechanics::connection_load(middle), setup.facet_mm,
      base::is_vertical(step.direction) ? setup.strength_vertical_n : setup.strength_lateral_n);
}

TEST(CarriedLoad, is_that_of_the_worst_connection_wherever_the_module_is) {
  const auto setup = table_setup();
  base::Rng rng(5);
  for (int round = 0; round < 200; ++round) {
    const std::vector<Step> way = random_way(rng);
    CarriedLoad load;
    for (const Step& step : way) {
      load.pass(setup, step.cell, step.direction, step.now);
    }
    const auto coordinate = [&] { return static_cast<std::int32_t>(rng.below(41)) - 20; };
    const Cell module = {coordinate(), coordinate(), coordinate()};
    double worst = -1e20;
    for (const Step& step : way) {
      worst = std::max(worst, ratio_with(setup, step, module));
    }
    EXPECT_NEAR(load.ratio_with(setup, module), worst, 1e-5 * (1 + std::abs(worst)));
  }
}

TEST(CarriedLoad, of_one_hanging_module_is_its_weight_and_half_a_cell) {
  const auto setup = table_setup();
  const double lateral = setup.weight_n / setup.strength_lateral_n;
  const double vertical = setup.weight_n / setup.strength_vertical_n;
  EXPECT_NEAR(hanging_ratio(setup, Direction::kPlusY), lateral, 1e-6);
  EXPECT_NEAR(hanging_ratio(setup, Direction::kMinusZ), -vertical, 1e-6);  // It stands on top.
  EXPECT_NEAR(hanging_ratio(setup, Direction::kPlusZ), vertical, 1e-6);
}

/// Two equal rows hold a module between them, at first without load. By symmetry each takes half of
/// a weight in its middle; the way takes all to one side, and the bound may not be below the truth.
TEST(LoadWay, bounds_what_two_ways_share) {
  const auto setup = table_setup();
  LoadWay way = LoadWay::certain();
  for (std::int32_t x = 1; x <= 3; ++x) {
    way.pass(setup, {x, 0, 0}, Direction::kMinusX, {}, false);
  }
  // A beam of length 2 l held at both ends, loaded in its middle: moment w l / 4 at the ends.
  const double half_mm = 3 * setup.section.length;
  const double truth =
      2 * (setup.weight_n * half_mm / 4) / setup.facet_mm / setup.strength_lateral_n;
  const double bound = way.bound_with(setup, {3, 0, 1}, 0);
  EXPECT_GE(bound, truth);
  EXPECT_LT(bound, 8 * truth);
  EXPECT_FALSE(way.is_certain());
}

TEST(LoadWay, comes_through_messages_as_it_was) {
  const auto setup = table_setup();
  LoadWay sent = LoadWay::from_foot(setup, {2, -1, 0},
                                    {.axial_n = -3, .bending_x_nmm = 5, .bending_y_nmm = -7});
  sent.pass(setup, {2, -1, 1}, Direction::kMinusZ, {.axial_n = -2}, false);
  sent.pass(setup, {3, -1, 1}, Direction::kMinusX, {.bending_y_nmm = 30}, true);
  LoadWay come;
  float elsewhere = kNoLoadRatio;
  for (int part = 0; part < sent.part_count(); ++part) {
    ASSERT_LT(part, come.part_count());
    elsewhere = std::max(elsewhere, come.take_part(part, sent.part(part, 0.25F)));
  }
  EXPECT_EQ(elsewhere, 0.25F);
  EXPECT_FALSE(come.is_certain());
  const Cell cell = {4, -1, 1};
  EXPECT_NEAR(come.alone_with(setup, cell), sent.alone_with(setup, cell), 1e-6);
  EXPECT_NEAR(come.bound_with(setup, cell, 0.3), sent.bound_with(setup, cell, 0.3), 1e-5);
  EXPECT_NEAR(come.tension_with(setup, cell, 1), sent.tension_with(setup, cell, 1), 1e-4);
}

TEST(OccupiedCells, are_in_their_box_and_nowhere_else) {
  OccupiedCells cells;
  const Cell first = {-3, 4, 0};
  const Cell last = {5, 9, 7};
  ASSERT_TRUE(OccupiedCells::fits(first, last));
  cells.begin(first, last);
  EXPECT_EQ(cells.part_count(), 3);  // 9 x 6 x 8 cells, 192 to a part.
  cells.add(first);
  cells.add(last);
  cells.add({0, 5, 3});
  std::vector<Cell> seen;
  cells.visit([&](const Cell& cell) { seen.push_back(cell); });
  EXPECT_EQ(seen, (std::vector<Cell>{first, {0, 5, 3}, last}));
  EXPECT_FALSE(cells.has({6, 9, 7}));
  EXPECT_FALSE(cells.has({-3, 4, -1}));
  EXPECT_FALSE(OccupiedCells::fits({0, 0, 0}, {20, 20, 20}));
  EXPECT_FALSE(OccupiedCells::fits({0, 0, 0}, {-1, 0, 0}));
  EXPECT_TRUE(OccupiedCells::fits({0, 0, 0}, {8191, 0, 0}));
}

}  // namespace
}  // namespace holdfast::agent::test
