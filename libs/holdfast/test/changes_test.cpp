// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
// What becomes of a structure that changes while it computes, and what its modules are told.
#include <gtest/gtest.h>

#include "holdfast/distributed.hpp"

namespace holdfast {
namespace {

using base::Cell;
using Kind = Change::Kind;
using Cells = std::vector<Cell>;

Structure arm() {
  auto structure = load_text(R"({"format": "holdfast-structure", "version": 1,
      "modules": [{"cell": [0,0,0], "fixed": true}, [1,0,0]], "planned": [[2,0,0], [2,1,0]]})",
                             "arm");
  EXPECT_TRUE(structure);
  return std::move(structure).value();
}

Cells cells(const model::Robot& robot, bool are_planned) {
  Cells found;
  for (const model::Module& module : robot.modules()) {
    if (module.is_planned == are_planned) {
      found.push_back(module.cell);
    }
  }
  return found;
}

TEST(WithChanges, tells_the_files_plan_first) {
  const auto changed = with_changes(arm(), {});
  ASSERT_TRUE(changed);
  EXPECT_EQ(cells(changed.value().structure.robot, true), (Cells{{2, 0, 0}, {2, 1, 0}}));
  ASSERT_EQ(changed.value().announcements.size(), 2U);
  EXPECT_EQ(changed.value().announcements[1].cell, (Cell{2, 1, 0}));
  EXPECT_EQ(changed.value().announcements[1].at, 0U);
  EXPECT_TRUE(changed.value().attachments.empty());
}

/// Changes happen in the order of their times, whatever their order in the list.
TEST(WithChanges, ends_with_what_is_neither_fulfilled_nor_withdrawn) {
  const auto changed = with_changes(arm(), {{.kind = Kind::kWithdraw, .at = 30, .cell = {2, 1, 0}},
                                            {.kind = Kind::kPlan, .at = 20, .cell = {3, 0, 0}},
                                            {.kind = Kind::kPlan, .at = 40, .cell = {1, 0, 0}},
                                            {.kind = Kind::kPlan, .at = 25, .cell = {3, 0, 0}},
                                            {.kind = Kind::kAttach, .at = 10, .cell = {2, 0, 0}}});
  ASSERT_TRUE(changed) << changed.error().message;
  const model::Robot& robot = changed.value().structure.robot;
  EXPECT_EQ(cells(robot, false), (Cells{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}}));
  EXPECT_EQ(cells(robot, true), (Cells{{3, 0, 0}}));
  EXPECT_EQ(robot.fixed_count(), 1U);
  ASSERT_EQ(changed.value().attachments.size(), 1U);
  EXPECT_EQ(changed.value().attachments[0].module, 2);
  EXPECT_EQ(changed.value().attachments[0].at, 10U);
  ASSERT_EQ(changed.value().announcements.size(), 6U);
  EXPECT_EQ(changed.value().announcements[2].at, 20U);
  EXPECT_TRUE(changed.value().announcements[4].is_withdrawal);
}

TEST(WithChanges, withdraws_all) {
  const auto changed =
      with_changes(arm(), {{.kind = Kind::kWithdraw, .at = 1, .cell = agent::kEveryCell},
                           {.kind = Kind::kPlan, .at = 1, .cell = {3, 0, 0}},
                           {.kind = Kind::kPlan, .at = 2, .cell = {2, 0, 0}}});
  ASSERT_TRUE(changed);
  EXPECT_EQ(cells(changed.value().structure.robot, true), (Cells{{2, 0, 0}}));
}

/// A plan for a cell that is taken by then, or of nothing, is a mistake of whoever wrote it.
TEST(WithChanges, notes_what_has_no_effect) {
  const auto changed = with_changes(arm(), {{.kind = Kind::kPlan, .at = 1, .cell = {1, 0, 0}},
                                            {.kind = Kind::kWithdraw, .at = 2, .cell = {3, 0, 0}},
                                            {.kind = Kind::kWithdraw, .at = 3, .cell = {2, 1, 0}},
                                            {.kind = Kind::kPlan, .at = 4, .cell = {3, 0, 0}},
                                            {.kind = Kind::kAttach, .at = 5, .cell = {2, 0, 0}},
                                            {.kind = Kind::kWithdraw, .at = 6, .cell = {2, 0, 0}}});
  ASSERT_TRUE(changed);
  const std::vector<std::string>& notes = changed.value().structure.warnings;
  ASSERT_EQ(notes.size(), 3U);
  EXPECT_NE(notes[0].find("(1,0,0)"), std::string::npos) << notes[0];
  EXPECT_NE(notes[1].find("(3,0,0)"), std::string::npos) << notes[1];
  EXPECT_NE(notes[2].find("(2,0,0)"), std::string::npos) << notes[2];
}

TEST(WithChanges, says_what_is_no_robot) {
  const auto twice = with_changes(arm(), {{.kind = Kind::kAttach, .at = 1, .cell = {1, 0, 0}}});
  ASSERT_FALSE(twice);
  EXPECT_NE(twice.error().message.find("(1,0,0)"), std::string::npos);
  EXPECT_FALSE(with_changes(arm(), {{.kind = Kind::kAttach, .at = 1, .cell = {9, 0, 0}}}));
  EXPECT_FALSE(with_changes(arm(), {{.kind = Kind::kPlan, .at = 1, .cell = {9, 0, 0}}}));
}

/// A step, then the next one: the end is the exact answer for the robot as it is then.
TEST(WithChanges, are_what_the_robot_goes_through) {
  std::vector<Change> changes;
  for (std::int32_t i = 0; i < 3; ++i) {
    const auto at = static_cast<sim::Time>(2000 * i);
    changes.push_back({.kind = Kind::kPlan, .at = at, .cell = {2 + i, 0, 0}});
    changes.push_back({.kind = Kind::kAttach, .at = at + 1000, .cell = {2 + i, 0, 0}});
  }
  changes.push_back({.kind = Kind::kWithdraw, .at = 7000, .cell = {2, 1, 0}});
  changes.push_back({.kind = Kind::kPlan, .at = 8000, .cell = {5, 0, 0}});
  const auto changed = with_changes(arm(), changes);
  ASSERT_TRUE(changed) << changed.error().message;
  const Structure& end = changed.value().structure;
  const CheckResult exact = check(end);
  sim::SimulationOptions options{.faults = changed.value().attachments,
                                 .announcements = changed.value().announcements,
                                 .tells_planned = false};
  const auto run = simulate(end, exact, options);
  ASSERT_TRUE(run);
  EXPECT_TRUE(run.value().result.all_agree);
  EXPECT_EQ(run.value().result.effort.module_count, 6U);
  EXPECT_EQ(run.value().view.verdict, exact.assessment.verdict);
  EXPECT_NEAR(*run.value().view.load_ratio_max, *exact.assessment.load_ratio_max, 0.01);
}

/// A module's own mass would go to the module that comes to stand in its place in the list.
TEST(Changes, are_for_modules_of_one_kind) {
  const auto structure = load_text(R"({"format": "holdfast-structure", "version": 2,
      "modules": [[0,0,0]], "planned": [[1,0,0], {"cell": [2,0,0], "mass_kg": 0.2}]})");
  ASSERT_TRUE(structure);
  const auto changed =
      with_changes(structure.value(), {{.kind = Kind::kWithdraw, .at = 1, .cell = {1, 0, 0}}});
  ASSERT_FALSE(changed);
  EXPECT_EQ(changed.error().code, base::ErrorCode::kUnsupported);
}

}  // namespace
}  // namespace holdfast
