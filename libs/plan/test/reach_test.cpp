// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
//
// A box of 3 x 3 x 3 around one cell, closed or with a shaft to it from above: which cells a module
// can get to is plain to see.
#include "holdfast/plan/reach.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace holdfast::plan {
namespace {

using base::Cell;

/// All cells of the box but its middle.
model::RobotSpec box() {
  model::RobotSpec spec;
  for (std::int32_t x = 0; x < 3; ++x) {
    for (std::int32_t y = 0; y < 3; ++y) {
      for (std::int32_t z = 0; z < 3; ++z) {
        if (x != 1 || y != 1 || z != 1) {
          spec.existing.push_back({x, y, z});
        }
      }
    }
  }
  return spec;
}

ElementSet all_but(const model::RobotSpec& spec, const std::vector<Cell>& absent) {
  ElementSet state(spec.existing.size());
  for (std::size_t i = 0; i < spec.existing.size(); ++i) {
    if (std::ranges::find(absent, spec.existing[i]) == absent.end()) {
      state.insert(static_cast<Element>(i));
    }
  }
  return state;
}

TEST(Reach, by_a_line_needs_one_way_that_is_free_all_along) {
  const model::RobotSpec spec = box();
  const ReachFinder lines(spec, {.reach = Reach::kLine});
  EXPECT_FALSE(lines.can_reach(all_but(spec, {}), {1, 1, 1}));
  EXPECT_TRUE(lines.can_reach(all_but(spec, {{1, 1, 2}}), {1, 1, 1}));
  // From below there is the floor.
  EXPECT_FALSE(lines.can_reach(all_but(spec, {{1, 1, 0}}), {1, 1, 1}));
  model::RobotSpec raised = spec;
  raised.support_z = std::nullopt;
  EXPECT_TRUE(ReachFinder(raised, {.reach = Reach::kLine})
                  .can_reach(all_but(raised, {{1, 1, 0}}), {1, 1, 1}));
  // A lid far above closes the shaft.
  model::RobotSpec lidded = spec;
  lidded.obstacles = {{.from = {1, 1, 9}, .to = {1, 1, 9}}};
  EXPECT_FALSE(ReachFinder(lidded, {.reach = Reach::kLine})
                   .can_reach(all_but(lidded, {{1, 1, 2}}), {1, 1, 1}));
}

/// What is to be avoided bars ways as an obstacle does that nothing rests on.
TEST(Reach, is_barred_by_cells_to_be_avoided_as_by_obstacles) {
  const model::RobotSpec spec = box();
  const std::vector<std::vector<Cell>> avoided = {
      {{1, 1, 9}}, {{1, 1, 3}}, {{-1, 0, 0}}, {{3, 1, 1}, {1, 3, 2}}};
  for (const std::vector<Cell>& cells : avoided) {
    model::RobotSpec with_obstacles = spec;
    with_obstacles.obstacles = {{.from = {}, .to = {}, .cells = cells}};
    for (ReachRule rule : {ReachRule{.reach = Reach::kLine},
                           ReachRule{.reach = Reach::kSurface, .source = Cell{-1, 1, 1}}}) {
      const ReachFinder obstacles(with_obstacles, rule);
      rule.avoid = cells;
      const ReachFinder barred(spec, rule);
      for (const Cell& absent : spec.existing) {
        const ElementSet state = all_but(spec, {absent, {1, 1, 2}});
        for (const Cell& to : {absent, Cell{1, 1, 1}, Cell{1, 1, 2}, cells.front()}) {
          EXPECT_EQ(barred.can_reach(state, to), obstacles.can_reach(state, to));
        }
      }
    }
  }
  // A lid far above closes the shaft.
  EXPECT_FALSE(ReachFinder(spec, {.reach = Reach::kLine, .avoid = {{1, 1, 9}}})
                   .can_reach(all_but(spec, {{1, 1, 2}}), {1, 1, 1}));
}

TEST(Reach, along_the_surface_goes_round_corners_and_down_a_shaft) {
  const model::RobotSpec spec = box();
  const ReachFinder surface(spec, {.reach = Reach::kSurface, .source = Cell{3, 1, 0}});
  const ElementSet open = all_but(spec, {{1, 1, 2}});
  EXPECT_TRUE(surface.can_reach(open, {3, 1, 2}));   // Straight up the wall,
  EXPECT_TRUE(surface.can_reach(open, {2, 1, 3}));   // over the edge,
  EXPECT_TRUE(surface.can_reach(open, {1, 1, 1}));   // into the shaft,
  EXPECT_TRUE(surface.can_reach(open, {-1, 2, 0}));  // or round to the other side.
  EXPECT_FALSE(surface.can_reach(all_but(spec, {}), {1, 1, 1}));
  // Nothing is beside the cell that is reached, or beside the source.
  EXPECT_FALSE(surface.can_reach(open, {4, 1, 0}));
  const ReachFinder far(spec, {.reach = Reach::kSurface, .source = Cell{5, 1, 0}});
  EXPECT_FALSE(far.can_reach(open, {3, 1, 0}));
}

TEST(Reach, along_the_surface_is_barred_by_obstacles_and_needs_no_more_than_modules) {
  // A wall around the source, as high as the box: over it, but not through it.
  model::RobotSpec spec = box();
  spec.obstacles = {{.from = {3, 0, 0}, .to = {3, 0, 9}},
                    {.from = {3, 2, 0}, .to = {3, 2, 9}},
                    {.from = {3, 1, 1}, .to = {3, 1, 9}}};
  const ReachFinder surface(spec, {.reach = Reach::kSurface, .source = Cell{3, 1, 0}});
  const ElementSet state = all_but(spec, {{1, 1, 2}});
  EXPECT_TRUE(surface.can_reach(state, {3, 1, 0}));
  EXPECT_FALSE(surface.can_reach(state, {1, 1, 2}));
}

TEST(Reach, of_an_empty_state_is_everywhere) {
  const model::RobotSpec spec = box();
  const ReachFinder surface(spec, {.reach = Reach::kSurface, .source = Cell{9, 9, 9}});
  EXPECT_TRUE(surface.can_reach(ElementSet(spec.existing.size()), {0, 0, 0}));
}

TEST(Reach, below_the_support_level_is_free_where_the_target_has_a_module) {
  // A module that hangs from one on the floor's edge comes from below, or around the corner.
  const model::RobotSpec hanging{.existing = {{0, 0, 0}, {0, 0, -1}}, .fixed = {{0, 0, 0}}};
  const ElementSet state = all_but(hanging, {{0, 0, -1}});
  const ReachRule rules[] = {{.reach = Reach::kLine},
                             {.reach = Reach::kSurface, .source = Cell{1, 0, 0}}};
  for (const ReachRule& rule : rules) {
    EXPECT_TRUE(ReachFinder(hanging, rule).can_reach(state, {0, 0, -1})) << name(rule.reach);
  }
  // Under a robot that stands on it the floor is closed.
  const model::RobotSpec standing{.existing = {{0, 0, 0}, {0, 0, 1}}, .fixed = {{0, 0, 0}}};
  EXPECT_FALSE(
      ReachFinder(standing, rules[1]).can_reach(all_but(standing, {{0, 0, 1}}), {0, 0, -1}));
}

}  // namespace
}  // namespace holdfast::plan
