// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
//
// Where there is no order, what is said to make one possible does, and other ways are named where
// nothing but the ways bars it: every source beside a small robot is tried here.
#include "holdfast/plan/order_help.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <utility>
#include <vector>

#include "holdfast/base/lattice.hpp"
#include "holdfast/base/rng.hpp"
#include "seeds.hpp"

namespace holdfast::plan {
namespace {

using base::Cell;

TEST(OrderHelp, is_a_support_below_the_support_level_where_the_target_is_there) {
  // An arm of one module, 40 mm long, on another one that hangs from a fixed one: the topmost
  // connection carries 2 w + 2 w (40 mm) / (40 mm) = 4 w by Eq. (17), for a strength of 3 w. An
  // obstacle under the arm, or under the module that it is on, takes enough of that.
  model::RobotSpec target{.existing = {{0, 0, 0}, {0, 0, -1}, {1, 0, -1}}, .fixed = {{0, 0, 0}}};
  const double strength = 3 * model::module_weight_n(target.material);
  target.material.strength_vertical_n = target.material.strength_lateral_n = strength;
  const OrderTask task{.target = target};
  EXPECT_EQ(find_robot_order(task).value().order.outcome, OrderOutcome::kNone);
  const auto help = find_help(task);
  ASSERT_TRUE(help);
  ASSERT_EQ(help->supports.size(), 1U);
  EXPECT_EQ(help->supports[0].z, -2);
}

OrderOutcome outcome_of(const OrderTask& task) {
  return find_robot_order(task).value().order.outcome;
}

/// The free cells at or above the floor beside a robot of cubes.
std::set<Cell> cells_beside(const std::vector<Cell>& modules) {
  std::set<Cell> beside;
  for (const Cell& module : modules) {
    for (const base::Direction direction : base::kDirections) {
      if (const Cell cell = base::neighbour(module, direction);
          cell.z >= 0 && std::ranges::find(modules, cell) == modules.end()) {
        beside.insert(cell);
      }
    }
  }
  return beside;
}

/// Three to six cubes of full strength, grown at random from the floor.
std::vector<Cell> random_modules(base::Rng& rng) {
  std::set<Cell> cells = {{0, 0, 0}};
  const std::size_t count = 3 + rng.below(4);
  while (cells.size() < count) {
    auto from = cells.begin();
    std::advance(from, static_cast<std::ptrdiff_t>(rng.below(cells.size())));
    const Cell next = base::neighbour(*from, base::kDirections[rng.below(base::kDirectionCount)]);
    if (next.z >= 0) {
      cells.insert(next);
    }
  }
  return {cells.begin(), cells.end()};
}

/// An arch that holds, and whose beam breaks if all of it hangs on one leg.
TEST(OrderHelp, is_to_grow_in_pieces_where_that_suffices) {
  OrderTask task{.target = {.existing = {{0, 0, 0},
                                         {0, 0, 1},
                                         {0, 0, 2},
                                         {1, 0, 2},
                                         {2, 0, 2},
                                         {3, 0, 2},
                                         {4, 0, 2},
                                         {4, 0, 1},
                                         {4, 0, 0}}}};
  for (const auto& [strength_n, is_found] : {std::pair(0.3, false), std::pair(0.8, true)}) {
    task.target.material.strength_lateral_n = strength_n;
    task.in_pieces = true;
    ASSERT_EQ(outcome_of(task) == OrderOutcome::kFound, is_found);
    task.in_pieces = false;
    ASSERT_EQ(outcome_of(task), OrderOutcome::kNone);
    const auto help = find_help(task);
    EXPECT_EQ(help && help->in_pieces, is_found);
  }
  // Who asks for modules at the same instant cannot have pieces.
  task.group_size = 2;
  const auto help = find_help(task, {.seconds_max = 1});
  EXPECT_FALSE(help && help->in_pieces);
}

TEST(OrderHelp, names_another_source_where_modules_come_from_a_cell_of_the_target) {
  OrderTask task{.target = {.existing = {{0, 0, 0}, {0, 0, 1}, {1, 0, 1}}},
                 .rule = {.reach = Reach::kSurface, .source = Cell{1, 0, 1}}};
  ASSERT_EQ(outcome_of(task), OrderOutcome::kNone);
  const auto help = find_help(task);
  ASSERT_TRUE(help && help->rule);
  EXPECT_TRUE(help->supports.empty() && help->temporary.empty());
  EXPECT_EQ(help->rule->reach, Reach::kSurface);
  task.rule = *help->rule;
  EXPECT_EQ(outcome_of(task), OrderOutcome::kFound);
}

TEST(OrderHelp, names_free_ways_where_no_straight_one_leads_in) {
  // All of a box of 27 stands but the module in the middle.
  std::vector<Cell> box;
  for (std::int32_t i = 0; i < 27; ++i) {
    box.push_back({i % 3, i / 3 % 3, i / 9});
  }
  std::vector<Cell> hollow = box;
  std::erase(hollow, Cell{1, 1, 1});
  const OrderTask task{
      .target = {.existing = box}, .start = hollow, .rule = {.reach = Reach::kLine}};
  ASSERT_EQ(outcome_of(task), OrderOutcome::kNone);
  const auto help = find_help(task, {.seconds_max = 1});
  ASSERT_TRUE(help && help->rule);
  EXPECT_EQ(help->rule->reach, Reach::kFree);
  EXPECT_FALSE(help->rule->source);
}

TEST(OrderHelp, names_a_source_exactly_where_one_does) {
  std::size_t none_count = 0;
  std::size_t named_count = 0;
  for (std::uint64_t seed = 0; seed < test::campaign(60U); ++seed) {
    SCOPED_TRACE(seed);
    base::Rng rng(seed);
    const std::vector<Cell> modules = random_modules(rng);
    OrderTask task{
        .target = {.existing = modules},
        .rule = {.reach = Reach::kSurface, .source = modules[rng.below(modules.size())]}};
    if (outcome_of(task) != OrderOutcome::kNone) {
      continue;
    }
    ++none_count;
    const auto help = find_help(task, {.seconds_max = 20});
    const bool is_named = help && help->rule && help->rule->source;
    named_count += is_named ? 1 : 0;
    bool is_any = false;
    for (const Cell& source : cells_beside(modules)) {
      task.rule.source = source;
      const bool is_found = outcome_of(task) == OrderOutcome::kFound;
      is_any = is_any || is_found;
      EXPECT_TRUE(!is_named || is_found || *help->rule->source != source);
    }
    EXPECT_EQ(is_named, is_any);
  }
  EXPECT_GE(none_count, test::least(20U));
  EXPECT_GE(named_count, test::least(10U));
}

}  // namespace
}  // namespace holdfast::plan
