// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
//
// From one verdict to the next where modules work a piece at a time: what changes may come while
// something is unfinished. (The whole of it is tested in tests/distributed.)
#include <gtest/gtest.h>

#include "test_network.hpp"

namespace holdfast::agent {
namespace {

using namespace holdfast::agent::test;
using base::Cell;

/// Ticks by which everything has settled.
constexpr Time kLong = 400;

Setup keeping_setup() {
  auto setup = table_setup();
  setup.keeps_answers = true;
  return setup;
}

void wait(TestNetwork& network, Time ticks) {
  for (Time i = 0; i < ticks; ++i) {
    network.tick();
  }
}

void expect_everywhere(TestNetwork& network, const Answer& expected) {
  wait(network, kLong);
  ASSERT_TRUE(network.run());
  EXPECT_TRUE(network.is_every([&](const Agent& agent) {
    return agent.answer().verdict == expected.verdict && agent.answer().reason == expected.reason &&
           agent.answer().load_ratio_max == network.agent(0).answer().load_ratio_max;
  }));
  EXPECT_EQ(network.agent(0).answer().verdict, expected.verdict);
  EXPECT_NEAR(network.agent(0).answer().load_ratio_max, expected.load_ratio_max, 2e-3);
}

/// A module that is held and two beside it; a third is planned, and comes at any moment of what
/// that sets off. Its closed form: 9 W / Fmax at the first connection.
TEST(Renewal, a_module_comes_while_others_work) {
  const auto setup = keeping_setup();
  const Answer expected{.verdict = Verdict::kSafe,
                        .reason = Reason::kHolds,
                        .load_ratio_max = static_cast<float>(9 * kWeight / 14.97)};
  int unfinished = 0;
  for (Time moment = 0; moment < kLong; moment += moment < 100 ? 1 : 50) {
    SCOPED_TRACE(::testing::Message() << "after " << moment);
    TestNetwork network(
        setup, {{.cell = {0, 0, 1}, .is_fixed = true}, {.cell = {1, 0, 1}}, {.cell = {2, 0, 1}}},
        {.in_parts = true});
    ASSERT_TRUE(network.run());
    wait(network, kLong);
    network.plan(0, {3, 0, 1});
    wait(network, moment);
    unfinished += network.is_unfinished(2) ? 1 : 0;
    network.attach({.cell = {3, 0, 1}});
    expect_everywhere(network, expected);
    if (moment + 100 > kLong) {
      EXPECT_EQ(network.agent(0).epoch(), 1);
    }
  }
  EXPECT_GT(unfinished, 0);
}

/// Blocks have too many loops for elimination. One plan, and at any moment of what it sets off
/// another in place of it: what is said in the end is what a robot says that starts with that.
TEST(Renewal, plans_change_while_others_work) {
  std::vector<Place> places;
  for (std::int32_t i = 0; i < 8; ++i) {
    places.push_back({.cell = {i % 2, i / 2 % 2, i / 4}});
  }
  const auto fresh_setup = table_setup();
  TestNetwork fresh(fresh_setup, places);
  fresh.plan(0, {2, 1, 1});
  wait(fresh, kLong);
  ASSERT_TRUE(fresh.run());
  const auto setup = keeping_setup();
  int unfinished = 0;
  for (Time moment = 0; moment < 4 * kLong; moment += moment < 100 ? 3 : 100) {
    SCOPED_TRACE(::testing::Message() << "after " << moment);
    TestNetwork network(setup, places, {.in_parts = true});
    ASSERT_TRUE(network.run());
    wait(network, kLong);
    network.plan(4, {-1, 0, 1});
    wait(network, moment);
    unfinished += network.is_unfinished(7) ? 1 : 0;
    network.plan(7, {2, 1, 1});
    network.withdraw(4, {-1, 0, 1});
    expect_everywhere(network, fresh.agent(0).answer());
  }
  EXPECT_GT(unfinished, 0);
}

/// A module between two others, which stands apart from the polynomial and is condensed: planned,
/// judged, withdrawn, without a new round.
TEST(Renewal, a_planned_module_between_others_is_condensed) {
  const auto setup = keeping_setup();
  std::vector<Place> places;
  for (const Cell& cell :
       {Cell{0, 0, 0}, Cell{0, 0, 1}, Cell{0, 1, 0}, Cell{0, 1, 1}, Cell{1, 0, 0}, Cell{1, 0, 1},
        Cell{1, 1, 0}, Cell{1, 1, 1}, Cell{0, 2, 1}, Cell{0, 3, 1}, Cell{1, 3, 1}}) {
    places.push_back({.cell = cell});
  }
  TestNetwork network(setup, places, {.in_parts = true});
  ASSERT_TRUE(network.run());
  wait(network, kLong);
  const Answer before = network.agent(0).answer();
  const auto fresh_setup = table_setup();
  TestNetwork fresh(fresh_setup, places);
  fresh.plan(0, {1, 2, 1});
  wait(fresh, kLong);
  ASSERT_TRUE(fresh.run());
  network.plan(3, {1, 2, 1});
  expect_everywhere(network, fresh.agent(0).answer());
  network.withdraw(3, {1, 2, 1});
  expect_everywhere(network, before);
  EXPECT_EQ(network.agent(0).epoch(), 1);
}

/// A U on the floor has its root in the middle of its base. What comes between its legs touches
/// their ends, two hops away from the root, and the root: whichever it hears first, it hangs on the
/// root, and the tree is as deep as before.
TEST(Renewal, a_module_that_comes_hangs_on_the_neighbour_nearest_to_the_root) {
  const auto setup = keeping_setup();
  for (int turns = 0; turns < 4; ++turns) {
    SCOPED_TRACE(::testing::Message() << turns << " quarter turns");
    const auto turned = [turns](Cell cell) {
      for (int i = 0; i < turns; ++i) {
        cell = {-cell.y, cell.x, cell.z};
      }
      return cell;
    };
    std::vector<Place> places;
    for (const Cell& cell :
         {Cell{0, 1, 0}, Cell{0, 0, 0}, Cell{1, 0, 0}, Cell{2, 0, 0}, Cell{2, 1, 0}}) {
      places.push_back({.cell = turned(cell)});
    }
    TestNetwork network(setup, places, {.in_parts = true});
    ASSERT_TRUE(network.run());
    wait(network, kLong);
    ASSERT_EQ(network.agent(2).depth(), 0);
    network.attach({.cell = turned({1, 1, 0})});
    wait(network, kLong);
    ASSERT_TRUE(network.run());
    EXPECT_EQ(network.agent(0).epoch(), 1);
    EXPECT_EQ(network.agent(5).depth(), 1);
    EXPECT_EQ(network.agent(5).answer().verdict, Verdict::kSafe);
  }
}

}  // namespace
}  // namespace holdfast::agent
