// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
//
// A plan of moves that is gone on with, from a step, or from a robot that is elsewhere, or under
// other rules: the code of holdfast steps judges the new plan, its last steps are the old plan's,
// and there is one just where a search that knows of no plan finds one.
#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "holdfast/base/lattice.hpp"
#include "holdfast/base/rng.hpp"
#include "holdfast/move.hpp"
#include "holdfast/steps.hpp"
#include "seeds.hpp"

namespace holdfast {
namespace {

using base::Cell;
using CellSet = std::set<Cell>;
using Steps = std::vector<model::Step>;

constexpr plan::CellBox kBox{.low = {0, 0, 0}, .high = {3, 1, 2}};

/// Weak cubes on a floor that grew at random in a box.
io::Document random_shape(base::Rng& rng, std::size_t count, double strength_n) {
  CellSet cells = {{static_cast<std::int32_t>(rng.below(4)), 0, 0}};
  while (cells.size() < count) {
    auto from = cells.begin();
    std::advance(from, static_cast<std::ptrdiff_t>(rng.below(cells.size())));
    const Cell next = base::neighbour(*from, base::kDirections[rng.below(base::kDirectionCount)]);
    if (kBox.contains(next)) {
      cells.insert(next);
    }
  }
  io::Document document;
  document.material.strength_vertical_n = strength_n;
  document.material.strength_lateral_n = strength_n;
  for (const Cell& cell : cells) {
    document.modules.push_back({.cell = cell, .is_fixed = false, .color = {}, .attributes = {}});
  }
  return document;
}

CellSet cells_in(const io::Document& document) {
  CellSet cells;
  for (const io::ModuleEntry& module : document.modules) {
    cells.insert(module.cell);
  }
  return cells;
}

/// Does the steps of a plan, safe by the code of holdfast steps, and says where modules are then.
CellSet end_of(const io::Document& plan) {
  if (!plan.extension.plan.empty()) {
    const auto judged = judge_steps({.name = "", .document = plan, .warnings = {}});
    EXPECT_TRUE(judged) << judged.error().message;
    EXPECT_EQ(judged.value().judgement.verdict(), verdict::Verdict::kSafe);
  }
  CellSet cells = cells_in(plan);
  for (const model::Step& step : plan.extension.plan) {
    EXPECT_EQ(cells.erase(step.moves.front().from), 1U);
    EXPECT_TRUE(cells.insert(step.moves.front().to).second);
  }
  return cells;
}

bool is_found(const base::Result<io::MoveReport>& report) {
  return report && report.value().plan.outcome == plan::MoveOutcome::kFound;
}

Steps last(const Steps& steps, std::size_t count) {
  return {steps.end() - static_cast<std::ptrdiff_t>(count), steps.end()};
}

/// A plan between two random shapes; none where none is found.
std::optional<io::Document> random_plan(base::Rng& rng, const MoveRequest& request) {
  const std::size_t count = 4 + rng.below(3);
  const double strength_n = 0.4 + 0.2 * static_cast<double>(rng.below(12));
  const io::Document start = random_shape(rng, count, strength_n);
  const auto found = seek_moves(start, random_shape(rng, count, strength_n), request);
  if (!is_found(found) || found.value().plan.steps.empty()) {
    return std::nullopt;
  }
  return io::move_steps(found.value());
}

io::Document without_plan(io::Document document) {
  document.extension.plan.clear();
  return document;
}

TEST(ContinuedMoves, at_a_step_are_those_that_are_left) {
  int found_count = 0;
  for (std::uint64_t seed = 0; seed < holdfast::test::campaign(150U); ++seed) {
    SCOPED_TRACE(seed);
    base::Rng rng(seed);
    const MoveRequest request{.within = kBox, .thread_count = 1};
    const auto plan = random_plan(rng, request);
    if (!plan) {
      continue;
    }
    ++found_count;
    const Steps& steps = plan->extension.plan;
    const std::size_t done = rng.below(steps.size() + 1);
    const auto report = continue_moves(without_plan(*plan), *plan, done, request);
    ASSERT_TRUE(is_found(report)) << (report ? "" : report.error().message);
    EXPECT_EQ(report.value().plan.steps, last(steps, steps.size() - done));
    EXPECT_EQ(report.value().kept_count, steps.size() - done);
    EXPECT_EQ(end_of(io::move_steps(report.value())), end_of(*plan));
    EXPECT_EQ(continue_moves(without_plan(*plan), *plan, steps.size() + 1, request).error().where,
              kAtPlan);
    // The robot is found on its way without being told where it is.
    const auto now = io::after_moves(*plan, std::span(steps).first(done));
    const auto anywhere = continue_moves(now.value(), *plan, std::nullopt, request);
    ASSERT_TRUE(is_found(anywhere));
    EXPECT_EQ(anywhere.value().plan.steps, report.value().plan.steps);
  }
  EXPECT_GE(found_count, holdfast::test::least(60));
}

/// Other rules than those of the plan: modules to be kept and cells to be avoided.
MoveRequest changed_rules(base::Rng& rng, const MoveRequest& request, const CellSet& now,
                          const CellSet& target) {
  MoveRequest changed = request;
  for (const Cell& cell : now) {
    if (target.contains(cell) && rng.below(4) == 0) {
      changed.keep.push_back({.low = cell, .high = cell});
    }
  }
  for (int i = 0; i < 6; ++i) {
    const Cell cell = {static_cast<std::int32_t>(rng.below(4)),
                       static_cast<std::int32_t>(rng.below(2)),
                       static_cast<std::int32_t>(rng.below(3))};
    if (!now.contains(cell) && !target.contains(cell)) {
      changed.avoid.push_back(cell);
    }
  }
  return changed;
}

struct ContinuedTally {
  int found = 0;
  int none = 0;
  int partly = 0;
};

void expect_as_sought(const io::Document& now, const io::Document& plan, const MoveRequest& request,
                      ContinuedTally& tally) {
  const auto report = continue_moves(now, plan, std::nullopt, request);
  const auto target = io::after_moves(without_plan(plan), plan.extension.plan);
  const auto plain = seek_moves(now, target.value(), request);
  ASSERT_EQ(bool(report), bool(plain)) << (report ? plain : report).error().message;
  if (!report) {
    return;
  }
  ASSERT_EQ(report.value().plan.outcome, plain.value().plan.outcome);
  if (!is_found(report)) {
    ++tally.none;
    return;
  }
  ++tally.found;
  const plan::MovePlan& found = report.value().plan;
  const std::size_t kept = report.value().kept_count.value_or(0);
  EXPECT_LE(found.length_min, static_cast<int>(plain.value().plan.steps.size()));
  EXPECT_EQ(end_of(io::move_steps(report.value())), cells_in(target.value()));
  EXPECT_EQ(last(found.steps, kept), last(plan.extension.plan, kept));
  tally.partly += kept > 0 && kept < found.steps.size();
  for (const model::Step& step : found.steps) {
    const model::Move& move = step.moves.front();
    EXPECT_EQ(std::ranges::count(request.avoid, move.to), 0);
    EXPECT_TRUE(std::ranges::none_of(
        request.keep, [&](const plan::CellBox& box) { return box.contains(move.from); }));
  }
}

TEST(ContinuedMoves, exist_just_where_a_search_finds_any) {
  ContinuedTally tally;
  for (std::uint64_t seed = 0; seed < holdfast::test::campaign(300U); ++seed) {
    SCOPED_TRACE(seed);
    base::Rng rng(seed + 7000);
    const MoveRequest request{.within = kBox, .thread_count = 1};
    const auto plan = random_plan(rng, request);
    if (!plan) {
      continue;
    }
    // Somewhere on the way one module has gone elsewhere, or none has.
    const Steps& steps = plan->extension.plan;
    io::Document now =
        io::after_moves(*plan, std::span(steps).first(rng.below(steps.size()))).value();
    const plan::RobotState robot(io::make_spec(now).value());
    const std::vector<std::int32_t> loose = plan::loose_modules(robot);
    const auto moves =
        plan::moves_of(robot, loose[rng.below(loose.size())], {.floor_z = 0, .within = kBox});
    if (!moves.empty() && rng.below(3) > 0) {
      const std::vector<model::Step> astray = {{.moves = {moves[rng.below(moves.size())]}}};
      now = io::after_moves(now, astray).value();
    }
    const bool has_other_rules = rng.below(2) == 0;
    const auto target = io::after_moves(without_plan(*plan), steps);
    expect_as_sought(now, *plan,
                     has_other_rules
                         ? changed_rules(rng, request, cells_in(now), cells_in(target.value()))
                         : request,
                     tally);
  }
  EXPECT_GE(tally.found, holdfast::test::least(100));
  EXPECT_GE(tally.none, holdfast::test::least(3));
  EXPECT_GE(tally.partly, holdfast::test::least(20));
}

TEST(ContinuedMoves, refuse_what_is_no_plan_of_the_robot) {
  base::Rng rng(1);
  const io::Document robot = random_shape(rng, 4, 10);
  const auto message = [&](const io::Document& file, const io::Document& plan) {
    const auto report = continue_moves(file, plan, std::nullopt, {});
    EXPECT_TRUE(!report && report.error().where == kAtPlan);
    return report ? std::string() : report.error().message;
  };
  EXPECT_EQ(message(robot, robot),
            "it has no steps; expected a plan that holdfast move -o has written");
  io::Document plan = robot;
  plan.extension.plan = {{.attach = {{9, 9, 9}}}};
  EXPECT_NE(message(robot, plan).find("step 0 does something else than to move one module"),
            std::string::npos);
  plan.extension.plan = {{.moves = {{.from = {9, 9, 9}, .to = {9, 9, 8}, .carrier = {}}}}};
  EXPECT_EQ(message(robot, plan),
            "step 0 moves a module from (9,9,9) to (9,9,8), where it begins without one");
  io::Document other = robot;
  other.support_z = -1;
  EXPECT_EQ(message(other, plan), "it is a plan of another robot: they differ in support_z");
}

}  // namespace
}  // namespace holdfast
