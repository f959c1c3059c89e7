// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
//
// A robot's turns and mirror images, counted by hand on shapes that have some of the eight of a
// square, and the answers for cells that are images of one another against checks of each.
#include "search/robot_symmetry.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <set>
#include <vector>

#include "holdfast/model/families.hpp"
#include "holdfast/plan/candidates.hpp"

namespace holdfast::plan {
namespace {

using base::Cell;
using model::RobotSpec;

/// How many different cells the eight images of a cell at (3, 1) from the middle, where a square
/// leaves none in its place, fall together to: 8 over the number of symmetries.
std::size_t representative_count(const RobotSpec& spec, const Cell& middle) {
  const RobotSymmetry symmetry(spec);
  std::set<Cell> found;
  for (const std::int32_t x : {-1, 1}) {
    for (const std::int32_t y : {-1, 1}) {
      for (const auto& [a, b] : {std::pair(3, 1), std::pair(1, 3)}) {
        found.insert(symmetry.representative({middle.x + x * a, middle.y + y * b, middle.z}));
      }
    }
  }
  return found.size();
}

/// Four arms of two modules about (5, -2), with something at each end.
RobotSpec cross(const std::vector<Cell>& ends) {
  RobotSpec spec;
  for (const Cell& cell : std::vector<Cell>{{0, 0, 0},
                                            {1, 0, 0},
                                            {-1, 0, 0},
                                            {0, 1, 0},
                                            {0, -1, 0},
                                            {2, 0, 0},
                                            {-2, 0, 0},
                                            {0, 2, 0},
                                            {0, -2, 0}}) {
    spec.existing.push_back({cell.x + 5, cell.y - 2, cell.z});
  }
  for (const Cell& cell : ends) {
    spec.existing.push_back({cell.x + 5, cell.y - 2, cell.z});
  }
  return spec;
}

constexpr Cell kMiddle = {5, -2, 0};

const std::vector<Cell> kPinwheel = {{2, 1, 0}, {-1, 2, 0}, {-2, -1, 0}, {1, -2, 0}};

TEST(RobotSymmetry, is_that_of_the_shape) {
  EXPECT_EQ(representative_count(cross({}), kMiddle), 1U);
  EXPECT_EQ(representative_count(cross(kPinwheel), kMiddle), 2U);
  EXPECT_EQ(representative_count(cross({{0, 0, 1}}), kMiddle), 1U);
  EXPECT_EQ(representative_count(cross({{1, 0, 1}, {-1, 0, 1}}), kMiddle), 2U);
  EXPECT_EQ(representative_count(cross({{1, 0, 1}, {0, 1, 1}}), kMiddle), 4U);
  EXPECT_EQ(representative_count(cross({{1, 0, 1}}), kMiddle), 4U);
  EXPECT_EQ(representative_count(cross({{1, 0, 1}, {0, 2, 1}}), kMiddle), 8U);
}

TEST(RobotSymmetry, ends_where_something_else_tells_the_sides_apart) {
  RobotSpec planned = cross({});
  planned.planned = {{6, -2, 1}};
  EXPECT_EQ(representative_count(planned, kMiddle), 4U);
  RobotSpec fixed = cross({});
  fixed.fixed = {{7, -2, 0}, {5, 0, 0}};
  EXPECT_EQ(representative_count(fixed, kMiddle), 4U);
  RobotSpec section = cross({});  // Standing beams bend otherwise along x than along y.
  section.material.moment_x_mm4 *= 2;
  EXPECT_EQ(representative_count(section, kMiddle), 2U);
  RobotSpec masses = cross({});
  masses.own_masses = {{.cell = {7, -2, 0}, .mass_kg = 1}};
  EXPECT_EQ(representative_count(masses, kMiddle), 8U);
  RobotSpec payload = cross({});
  payload.payloads = {{.cell = {7, -2, 0}, .force_n = {0, 0, -1}}};
  EXPECT_EQ(representative_count(payload, kMiddle), 8U);
  RobotSpec wind = cross({});
  wind.gravity_m_s2 = {1, 0, -9};
  EXPECT_EQ(representative_count(wind, kMiddle), 8U);
  RobotSpec wall = cross({});
  wall.obstacles = {{.from = {8, -2, 0}, .to = {8, -2, 0}}};
  EXPECT_EQ(representative_count(wall, kMiddle), 8U);
  RobotSpec released = cross({{1, 1, 0}});
  released.released = {{Cell{6, -1, 0}, Cell{6, -2, 0}}};
  EXPECT_EQ(representative_count(released, kMiddle), 8U);
}

TEST(RobotSymmetry, leaves_cells_that_touch_nothing_alone) {
  const RobotSymmetry symmetry(cross({}));
  for (const Cell& far : {Cell{9, -2, 0}, Cell{5, 2147483647, 0}, Cell{-2147483647, 0, 7}}) {
    EXPECT_EQ(symmetry.representative(far), far);
  }
}

/// Every cell beside the robot against a check of its own.
void expect_as_checked(const RobotSpec& spec, bool is_planned) {
  const std::vector<Cell> cells = free_cells(spec);
  const CandidateReport fast = judge_candidates(spec, cells, {.is_planned = is_planned});
  const CandidateReport full =
      judge_candidates(spec, cells, {.is_planned = is_planned, .is_by_checks = true});
  EXPECT_LT(fast.check_count, full.check_count);
  for (std::size_t i = 0; i < cells.size(); ++i) {
    const Candidate& a = fast.candidates[i];
    const Candidate& b = full.candidates[i];
    ASSERT_EQ(a.cell, cells[i]);
    ASSERT_EQ(a.is_robot, b.is_robot) << model::text(a.cell);
    if (b.is_robot) {
      EXPECT_EQ(a.judgement.verdict, b.judgement.verdict) << model::text(a.cell);
      EXPECT_NEAR(a.judgement.margin_mm.value_or(0), b.judgement.margin_mm.value_or(0), 1e-9);
      EXPECT_NEAR(a.judgement.load_ratio_max.value_or(0), b.judgement.load_ratio_max.value_or(0),
                  1e-7)
          << model::text(a.cell);
    }
  }
}

TEST(RobotSymmetry, gives_every_image_of_a_candidate_the_answer_of_its_own_check) {
  expect_as_checked(cross({}), true);
  expect_as_checked(cross(kPinwheel), true);
  expect_as_checked(cross({{1, 0, 1}, {-1, 0, 1}}), true);
  expect_as_checked(cross({{1, 0, 1}, {0, 1, 1}}), true);
  RobotSpec hanging = cross(kPinwheel);
  hanging.support_z = std::nullopt;
  hanging.fixed = {kMiddle};
  hanging.material.strength_lateral_n = 6;  // Some break.
  hanging.material.moment_x_mm4 *= 2;
  expect_as_checked(hanging, true);
  RobotSpec planned = cross({});  // Existing modules go beside existing ones alone.
  planned.planned = {{5, -2, 1}, {5, -2, 2}};
  expect_as_checked(planned, false);
  expect_as_checked({.existing = model::family_cells(model::Family::kTower, 4)}, true);
  expect_as_checked({.existing = model::family_cells(model::Family::kPortal, 5)}, true);
}

}  // namespace
}  // namespace holdfast::plan
