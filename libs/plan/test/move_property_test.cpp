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
                .within = CellBox{.low = world.low, .high = world.high}};
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
  const auto truth = brute_force::shortest(world, start, target);
  const auto plan = find_moves(task_of(world, start, target));
  ASSERT_EQ(bool(plan), true) << plan.error().message;
  compare_in_turns(task_of(world, start, target), truth, tally);
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

}  // namespace
}  // namespace holdfast::plan
