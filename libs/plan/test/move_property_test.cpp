// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
//
// Moves between random small shapes, beside a breadth-first search that knows nothing of the room
// and tries every move there is: the same existence and the same shortest length, and certificates
// that can be replayed. HOLDFAST_MOVE_CASES=N tries as many as that.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>

#include "holdfast/base/rng.hpp"
#include "holdfast/plan/move_plan.hpp"
#include "move_brute_force.hpp"
#include "seeds.hpp"

namespace holdfast::plan {
namespace {

using brute_force::Cells;
using brute_force::World;

Cells random_shape(const World& world, std::size_t count, base::Rng& rng) {
  while (true) {
    Cells cells = world.fixed;
    while (cells.size() < count) {
      const auto pick = [&](std::int32_t low, std::int32_t high) {
        return low +
               static_cast<std::int32_t>(rng.below(static_cast<std::uint64_t>(high - low + 1)));
      };
      cells.insert({pick(world.low.x, world.high.x), pick(world.low.y, world.high.y),
                    pick(world.low.z, world.high.z)});
    }
    const bool is_held = !world.fixed.empty() ||
                         std::ranges::any_of(cells, [](const base::Cell& c) { return c.z == 0; });
    if (is_held && brute_force::is_connected(cells)) {
      return cells;
    }
  }
}

/// Connectors so weak that some shapes break, in flat and in deep boxes, on a floor or held by a
/// fixed module.
World random_world(base::Rng& rng) {
  World world;
  world.high = rng.below(2) == 0 ? base::Cell{3, 0, 3} : base::Cell{2, 1, 2};
  if (rng.below(2) == 0) {
    world.spec.support_z = std::nullopt;
    world.fixed = {{1, 0, 1}};
  }
  const double strength = 0.4 + 0.2 * static_cast<double>(rng.below(12));
  world.spec.material.strength_vertical_n = strength;
  world.spec.material.strength_lateral_n = 1.25 * strength;
  return world;
}

MoveTask task_of(const World& world, const Cells& start, const Cells& target) {
  MoveTask task{.start = world.spec,
                .target = world.spec,
                .within = CellBox{.low = world.low, .high = world.high},
                .avoid = {world.avoided.begin(), world.avoided.end()},
                .keep = {world.kept.begin(), world.kept.end()}};
  task.start.existing.assign(start.begin(), start.end());
  task.target.existing.assign(target.begin(), target.end());
  task.start.fixed.assign(world.fixed.begin(), world.fixed.end());
  task.target.fixed = task.start.fixed;
  return task;
}

struct MoveTally {
  int found = 0;
  int none = 0;
  int backward = 0;  ///< Certificates that begin at the target.
};

/// All parts of the search in turns, with little patience each.
void compare_in_turns(const MoveTask& task, const std::optional<int>& truth, MoveTally& tally) {
  const auto plan = find_moves(task, {.exact_count_max = 0});
  ASSERT_EQ(plan.value().outcome, truth ? MoveOutcome::kFound : MoveOutcome::kNone);
  const auto length = static_cast<int>(plan.value().steps.size());
  if (truth) {
    EXPECT_GE(length, *truth);
    EXPECT_LE(plan.value().length_min, *truth);
    EXPECT_TRUE(!plan.value().is_shortest || length == *truth);
    return;
  }
  const MoveCertificate& certificate = *plan.value().certificate;
  const auto check = verify(certificate);
  EXPECT_TRUE(check) << check.error().message;
  tally.backward += certificate.is_backward ? 1 : 0;
}

/// All that is asked of one pair of shapes.
void compare(const World& world, const Cells& start, const Cells& target, MoveTally& tally) {
  const MoveTask task = task_of(world, start, target);
  const auto truth = brute_force::shortest(world, start, target);
  const auto plan = find_moves(task);
  ASSERT_EQ(bool(plan), true) << plan.error().message;
  compare_in_turns(task, truth, tally);
  if (!truth) {
    ++tally.none;
    ASSERT_EQ(plan.value().outcome, MoveOutcome::kNone);
    const auto check = verify(*plan.value().certificate);
    EXPECT_TRUE(check) << check.error().message;
    return;
  }
  ++tally.found;
  ASSERT_EQ(plan.value().outcome, MoveOutcome::kFound);
  EXPECT_EQ(plan.value().steps.size(), static_cast<std::size_t>(*truth));
  EXPECT_TRUE(plan.value().is_shortest);
}

void compare(std::uint64_t seed, MoveTally& tally) {
  SCOPED_TRACE("seed " + std::to_string(seed));
  base::Rng rng(seed);
  const World world = random_world(rng);
  const std::size_t count = 3 + rng.below(3);
  const Cells start = random_shape(world, count, rng);
  const Cells target = random_shape(world, count, rng);
  if (!brute_force::is_safe(world, start)) {
    EXPECT_FALSE(find_moves(task_of(world, start, target)));
    return;
  }
  compare(world, start, target, tally);
}

TEST(MoveProperty, plans_exist_and_are_short_as_by_brute_force) {
  const char* const wanted = std::getenv("HOLDFAST_MOVE_CASES");
  const std::uint64_t case_count =
      wanted != nullptr ? std::strtoull(wanted, nullptr, 10) : holdfast::test::campaign(60U, 10U);
  MoveTally tally;
  for (std::uint64_t seed = 1; seed <= case_count && !testing::Test::HasFatalFailure(); ++seed) {
    compare(seed, tally);
  }
  RecordProperty("found", tally.found);
  RecordProperty("none", tally.none);
  RecordProperty("backward", tally.backward);
  EXPECT_GT(tally.found, static_cast<int>(case_count) / 8);
  EXPECT_GT(tally.none, static_cast<int>(case_count) / 8);
}

/// Some modules that both shapes have, and some cells that neither has.
void keep_and_avoid(World& world, const Cells& start, const Cells& target, base::Rng& rng) {
  const bool keeps = rng.below(3) > 0;
  const bool avoids = !keeps || rng.below(2) == 0;
  for (const base::Cell& cell : start) {
    if (keeps && target.contains(cell) && !world.fixed.contains(cell) && rng.below(2) == 0) {
      world.kept.insert(cell);
    }
  }
  for (std::int32_t x = world.low.x; avoids && x <= world.high.x; ++x) {
    for (std::int32_t y = world.low.y; y <= world.high.y; ++y) {
      for (std::int32_t z = world.low.z; z <= world.high.z; ++z) {
        const base::Cell cell = {x, y, z};
        if (!start.contains(cell) && !target.contains(cell) && rng.below(4) == 0) {
          world.avoided.insert(cell);
        }
      }
    }
  }
}

/// What is kept stays, and no cell to be avoided is an end of a move; an end of one that is not
/// shortest is no less so.
void expect_heeded(const World& world, const MovePlan& plan) {
  for (const model::Step& step : plan.steps) {
    EXPECT_FALSE(world.kept.contains(step.moves.front().from));
    EXPECT_FALSE(world.avoided.contains(step.moves.front().to));
  }
}

TEST(MoveProperty, plans_keep_modules_and_avoid_cells_as_by_brute_force) {
  MoveTally tally;
  int barred_count = 0;
  const std::uint64_t case_count = holdfast::test::campaign(160U, 10U);
  for (std::uint64_t seed = 1; seed <= case_count && !testing::Test::HasFatalFailure(); ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    base::Rng rng(seed + 5000);
    World world = random_world(rng);
    const std::size_t count = 3 + rng.below(3);
    const Cells start = random_shape(world, count, rng);
    const Cells target = random_shape(world, count, rng);
    keep_and_avoid(world, start, target, rng);
    if ((world.kept.empty() && world.avoided.empty()) || !brute_force::is_safe(world, start)) {
      continue;
    }
    compare(world, start, target, tally);
    const auto heeded = find_moves(task_of(world, start, target), {.exact_count_max = 0});
    expect_heeded(world, heeded.value());
    World open = world;
    open.kept = open.avoided = {};
    barred_count += heeded.value().outcome == MoveOutcome::kNone &&
                    brute_force::shortest(open, start, target).has_value();
  }
  EXPECT_GE(tally.found, holdfast::test::least(21, 10));
  EXPECT_GE(barred_count, holdfast::test::least(5, 10));
}

TEST(MoveProperty, modules_that_are_to_be_kept_or_cells_avoided_must_be_so_at_both_ends) {
  World world;
  world.high = {3, 0, 3};
  const Cells start = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}};
  const Cells target = {{0, 0, 0}, {1, 0, 0}, {1, 0, 1}};
  const auto message = [&](Cells kept, Cells avoided) {
    world.kept = std::move(kept);
    world.avoided = std::move(avoided);
    const auto plan = find_moves(task_of(world, start, target));
    return plan ? std::string() : plan.error().message;
  };
  EXPECT_EQ(message({{1, 0, 0}}, {{3, 0, 0}}), "");
  EXPECT_EQ(message({{2, 0, 0}}, {}),
            "the module (2,0,0) is to be kept, and the target has no such module there; kept "
            "modules do not move");
  EXPECT_EQ(message({{1, 0, 1}}, {}), "the cell (1,0,1) is to be kept, but no module is there");
  EXPECT_EQ(message({}, {{2, 0, 0}}),
            "the cell (2,0,0) is to be avoided, but the robot has a module there");
  EXPECT_EQ(message({}, {{1, 0, 1}}),
            "the cell (1,0,1) is to be avoided, but the target has a module there");
  // The module that goes turns about the corner beside it.
  EXPECT_EQ(message({}, {{2, 0, 1}}), "");
  const auto barred = find_moves(task_of(world, start, target));
  EXPECT_NE(barred.value().steps.size(), 1U);
}

}  // namespace
}  // namespace holdfast::plan
