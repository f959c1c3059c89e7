// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
//
// Where may the next module go? Answers are compared with a check of the grown robot, which is the
// second way, and for a post and a row with what statics say.
#include "holdfast/trial.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <sstream>

namespace holdfast {
namespace {

using base::Cell;
using verdict::Verdict;

/// A row of three on the ground and a post of three on its end.
model::RobotSpec corner() {
  return {.existing = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {0, 0, 1}, {0, 0, 2}}};
}

TEST(FreeCells, of_one_module_are_its_six_neighbours) {
  const std::vector<Cell> expected = {{-1, 0, 0}, {0, -1, 0}, {0, 0, -1},
                                      {0, 0, 1},  {0, 1, 0},  {1, 0, 0}};
  EXPECT_EQ(free_cells({.existing = {{0, 0, 0}}}), expected);
}

TEST(FreeCells, hold_no_module_and_come_once) {
  model::RobotSpec spec = corner();
  spec.planned = {{1, 0, 1}};
  const std::vector<Cell> cells = free_cells(spec);
  EXPECT_TRUE(std::ranges::is_sorted(cells));
  EXPECT_EQ(std::ranges::adjacent_find(cells), cells.end());
  for (const auto* taken : {&spec.existing, &spec.planned}) {
    for (const Cell& cell : *taken) {
      EXPECT_EQ(std::ranges::find(cells, cell), cells.end()) << model::text(cell);
    }
  }
}

void expect_checks_of_grown_robots(const model::RobotSpec& spec) {
  const std::vector<Cell> cells = free_cells(spec);
  for (const Role role : {Role::kExisting, Role::kPlanned, Role::kFixed}) {
    const std::vector<Trial> trials = try_cells(spec, cells, role);
    ASSERT_EQ(trials.size(), cells.size());
    for (std::size_t i = 0; i < trials.size(); ++i) {
      model::RobotSpec grown = spec;
      add_module(grown, cells[i], role);
      const auto robot = model::Robot::create(grown);
      EXPECT_EQ(trials[i].cell, cells[i]);
      ASSERT_EQ(trials[i].is_robot, robot.has_value()) << model::text(cells[i]);
      if (robot) {
        const verdict::Assessment assessment = check(robot.value()).assessment;
        EXPECT_EQ(trials[i].verdict, assessment.verdict) << model::text(cells[i]);
        EXPECT_NEAR(trials[i].margin_mm.value_or(-1e9),
                    assessment.simplified.margin_mm.value_or(-1e9), 1e-9);
        if (assessment.verdict != Verdict::kUnstable) {
          EXPECT_NEAR(trials[i].load_ratio_max.value_or(-1), assessment.load_ratio_max.value_or(-1),
                      1e-9);
        }
      }
    }
  }
}

TEST(Trial, says_what_a_check_of_the_grown_robot_says) { expect_checks_of_grown_robots(corner()); }

TEST(Trial, says_so_in_every_lattice_with_supports_anywhere) {
  for (const base::Lattice& lattice :
       {base::kCubic, base::kFaceCentred, base::kHexagonal, base::kHexagonalPrism}) {
    model::RobotSpec spec = corner();
    spec.lattice = lattice;
    spec.gravity_m_s2 = {2, 0, -9};
    spec.floor.friction = 0.6;
    spec.obstacles = {{.from = {}, .to = {}, .cells = {{3, 0, 0}, {3, 0, 2}}, .touch = {}}};
    spec.payloads = {{.cell = {0, 0, 2}, .force_n = {0.2, 0, -0.3}, .torque_nmm = {}}};
    expect_checks_of_grown_robots(spec);
  }
}

TEST(Trial, of_a_cell_that_is_taken_or_apart_or_below_the_ground_is_no_robot) {
  const std::vector<Cell> cells = {{0, 0, 0}, {9, 9, 9}, {1, 0, -1}};
  for (const Trial& trial : try_cells(corner(), cells)) {
    EXPECT_FALSE(trial.is_robot) << model::text(trial.cell);
  }
}

// A post of one module with a row of n beside it at height 1: the centre of mass lies n pitches
// from the post's axis after the n-th, and beyond the facet's half pitch for every n >= 1 but for
// the post's own weight: n (n + 1) / 2 pitches over n + 2 modules. That is 1/3 for n = 1, so it
// stands with a margin of 40 (1/2 - 1/3) mm, and 3/4 for n = 2: it topples by 40 (3/4 - 1/2) mm.
TEST(Trial, gives_the_margin_of_a_row_on_a_post) {
  model::RobotSpec spec{.existing = {{0, 0, 0}, {0, 0, 1}}};
  const Trial first = try_cells(spec, std::vector<Cell>{{1, 0, 1}}).front();
  EXPECT_EQ(first.verdict, Verdict::kSafe);
  EXPECT_NEAR(first.margin_mm.value(), 40.0 / 6, 1e-9);
  EXPECT_TRUE(first.load_ratio_max.has_value());
  spec.existing.push_back({1, 0, 1});
  const Trial second = try_cells(spec, std::vector<Cell>{{2, 0, 1}}).front();
  EXPECT_EQ(second.verdict, Verdict::kUnstable);
  EXPECT_NEAR(second.margin_mm.value(), -10, 1e-9);
  EXPECT_FALSE(second.load_ratio_max.has_value()) << "a robot that topples needs no loads";
}

TEST(Trial, of_a_robot_bonded_to_the_ground_gives_loads_where_it_would_topple) {
  const model::RobotSpec spec{.existing = {{0, 0, 0}, {0, 0, 1}, {1, 0, 1}}};
  const Trial trial =
      try_cells(spec, std::vector<Cell>{{2, 0, 1}}, Role::kPlanned, {.is_bonded = true}).front();
  EXPECT_EQ(trial.verdict, Verdict::kSafe);
  EXPECT_TRUE(trial.load_ratio_max.has_value());
}

/// A post with a row of one beside it: on its far end a module topples it, as above.
Structure post_and_row() {
  return load_text(R"({"format": "holdfast-structure", "version": 1, "name": "post",
                       "modules": [[0,0,0], [0,0,1], [1,0,1]]})")
      .value();
}

TEST(Next, lists_every_free_cell_once_safe_ones_first) {
  const Structure structure = post_and_row();
  const NextResult result = find_next(structure);
  std::vector<Cell> cells;
  for (const Trial& trial : result.candidates) {
    EXPECT_TRUE(trial.is_robot);
    cells.push_back(trial.cell);
  }
  // All free cells but the one below the floor.
  EXPECT_EQ(cells.size(), free_cells(io::make_spec(structure.document).value()).size() - 1);
  EXPECT_TRUE(std::ranges::is_sorted(result.candidates, {}, [](const Trial& trial) {
    return trial.verdict == Verdict::kSafe ? 0 : 1;
  }));
  const auto far = std::ranges::find(result.candidates, Cell{2, 0, 1}, &Trial::cell);
  ASSERT_NE(far, result.candidates.end());
  EXPECT_EQ(far->verdict, Verdict::kUnstable);
  EXPECT_NEAR(far->margin_mm.value(), -10, 1e-9);
}

TEST(Next, writes_the_keys_that_other_tools_rely_on) {
  const Structure structure = post_and_row();
  const NextResult result = find_next(structure);
  std::ostringstream out;
  write_next_json(out, structure, result, {.count_max = 2});
  const auto json = nlohmann::json::parse(out.str());
  ASSERT_EQ(json["candidates"].size(), 2U);
  EXPECT_EQ(json["counts"]["safe"], result.count(Verdict::kSafe));
  EXPECT_GE(json["seconds"], json["preparation_seconds"]);
  for (const auto& candidate : json["candidates"]) {
    EXPECT_EQ(candidate["cell"].size(), 3U);
    EXPECT_EQ(candidate["verdict"], "safe");
    EXPECT_TRUE(candidate["load_ratio_max"].is_number());
    EXPECT_TRUE(candidate["margin_mm"].is_number());
  }
  EXPECT_NE(next_text(structure, result, {.count_max = 2}).find("more"), std::string::npos);
}

TEST(Next, draws_a_ghost_for_every_place_and_the_robot_as_it_is) {
  const Structure structure = post_and_row();
  const NextResult result = find_next(structure);
  const std::string picture = next_svg(structure, check(structure), result);
  std::size_t ghost_count = 0;
  for (std::size_t at = 0; (at = picture.find(", place for the next module", at)) != picture.npos;
       ++at) {
    ++ghost_count;
  }
  EXPECT_GT(ghost_count, 0U);
  EXPECT_LE(ghost_count, result.candidates.size());
  EXPECT_NE(picture.find("a modular robot of 3 modules, 0 of them planned"), std::string::npos);
}

TEST(Trial, makes_the_first_robot_of_an_empty_place) {
  const std::vector<Cell> cells = {{0, 0, 0}, {0, 0, 1}};
  const std::vector<Trial> trials = try_cells({}, cells, Role::kExisting);
  EXPECT_TRUE(trials[0].is_robot) << "it stands on the ground";
  EXPECT_FALSE(trials[1].is_robot) << "nothing holds it";
}

}  // namespace
}  // namespace holdfast
