// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
//
// The whole program of the modules, in a network where every packet takes one tick. Expected values
// are closed forms of robots that are statically determinate:
// - n modules in a row beside a fixed one: the first connection bends by W L (1/2 + 3/2 + ...) =
//   W L n^2 / 2, so with L = a its load ratio is n^2 W / Fmax = 0.0400 n^2.
// - n modules on top of each other carry W (n - 1) at the bottom: -W (n - 1) / Fmax there, and the
//   connection at the top has the largest ratio, -W / Fmax.
// The tolerance is what conductor.cpp promises for every ratio, 1e-3 (1 + ratio), or what follows
// from it.
#include "holdfast/agent/agent.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <set>
#include <vector>

#include "test_network.hpp"

namespace holdfast::agent {
namespace {

using namespace holdfast::agent::test;
using base::Cell;
using base::Direction;

constexpr double kRowRatio = kWeight / 14.97;  // n^2 times this.

/// A fixed module and n beside it, off the ground.
std::vector<Place> row(int n) {
  std::vector<Place> places = {{.cell = {0, 0, 1}, .is_fixed = true}};
  for (int x = 1; x <= n; ++x) {
    places.push_back({.cell = {x, 0, 1}});
  }
  return places;
}

void expect_agreement(const TestNetwork& network) {
  const Answer& first = network.agent(0).answer();
  EXPECT_TRUE(network.is_every([&](const Agent& agent) {
    const Answer& answer = agent.answer();
    return answer.verdict == first.verdict && answer.reason == first.reason &&
           answer.load_ratio_max == first.load_ratio_max && answer.worst_cell == first.worst_cell &&
           answer.worst_direction == first.worst_direction;
  }));
}

void expect_answer(const TestNetwork& network, Verdict verdict, Reason reason) {
  expect_agreement(network);
  EXPECT_EQ(network.agent(0).answer().verdict, verdict) << name(network.agent(0).answer().verdict);
  EXPECT_EQ(network.agent(0).answer().reason, reason) << name(network.agent(0).answer().reason);
}

void expect_ratio(const TestNetwork& network, double ratio) {
  EXPECT_NEAR(static_cast<double>(network.agent(0).answer().load_ratio_max), ratio,
              1e-3 * (1 + std::abs(ratio)));
}

/// The distance in hops along the axes.
int distance(const Cell& a, const Cell& b) {
  return std::abs(a.x - b.x) + std::abs(a.y - b.y) + std::abs(a.z - b.z);
}

TEST(Agent, fits_into_a_small_memory) { EXPECT_LE(sizeof(Agent), kAgentBytesMax); }

TEST(Agent, a_single_module_holds) {
  const auto setup = table_setup();
  TestNetwork network(setup, {{{5, 5, 0}}});
  ASSERT_TRUE(network.run());
  EXPECT_TRUE(network.agent(0).is_root());
  expect_answer(network, Verdict::kSafe, Reason::kHolds);
}

TEST(Agent, a_module_held_from_outside_holds_another) {
  const auto setup = table_setup();
  TestNetwork network(setup, row(1));
  ASSERT_TRUE(network.run());
  expect_answer(network, Verdict::kSafe, Reason::kHolds);
  expect_ratio(network, kRowRatio);
  EXPECT_FLOAT_EQ(network.agent(1).own_load_ratio(), network.agent(0).answer().load_ratio_max);
}

TEST(Agent, a_module_stands_on_another) {
  const auto setup = table_setup();
  TestNetwork network(setup, {{{0, 0, 0}}, {{0, 0, 1}}});
  ASSERT_TRUE(network.run());
  expect_answer(network, Verdict::kSafe, Reason::kHolds);
  expect_ratio(network, -kWeight / 11.98);
}

TEST(Agent, a_row_holds_up_to_its_closed_form) {
  const auto setup = table_setup();
  for (const int n : {3, 4, 6}) {
    TestNetwork network(setup, row(n));
    ASSERT_TRUE(network.run());
    const bool holds = n * n * kRowRatio < 1;
    expect_answer(network, holds ? Verdict::kSafe : Verdict::kOverload,
                  holds ? Reason::kHolds : Reason::kBreaks);
    expect_ratio(network, n * n * kRowRatio);
    // The worst connection is the first: named by the first of its two cells.
    EXPECT_EQ(network.agent(0).answer().worst_cell, (Cell{0, 0, 1}));
    EXPECT_EQ(network.agent(0).answer().worst_direction, Direction::kPlusX);
  }
}

/// 25 W / Fmax = 1.00034: a third of that distance from 1 is what the bound must come to.
TEST(Agent, a_row_that_just_breaks_breaks) {
  const auto setup = table_setup();
  TestNetwork network(setup, row(5));
  ASSERT_TRUE(network.run());
  expect_answer(network, Verdict::kOverload, Reason::kBreaks);
  EXPECT_NEAR(static_cast<double>(network.agent(0).answer().load_ratio_max), 25 * kRowRatio,
              1.2e-4);
}

TEST(Agent, every_method_finds_the_same) {
  for (const Method method : {Method::kPolynomial, Method::kElimination, Method::kFronts}) {
    auto setup = table_setup();
    setup.method = method;
    TestNetwork network(setup, row(3));
    ASSERT_TRUE(network.run());
    expect_answer(network, Verdict::kSafe, Reason::kHolds);
    expect_ratio(network, 9 * kRowRatio);
  }
}

/// The weight beyond the edge of the only foot: centre of mass at 0.75 of a pitch.
TEST(Agent, a_robot_that_topples_is_unstable) {
  const auto setup = table_setup();
  TestNetwork network(setup, {{{0, 0, 0}}, {{0, 0, 1}}, {{1, 0, 1}}, {{2, 0, 1}}});
  ASSERT_TRUE(network.run());
  expect_answer(network, Verdict::kUnstable, Reason::kTopples);
}

std::vector<Place> cube() {
  std::vector<Place> places;
  for (const int x : {0, 1}) {
    for (const int y : {0, 1}) {
      for (const int z : {0, 1}) {
        places.push_back({.cell = {x - 3, y + 7, z}});
      }
    }
  }
  return places;
}

/// Faces of connections with two ends: every module but one has a parent that lies one cell higher.
void expect_tree(const TestNetwork& network) {
  int root_count = 0;
  for (std::size_t i = 0; i < network.size(); ++i) {
    const Agent& agent = network.agent(i);
    root_count += agent.is_root() ? 1 : 0;
    if (agent.parent() < 0) {
      EXPECT_EQ(agent.depth(), 0);
      continue;
    }
    const Cell above = base::neighbour(agent.cell(), static_cast<Direction>(agent.parent()));
    bool is_found = false;
    for (std::size_t j = 0; j < network.size(); ++j) {
      if (network.places()[j].cell == above) {
        is_found = true;
        EXPECT_EQ(network.agent(j).depth() + 1, agent.depth());
      }
    }
    EXPECT_TRUE(is_found);
  }
  EXPECT_EQ(root_count, 1);
}

TEST(Agent, a_cube_agrees_and_everybody_knows_where_it_is) {
  const auto setup = table_setup();
  TestNetwork network(setup, cube());
  ASSERT_TRUE(network.run());
  expect_answer(network, Verdict::kSafe, Reason::kHolds);
  for (std::size_t i = 0; i < network.size(); ++i) {
    EXPECT_TRUE(network.agent(i).has_cell());
    EXPECT_EQ(network.agent(i).cell(), network.places()[i].cell);
    EXPECT_EQ(network.agent(i).epoch(), 1);
  }
  expect_tree(network);
}

// ---- Losses.

/// A column with an arm of four and a foot on the other side, all off one plane.
std::vector<Place> bracket() {
  return {{.cell = {0, 0, 0}, .is_fixed = true},
          {.cell = {0, 0, 1}},
          {.cell = {1, 0, 1}},
          {.cell = {2, 0, 1}},
          {.cell = {2, 1, 1}},
          {.cell = {2, 2, 1}},
          {.cell = {0, -1, 1}}};
}

struct Outcome {
  Answer answer;
  Time ticks = 0;
};

Outcome run_bracket(double loss, std::uint64_t seed) {
  const auto setup = table_setup();
  TestNetwork network(setup, bracket(), {.loss = loss, .seed = seed});
  EXPECT_TRUE(network.run()) << "seed " << seed;
  expect_agreement(network);
  return {network.agent(0).answer(), network.now()};
}

TEST(Agent, losses_change_the_time_and_not_the_answer) {
  const Outcome calm = run_bracket(0, 1);
  ASSERT_EQ(calm.answer.verdict, Verdict::kSafe);
  std::set<Time> times;
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    const Outcome lossy = run_bracket(0.1, seed);
    EXPECT_EQ(lossy.answer.verdict, calm.answer.verdict) << "seed " << seed;
    EXPECT_EQ(lossy.answer.reason, calm.answer.reason);
    EXPECT_EQ(lossy.answer.worst_cell, calm.answer.worst_cell);
    EXPECT_EQ(lossy.answer.worst_direction, calm.answer.worst_direction);
    // Another tree rounds otherwise and stops elsewhere within the tolerance.
    EXPECT_NEAR(static_cast<double>(lossy.answer.load_ratio_max),
                static_cast<double>(calm.answer.load_ratio_max), 2e-3 * 2);
    EXPECT_GT(lossy.ticks, calm.ticks);
    times.insert(lossy.ticks);
  }
  EXPECT_GT(times.size(), 1U);
}

/// A ring on a fixed module with planned ones at its far corner, the last of which stands on the
/// ground: loops, leaves and a facet. Half of the pieces are interrupted by packets.
TEST(Agent, a_piece_at_a_time_finds_the_same) {
  const auto setup = table_setup();
  std::vector<Place> places = {{.cell = {0, 0, 1}, .is_fixed = true}};
  for (const Cell& cell : {Cell{1, 0, 1}, Cell{2, 0, 1}, Cell{2, 1, 1}, Cell{2, 2, 1},
                           Cell{1, 2, 1}, Cell{0, 2, 1}, Cell{0, 1, 1}}) {
    places.push_back({.cell = cell});
  }
  std::vector<Answer> answers;
  for (const bool in_parts : {false, true}) {
    TestNetwork network(setup, places, {.in_parts = in_parts});
    network.plan(0, {3, 2, 1});
    network.plan(0, {4, 2, 1});
    network.plan(0, {4, 2, 0});
    ASSERT_TRUE(network.run_anew());
    expect_agreement(network);
    answers.push_back(network.agent(0).answer());
    EXPECT_EQ(network.unfinished_count() > 100, in_parts);
  }
  EXPECT_EQ(answers[0].verdict, Verdict::kSafe);
  EXPECT_EQ(answers[1].verdict, Verdict::kSafe);
  EXPECT_EQ(answers[1].worst_cell, answers[0].worst_cell);
  EXPECT_NEAR(answers[1].load_ratio_max, answers[0].load_ratio_max, 1e-5);
}

/// Two rows side by side, fixed at one end, too many loops for elimination and deep enough for
/// clusters: a piece at a time and with losses, the answer is the same. (That it is right is tested
/// in tests/distributed.)
TEST(Agent, clusters_find_the_same_a_piece_at_a_time) {
  const auto setup = table_setup();
  std::vector<Place> places;
  for (int x = 0; x < 132; ++x) {
    places.push_back({.cell = {x, 0, 1}, .is_fixed = x == 0});
    places.push_back({.cell = {x, 1, 1}, .is_fixed = x == 0});
  }
  std::vector<Answer> answers;
  for (const bool in_parts : {false, true}) {
    TestNetwork network(setup, places, {.loss = in_parts ? 0.01 : 0, .in_parts = in_parts});
    int shifts = 0;
    network.watch = [&](std::size_t, Direction, std::span<const std::uint8_t> packet) {
      shifts += packet.size() > 2 && packet[2] == 0x0d ? 1 : 0;  // Branch down.
    };
    ASSERT_TRUE(network.run());
    EXPECT_GT(shifts, 100);
    expect_agreement(network);
    answers.push_back(network.agent(0).answer());
  }
  EXPECT_EQ(answers[0].verdict, Verdict::kOverload);
  EXPECT_EQ(answers[1].worst_cell, answers[0].worst_cell);
  EXPECT_NEAR(answers[1].load_ratio_max / answers[0].load_ratio_max, 1, 2e-3);
}

TEST(Agent, the_same_seed_gives_the_same_bits) {
  for (const std::uint64_t seed : {1U, 2U, 3U}) {
    const Outcome first = run_bracket(0.1, seed);
    const Outcome second = run_bracket(0.1, seed);
    EXPECT_EQ(first.ticks, second.ticks);
    EXPECT_EQ(first.answer.load_ratio_max, second.answer.load_ratio_max);
  }
}

/// All that the anchor reaches know it, and so do the neighbours of the silent one beyond it. Who
/// is further beyond hears no wave, and its own clock says so.
TEST(Agent, a_module_that_never_answers_makes_it_undecided) {
  const auto setup = table_setup();
  for (std::size_t mute = 1; mute < bracket().size(); ++mute) {
    std::vector<Place> places = bracket();
    places[mute].is_mute = true;
    TestNetwork network(setup, places);
    for (int ticks = 0; ticks < 5'000; ++ticks) {
      network.tick();
      ASSERT_TRUE(network.is_every([](const Agent& agent) {
        return agent.answer().verdict == Verdict::kNone ||
               agent.answer().reason == Reason::kNeighbourSilent ||
               agent.answer().reason == Reason::kNoAnchor;
      }));
    }
    for (std::size_t i = 0; i < places.size(); ++i) {
      const bool is_beside = distance(places[i].cell, places[mute].cell) == 1;
      if (i != mute) {
        EXPECT_EQ(network.agent(i).answer().verdict, Verdict::kUndecided) << i << ' ' << mute;
        EXPECT_EQ(network.agent(i).answer().reason == Reason::kNoAnchor,
                  !is_beside && !network.agent(i).has_cell());
      }
    }
  }
}

/// The module falls silent in the middle of the computation; its neighbours ping it in vain.
TEST(Agent, a_module_that_falls_silent_makes_it_undecided) {
  const auto setup = table_setup();
  TestNetwork network(setup, row(6));
  ASSERT_TRUE(
      network.run_until([](const Agent& agent) { return agent.phase() == Phase::kEquilibrium; }));
  network.mute(6);
  ASSERT_TRUE(network.run());
  expect_answer(network, Verdict::kUndecided, Reason::kNeighbourSilent);
  EXPECT_GT(network.agent(0).epoch(), 1);
}

// ---- Changes.

TEST(Agent, what_is_left_after_a_module_is_taken_off_begins_anew) {
  const auto setup = table_setup();
  TestNetwork network(setup, row(6));
  ASSERT_TRUE(
      network.run_until([](const Agent& agent) { return agent.phase() == Phase::kEquilibrium; }));
  network.remove(6);
  network.remove(5);
  ASSERT_TRUE(network.run());
  expect_answer(network, Verdict::kSafe, Reason::kHolds);
  expect_ratio(network, 16 * kRowRatio);
  EXPECT_GT(network.agent(0).epoch(), 1);
}

/// This holds after the verdict, too, and whenever it happens.
TEST(Agent, a_change_at_any_time_gives_the_answer_for_what_is_left) {
  const auto setup = table_setup();
  TestNetwork whole(setup, row(5));
  ASSERT_TRUE(whole.run());
  for (Time at = 1; at < whole.now() + 20; at += whole.now() / 25) {
    TestNetwork network(setup, row(5));
    while (network.now() < at) {
      network.tick();
    }
    network.remove(5);
    ASSERT_TRUE(network.run_anew()) << "removed at " << at;
    expect_answer(network, Verdict::kSafe, Reason::kHolds);
    expect_ratio(network, 16 * kRowRatio);
  }
}

TEST(Agent, a_robot_cut_in_two_has_two_answers) {
  const auto setup = table_setup();
  TestNetwork network(setup, row(6));
  ASSERT_TRUE(network.run());
  network.remove(3);
  ASSERT_TRUE(network.run_anew());
  for (const std::size_t i : {0U, 1U, 2U}) {
    EXPECT_EQ(network.agent(i).answer().verdict, Verdict::kSafe);
    EXPECT_NEAR(static_cast<double>(network.agent(i).answer().load_ratio_max), 4 * kRowRatio, 2e-3);
  }
  for (const std::size_t i : {4U, 5U, 6U}) {  // Nothing supports them.
    EXPECT_EQ(network.agent(i).answer().verdict, Verdict::kUnstable);
  }
}

/// Nobody is told but the module itself: the others learn it from its greeting.
TEST(Agent, a_module_that_starts_again_is_taken_in_again) {
  const auto setup = table_setup();
  for (const std::size_t again : {0U, 1U, 3U}) {
    TestNetwork network(setup, row(3));
    ASSERT_TRUE(network.run());
    const std::uint16_t epoch = network.agent(2).epoch();
    network.start(again);
    ASSERT_TRUE(network.run_until([&](const Agent& agent) {
      return agent.phase() == Phase::kDone && agent.epoch() > epoch;
    })) << "module "
        << again;
    expect_answer(network, Verdict::kSafe, Reason::kHolds);
    expect_ratio(network, 9 * kRowRatio);
  }
}

/// Modules start again at random, most often while the others work, and one in ten packets is
/// lost. It must end, and as if nothing had happened.
TEST(Agent, it_survives_modules_that_start_again_at_random) {
  const auto setup = table_setup();
  const Outcome calm = run_bracket(0, 1);
  for (std::uint64_t seed = 1; seed <= 30; ++seed) {
    base::Rng rng(seed);
    TestNetwork network(setup, bracket(), {.loss = 0.1, .seed = seed});
    for (int i = 0; i < 4; ++i) {
      for (std::uint64_t ticks = rng.below(calm.ticks); ticks > 0; --ticks) {
        network.tick();
      }
      network.start(rng.below(network.size()));
    }
    ASSERT_TRUE(network.run_anew()) << "seed " << seed;
    expect_answer(network, calm.answer.verdict, calm.answer.reason);
    EXPECT_NEAR(static_cast<double>(network.agent(0).answer().load_ratio_max),
                static_cast<double>(calm.answer.load_ratio_max), 4e-3)
        << "seed " << seed;
  }
}

// ---- Planned modules.

TEST(Agent, a_planned_module_counts_as_if_it_were_there) {
  const auto setup = table_setup();
  TestNetwork network(setup, row(3));
  network.plan(1, {4, 0, 1});
  ASSERT_TRUE(network.run());
  expect_answer(network, Verdict::kSafe, Reason::kHolds);
  expect_ratio(network, 16 * kRowRatio);
  // Two more, told to different modules after the verdict, are too much.
  network.plan(0, {5, 0, 1});
  network.plan(3, {6, 0, 1});
  ASSERT_TRUE(network.run_anew());
  expect_answer(network, Verdict::kOverload, Reason::kBreaks);
  expect_ratio(network, 36 * kRowRatio);
}

/// Two arms beside each other, held at one corner.
std::vector<Place> two_arms() {
  return {{.cell = {0, 0, 1}, .is_fixed = true},
          {.cell = {1, 0, 1}},
          {.cell = {2, 0, 1}},
          {.cell = {2, 1, 1}},
          {.cell = {2, 2, 1}},
          {.cell = {0, 1, 1}},
          {.cell = {0, 2, 1}}};
}

/// The answer with these modules planned, or built.
Answer answer_with(const agent::Setup& setup, const std::vector<Cell>& cells, bool is_planned) {
  std::vector<Place> places = two_arms();
  for (const Cell& cell : cells) {
    if (!is_planned) {
      places.push_back({.cell = cell});
    }
  }
  TestNetwork network(setup, places);
  for (const Cell& cell : cells) {
    if (is_planned) {
      network.plan(static_cast<std::size_t>(cell.y), cell);
    }
  }
  EXPECT_TRUE(network.run());
  expect_agreement(network);
  return network.agent(0).answer();
}

/// Planned modules that close a ring have neighbours in different branches of the tree. The second
/// method is the same robot with these modules built.
TEST(Agent, planned_modules_between_two_branches_count_as_if_they_were_there) {
  const auto setup = table_setup();
  const std::vector<std::vector<Cell>> plans = {{{1, 2, 1}}, {{1, 1, 1}}, {{1, 1, 1}, {1, 2, 1}}};
  for (const auto& plan : plans) {
    const Answer planned = answer_with(setup, plan, true);
    const Answer built = answer_with(setup, plan, false);
    EXPECT_EQ(planned.verdict, built.verdict);
    EXPECT_NE(built.verdict, Verdict::kUndecided);
    EXPECT_NEAR(static_cast<double>(planned.load_ratio_max),
                static_cast<double>(built.load_ratio_max), 4e-3);
  }
}

/// A strength that makes the largest ratio 1.000002: to tell it from 1 the error must come below
/// 7e-7. Near 1 a ratio is worked out the better, the nearer it is, so a few rounds find it.
TEST(Agent, tells_a_ratio_from_one_with_remote_planned_modules_as_well) {
  auto setup = table_setup();
  const std::vector<Cell> plan = {{1, 2, 1}};
  setup.strength_vertical_n = 1e3;
  for (int round = 0; round < 4; ++round) {
    const Answer built = answer_with(setup, plan, false);
    setup.strength_lateral_n *= static_cast<double>(built.load_ratio_max) / 1.000002;
  }
  EXPECT_EQ(answer_with(setup, plan, false).verdict, Verdict::kOverload);
  EXPECT_EQ(answer_with(setup, plan, true).verdict, Verdict::kOverload);
}

TEST(Agent, planned_modules_it_cannot_judge_make_it_undecided) {
  const auto setup = table_setup();
  TestNetwork detached(setup, row(3));
  detached.plan(1, {3, 0, 2});
  detached.plan(1, {9, 9, 9});
  ASSERT_TRUE(detached.run());
  expect_answer(detached, Verdict::kUndecided, Reason::kPlannedDetached);

  TestNetwork many(setup, row(3));
  TestNetwork too_many_here(setup, row(3));
  for (int i = 0; i <= kPlannedMax; ++i) {
    many.plan(i < 3 ? 1 : 2, {2, 0, 2 + i});
    too_many_here.plan(1, {2, 0, 2 + i});
  }
  ASSERT_TRUE(many.run());
  expect_answer(many, Verdict::kUndecided, Reason::kPlannedTooMany);
  ASSERT_TRUE(too_many_here.run());
  expect_answer(too_many_here, Verdict::kUndecided, Reason::kPlannedTooMany);
}

// ---- Plans end. The robot is the row, as above: the load ratio of n modules is n^2 kRowRatio.

void expect_no_plans(const TestNetwork& network) {
  for (std::size_t i = 0; i < network.size(); ++i) {
    EXPECT_EQ(network.agent(i).announcements(), Announcements()) << "module " << i;
  }
}

TEST(Agent, a_plan_of_a_cell_with_a_module_is_fulfilled_at_once) {
  const auto setup = table_setup();
  TestNetwork network(setup, row(3));
  network.plan(1, {3, 0, 1});
  network.plan(0, {3, 0, 1});
  network.plan(2, {4, 0, 1});
  ASSERT_TRUE(network.run());
  expect_answer(network, Verdict::kSafe, Reason::kHolds);
  expect_ratio(network, 16 * kRowRatio);
  EXPECT_EQ(network.agent(0).announcements().count(), 0);
  EXPECT_EQ(network.agent(1).announcements().count(), 0);
  EXPECT_EQ(network.agent(2).announcements().count(), 1);
}

TEST(Agent, a_plan_told_six_times_or_to_three_modules_is_one_plan) {
  const auto setup = table_setup();
  TestNetwork network(setup, row(3));
  for (int i = 0; i < 6; ++i) {
    network.plan(2, {4, 0, 1});
  }
  network.plan(0, {4, 0, 1});
  network.plan(1, {4, 0, 1});
  ASSERT_TRUE(network.run());
  expect_ratio(network, 16 * kRowRatio);
  for (int i = 0; i < 6; ++i) {
    network.plan(2, {4, 0, 1});
    ASSERT_TRUE(network.run_anew());
    expect_answer(network, Verdict::kSafe, Reason::kHolds);
    expect_ratio(network, 16 * kRowRatio);
  }
}

TEST(Agent, a_plan_is_withdrawn_through_any_module) {
  const auto setup = table_setup();
  for (const std::size_t by : {0U, 1U, 2U}) {
    TestNetwork network(setup, row(3));
    network.plan(2, {4, 0, 1});
    network.plan(1, {4, 0, 1});
    network.plan(0, {5, 0, 1});
    ASSERT_TRUE(network.run());
    expect_ratio(network, 25 * kRowRatio);
    network.withdraw(by, {5, 0, 1});
    ASSERT_TRUE(network.run_anew());
    expect_ratio(network, 16 * kRowRatio);
    network.withdraw(by, {4, 0, 1});
    ASSERT_TRUE(network.run_anew());
    expect_answer(network, Verdict::kSafe, Reason::kHolds);
    expect_ratio(network, 9 * kRowRatio);
    expect_no_plans(network);
    // Planned anew it counts again: the withdrawal is not kept.
    network.plan(0, {4, 0, 1});
    ASSERT_TRUE(network.run_anew());
    expect_ratio(network, 16 * kRowRatio);
  }
}

TEST(Agent, a_withdrawal_of_what_is_not_planned_changes_nothing_and_is_forgotten) {
  const auto setup = table_setup();
  TestNetwork network(setup, row(3));
  network.plan(0, {4, 0, 1});
  network.withdraw(2, {9, 9, 9});
  ASSERT_TRUE(network.run());
  expect_ratio(network, 16 * kRowRatio);
  EXPECT_EQ(network.agent(2).announcements().count(), 0);
}

/// What was told to two modules with no round between: nobody knows what holds.
TEST(Agent, a_plan_and_its_withdrawal_at_once_are_undecided_until_one_is_told_again) {
  const auto setup = table_setup();
  for (const int way : {0, 1, 2}) {
    TestNetwork network(setup, row(3));
    network.withdraw(2, {4, 0, 1});
    network.plan(0, {4, 0, 1});
    ASSERT_TRUE(network.run());
    expect_answer(network, Verdict::kUndecided, Reason::kPlanDisputed);
    if (way == 0) {
      network.withdraw(1, {4, 0, 1});
    } else if (way == 1) {
      network.withdraw(1, kEveryCell);
    } else {
      network.plan(0, {4, 0, 1});
    }
    ASSERT_TRUE(network.run_anew());
    expect_answer(network, Verdict::kSafe, Reason::kHolds);
    expect_ratio(network, (way == 2 ? 16 : 9) * kRowRatio);
  }
}

/// One module, the latest word: no doubt about the order.
TEST(Agent, the_latest_word_to_one_module_holds) {
  const auto setup = table_setup();
  TestNetwork network(setup, row(3));
  network.plan(1, {4, 0, 1});
  network.withdraw(1, {4, 0, 1});
  ASSERT_TRUE(network.run());
  expect_ratio(network, 9 * kRowRatio);
  expect_no_plans(network);
}

TEST(Agent, too_many_plans_end_by_withdrawals) {
  const auto setup = table_setup();
  TestNetwork many(setup, row(3));
  TestNetwork too_many_here(setup, row(3));
  for (int i = 0; i <= kPlannedMax; ++i) {
    many.plan(i < 3 ? 1 : 2, {4 + i, 0, 1});
    too_many_here.plan(1, {4 + i, 0, 1});
  }
  ASSERT_TRUE(many.run());
  ASSERT_TRUE(too_many_here.run());
  many.withdraw(0, {4 + kPlannedMax, 0, 1});
  ASSERT_TRUE(many.run_anew());
  expect_ratio(many, (3 + kPlannedMax) * (3 + kPlannedMax) * kRowRatio);
  // What was lost cannot be named.
  too_many_here.withdraw(0, {4, 0, 1});
  ASSERT_TRUE(too_many_here.run_anew());
  expect_answer(too_many_here, Verdict::kUndecided, Reason::kPlannedTooMany);
  too_many_here.withdraw(2, kEveryCell);
  ASSERT_TRUE(too_many_here.run_anew());
  expect_answer(too_many_here, Verdict::kSafe, Reason::kHolds);
  expect_ratio(too_many_here, 9 * kRowRatio);
  expect_no_plans(too_many_here);
}

/// A cell like that is told to nobody: a neighbour would refuse it, and count its sender as silent.
TEST(Agent, a_plan_outside_the_lattice_is_lost_until_all_are_withdrawn) {
  const auto setup = table_setup();
  for (const std::int32_t x : {base::kCoordinateMax + 1, -(1 << 23)}) {
    TestNetwork network(setup, row(3));
    network.plan(1, {x, 0, 0});
    ASSERT_TRUE(network.run());
    expect_answer(network, Verdict::kUndecided, Reason::kPlannedTooMany);
    network.withdraw(2, {x, 0, 0});
    network.withdraw(2, kEveryCell);
    ASSERT_TRUE(network.run_anew());
    expect_answer(network, Verdict::kSafe, Reason::kHolds);
    expect_no_plans(network);
  }
}

/// A sixth plan that has ended is none too many, wherever it stands in their order.
TEST(Agent, a_plan_that_has_ended_does_not_count_as_one_too_many) {
  const auto setup = table_setup();
  TestNetwork network(setup, row(3));
  for (int i = 0; i < kPlannedMax; ++i) {
    network.plan(static_cast<std::size_t>(i % 3), {2 - i % 3, -1 - i / 3, 1});
  }
  network.plan(0, {3, 0, 1});
  ASSERT_TRUE(network.run());
  EXPECT_NE(network.agent(0).answer().reason, Reason::kPlannedTooMany);
  EXPECT_EQ(network.agent(0).announcements().count(), 2);
}

/// The holder does not answer for a while; a withdrawal waits for it.
TEST(Agent, a_withdrawal_waits_until_the_robot_is_whole) {
  const auto setup = table_setup();
  TestNetwork network(setup, row(3));
  network.plan(2, {4, 0, 1});
  ASSERT_TRUE(network.run());
  network.mute(2);
  network.withdraw(0, {4, 0, 1});
  ASSERT_TRUE(network.run_anew());
  EXPECT_EQ(network.agent(0).answer().reason, Reason::kNeighbourSilent);
  EXPECT_EQ(network.agent(0).announcements().count(), 1);
}

/// A round that is given up at any moment must not take the withdrawal along before the plan.
TEST(Agent, a_withdrawal_outlives_a_round_that_is_given_up) {
  const auto setup = table_setup();
  for (int run = 0; run < 160; ++run) {
    SCOPED_TRACE(run);
    TestNetwork network(setup, row(3));
    network.plan(3, {4, 0, 1});
    ASSERT_TRUE(network.run());
    network.withdraw(0, {4, 0, 1});
    for (int i = 0; i < run / 2; ++i) {
      network.tick();
    }
    // Whichever of the two is not the root stands between it and one of the ends.
    network.withdraw(run % 2 == 0 ? 1 : 2, {9, 9, 9});
    ASSERT_TRUE(network.run_anew());
    expect_answer(network, Verdict::kSafe, Reason::kHolds);
    expect_ratio(network, 9 * kRowRatio);
    expect_no_plans(network);
  }
}

}  // namespace
}  // namespace holdfast::agent
