// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
//
// Cascades against deleting by hand: what is connected is found again from the cells, each piece is
// checked by itself, and what breaks, falls and stands must be that of the cascade. A bar on two
// hangers, by hand: by symmetry each carries half of what hangs, then one carries all.
#include "holdfast/plan/cascade.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <set>

#include "general_robot.hpp"
#include "holdfast/plan/losses.hpp"
#include "seeds.hpp"

namespace holdfast::plan {
namespace {

using base::Cell;
using model::RobotSpec;
using verdict::Verdict;
using Cells = std::vector<Cell>;
using Pairs = std::set<model::CellPair>;

model::CellPair in_order(const Cell& a, const Cell& b) {
  return a < b ? model::CellPair{a, b} : model::CellPair{b, a};
}

/// What is left of a robot, as somebody would delete it by hand.
struct Rest {
  RobotSpec spec;  ///< As it was.
  Pairs gone;      ///< Pairs that are not connected.
  std::set<Cell> cells;
};

std::vector<Cells> pieces_of(const Rest& rest) {
  std::set<Cell> left = rest.cells;
  std::vector<Cells> pieces;
  while (!left.empty()) {
    Cells piece = {*left.begin()};
    left.erase(left.begin());
    for (std::size_t i = 0; i < piece.size(); ++i) {
      for (const auto direction : base::directions(rest.spec.lattice)) {
        const Cell next = base::neighbour(rest.spec.lattice, piece[i], direction);
        if (left.contains(next) && !rest.gone.contains(in_order(piece[i], next))) {
          left.erase(next);
          piece.push_back(next);
        }
      }
    }
    std::ranges::sort(piece);
    pieces.push_back(std::move(piece));
  }
  return pieces;
}

/// The robot of a piece; none if nothing supports it.
std::optional<model::Robot> robot_of(const Rest& rest, const Cells& piece) {
  RobotSpec spec = rest.spec;
  spec.existing = piece;
  spec.released = {rest.gone.begin(), rest.gone.end()};
  model::forget_absent(spec);
  auto robot = model::Robot::create(spec, 1);
  return robot ? std::optional(std::move(robot).value()) : std::nullopt;
}

/// Deletes by hand what breaks and falls in one round. Returns what should be in the cascade.
CascadeRound delete_by_hand(Rest& rest) {
  CascadeRound round;
  Pairs broken;
  std::set<Cell> fallen;
  for (const Cells& piece : pieces_of(rest)) {
    const auto robot = robot_of(rest, piece);
    if (!robot) {
      fallen.insert(piece.begin(), piece.end());
      continue;
    }
    const auto assessment = verdict::assess(*robot, {.thread_count = 1});
    if (assessment.verdict == Verdict::kUnstable) {
      fallen.insert(piece.begin(), piece.end());
    }
    for (std::size_t i = 0;
         assessment.verdict == Verdict::kOverload && i < assessment.connections.size(); ++i) {
      if (verdict::breaks(assessment.connections[i].load_ratio)) {
        const auto [a, b] = model::ends(*robot, i);
        broken.insert(in_order(a, b));
        round.broken.push_back({.between = in_order(a, b)});
      }
    }
  }
  rest.gone.insert(broken.begin(), broken.end());
  for (const Cell& cell : fallen) {
    rest.cells.erase(cell);
  }
  for (const Cells& piece : pieces_of(rest)) {
    if (!robot_of(rest, piece)) {
      fallen.insert(piece.begin(), piece.end());
    }
  }
  for (const Cell& cell : fallen) {
    rest.cells.erase(cell);
  }
  round.fallen = {fallen.begin(), fallen.end()};
  return round;
}

Rest rest_of(const RobotSpec& spec) {
  Rest rest{.spec = spec, .gone = {}, .cells = {spec.existing.begin(), spec.existing.end()}};
  for (const model::CellPair& pair : spec.released) {
    rest.gone.insert(in_order(pair[0], pair[1]));
  }
  return rest;
}

Pairs pairs_of(const CascadeRound& round) {
  Pairs pairs;
  for (const BrokenConnection& broken : round.broken) {
    pairs.insert(in_order(broken.between[0], broken.between[1]));
  }
  return pairs;
}

struct Counts {
  int rounds = 0;
  int longest = 0;
  int stands = 0;
  int falls = 0;
};

/// What is left, round by round, against deleting by hand from `rest` on.
void compare(const Cascade& cascade, Rest rest, std::size_t first, Counts& counts) {
  if (cascade.outcome == CascadeOutcome::kUndecided) {
    return;
  }
  for (std::size_t i = first; i < cascade.rounds.size(); ++i) {
    const CascadeRound& round = cascade.rounds[i];
    const CascadeRound expected = delete_by_hand(rest);
    EXPECT_EQ(pairs_of(round), pairs_of(expected));
    EXPECT_EQ(std::set(round.fallen.begin(), round.fallen.end()),
              std::set(expected.fallen.begin(), expected.fallen.end()));
  }
  EXPECT_EQ(std::set(cascade.standing.begin(), cascade.standing.end()), rest.cells);
  for (const Cells& piece : pieces_of(rest)) {
    const auto robot = robot_of(rest, piece);
    ASSERT_TRUE(robot);
    EXPECT_EQ(verdict::assess(*robot, {.thread_count = 1}).verdict, Verdict::kSafe);
  }
  counts.rounds += static_cast<int>(cascade.rounds.size());
  counts.longest = std::max(counts.longest, static_cast<int>(cascade.rounds.size()));
  counts.stands += cascade.outcome == CascadeOutcome::kStands ? 1 : 0;
  counts.falls += cascade.outcome == CascadeOutcome::kFalls ? 1 : 0;
}

void compare(const RobotSpec& spec, Counts& counts) {
  const auto found = find_cascade(spec, {.equilibrium = {.thread_count = 1}});
  ASSERT_TRUE(found) << found.error().message;
  compare(found.value(), rest_of(spec), 0, counts);
}

/// The robot without a part, and what falls at once.
Rest without(const RobotSpec& spec, const Loss& loss, std::set<Cell>& fallen) {
  Rest rest = rest_of(spec);
  if (loss.kind == LossKind::kConnection) {
    rest.gone.insert(in_order(loss.cells[0], loss.cells[1]));
  } else if (loss.kind == LossKind::kModule) {
    rest.cells.erase(loss.cells[0]);
  } else if (loss.direction) {
    rest.spec.lost_facets.push_back({loss.cells[0], *loss.direction});
  } else {
    std::erase(rest.spec.fixed, loss.cells[0]);
  }
  for (const Cells& piece : pieces_of(rest)) {
    if (!robot_of(rest, piece)) {
      fallen.insert(piece.begin(), piece.end());
    }
  }
  for (const Cell& cell : fallen) {
    rest.cells.erase(cell);
  }
  return rest;
}

TEST(Cascade, after_a_loss_is_what_deleting_by_hand_and_checking_anew_gives) {
  Counts counts;
  std::size_t fatal_count = 0;
  for (const base::Lattice& lattice : test::kLattices) {
    for (std::uint64_t seed = 100; seed < 100 + test::campaign(12U); ++seed) {
      SCOPED_TRACE(seed);
      RobotSpec spec = test::general_robot(lattice, seed);
      const auto robot = model::Robot::create(spec, 1);
      ASSERT_TRUE(robot);
      const auto ratio = verdict::assess(robot.value(), {.thread_count = 1}).load_ratio_max;
      if (!ratio || *ratio <= 0) {
        continue;
      }
      spec = test::with_strengths_times(spec, *ratio * 1.2);
      const LossReport report =
          lose_each(spec, {.equilibrium = {.thread_count = 1}, .is_cascade_wanted = true});
      for (const LossAnswer& answer : report.fatal) {
        ASSERT_TRUE(answer.after);
        ++fatal_count;
        const auto found =
            find_cascade_after(spec, answer.loss, {.equilibrium = {.thread_count = 1}});
        ASSERT_TRUE(found) << found.error().message;
        const Cascade& cascade = found.value();
        EXPECT_EQ(answer.after->outcome, cascade.outcome);
        EXPECT_EQ(answer.after->round_count, cascade.rounds.size());
        EXPECT_EQ(answer.after->broken_count, cascade.broken_count());
        EXPECT_EQ(answer.after->fallen_count, cascade.fallen_count());
        EXPECT_GE(cascade.fallen_count(), answer.fallen_count);
        std::set<Cell> at_once;
        const Rest rest = without(spec, answer.loss, at_once);
        EXPECT_EQ(at_once.size(), answer.fallen_count);
        if (!at_once.empty()) {
          ASSERT_FALSE(cascade.rounds.empty());
          const Cells& first = cascade.rounds.front().fallen;
          EXPECT_EQ(std::set(first.begin(), first.end()), at_once);
          EXPECT_TRUE(cascade.rounds.front().broken.empty());
        }
        compare(cascade, rest, at_once.empty() ? 0 : 1, counts);
      }
    }
  }
  EXPECT_GE(fatal_count, test::least(100U));
  EXPECT_GE(counts.longest, 2);
  EXPECT_GE(counts.stands, 1);
  EXPECT_GE(counts.falls, 1);
}

TEST(Cascade, is_what_deleting_by_hand_and_checking_anew_gives) {
  Counts counts;
  for (const base::Lattice& lattice : test::kLattices) {
    for (std::uint64_t seed = 0; seed < test::campaign(40U); ++seed) {
      RobotSpec spec = test::with_open_faces(test::general_robot(lattice, seed), seed);
      spec = seed % 2 == 0 ? test::with_laws(spec, seed) : spec;
      const auto robot = model::Robot::create(spec, 1);
      ASSERT_TRUE(robot) << robot.error().message;
      const auto ratio = verdict::assess(robot.value(), {.thread_count = 1}).load_ratio_max;
      if (ratio && *ratio > 0) {  // So weak that a part of the connections break.
        compare(test::with_strengths_times(spec, *ratio * (seed % 3 == 0 ? 0.5 : 0.9)), counts);
      }
    }
  }
  EXPECT_GE(counts.rounds, static_cast<int>(test::least(60)));
  EXPECT_GE(counts.longest, 2);
  EXPECT_GE(counts.stands, 1);
  EXPECT_GE(counts.falls, 1);
}

/// Two hangers from fixed modules, five modules below these.
RobotSpec bar_on_hangers() {
  RobotSpec spec{
      .existing = {{0, 0, 3}, {2, 0, 3}, {0, 0, 2}, {2, 0, 2}, {0, 0, 1}, {1, 0, 1}, {2, 0, 1}},
      .fixed = {{0, 0, 3}, {2, 0, 3}},
      .support_z = {}};
  spec.material.strength_vertical_n = spec.material.strength_lateral_n = 1e6;
  return spec;
}

model::OwnConnector tension(const Cell& a, const Cell& b, double strength_n) {
  model::OwnConnector own{.between = {a, b}, .law = {}};
  own.law.strength_n = strength_n;
  own.law.lever_mm = 1e9;  // Bending does not count.
  return own;
}

TEST(Cascade, breaks_one_hanger_after_the_other) {
  RobotSpec spec = bar_on_hangers();
  const double weight = model::module_weight_n(spec.material);
  spec.own_connectors = {tension({0, 0, 2}, {0, 0, 3}, 2 * weight),
                         tension({2, 0, 2}, {2, 0, 3}, 4 * weight)};
  const auto found = find_cascade(spec);
  ASSERT_TRUE(found) << found.error().message;
  const Cascade& cascade = found.value();
  EXPECT_EQ(cascade.outcome, CascadeOutcome::kStands);
  ASSERT_EQ(cascade.rounds.size(), 2U);
  ASSERT_EQ(cascade.rounds[0].broken.size(), 1U);
  EXPECT_NEAR(cascade.rounds[0].broken[0].load_ratio, 2.5 / 2, 1e-6);
  EXPECT_EQ(cascade.rounds[0].broken[0].between[0], (Cell{0, 0, 2}));
  EXPECT_TRUE(cascade.rounds[0].fallen.empty());
  ASSERT_EQ(cascade.rounds[1].broken.size(), 1U);
  EXPECT_NEAR(cascade.rounds[1].broken[0].load_ratio, 5.0 / 4, 1e-6);
  EXPECT_EQ(cascade.rounds[1].fallen.size(), 5U);
  EXPECT_EQ(cascade.standing, (Cells{{0, 0, 3}, {2, 0, 3}}));
}

/// An arm of five beside a fixed module.
RobotSpec arm_of_five(double modulus_mpa) {
  RobotSpec spec{.fixed = {{0, 0, 0}}, .support_z = {}};
  for (int i = 0; i <= 5; ++i) {
    spec.existing.push_back({i, 0, 0});
  }
  spec.material.elastic_modulus_mpa = modulus_mpa;
  spec.is_modulus_stated = true;
  return spec;
}

// Bent, its levers are shorter: load ratios 1.0003 and 0.945 by an independent program.
TEST(Cascade, is_none_in_the_deformed_shape_where_bending_saves_an_arm) {
  const CascadeOptions bent{.equilibrium = {.thread_count = 1}, .is_deformed = true};
  const auto stiff = find_cascade(arm_of_five(100), bent);
  ASSERT_TRUE(stiff);
  EXPECT_EQ(stiff.value().outcome, CascadeOutcome::kStands);
  EXPECT_EQ(stiff.value().fallen_count(), 5U);
  const auto soft = find_cascade(arm_of_five(0.2), bent);
  ASSERT_TRUE(soft);
  EXPECT_EQ(soft.value().outcome, CascadeOutcome::kHolds);
}

// A thin column of 0.05 MPa and six modules has a buckling factor of 7.837 / 12 E L^2 / (W n^3), a
// half. It may lean and hold; one that tips over its foot does not.
TEST(Cascade, is_undecided_in_the_deformed_shape_where_a_piece_buckles) {
  RobotSpec spec{.fixed = {{0, 0, 0}}, .support_z = {}};
  for (int i = 0; i <= 6; ++i) {
    spec.existing.push_back({0, 0, i});
  }
  spec.material.elastic_modulus_mpa = 0.05;
  const CascadeOptions bent{.equilibrium = {.thread_count = 1}, .is_deformed = true};
  const auto found = find_cascade(spec, bent);
  ASSERT_TRUE(found);
  EXPECT_EQ(found.value().outcome, CascadeOutcome::kUndecided);
  ASSERT_FALSE(found.value().reasons.empty());
  EXPECT_EQ(found.value().reasons.front().reason.code, verdict::ReasonCode::kBuckles);
  spec.fixed = {};
  spec.support_z = 0;
  spec.material.elastic_modulus_mpa = 0.3;
  const double weight = 7 * model::module_weight_n(spec.material);
  spec.payloads = {{.cell = {0, 0, 6}, .force_n = {0.07 * weight, 0, 0}}};
  const auto tips = find_cascade(spec, bent);
  ASSERT_TRUE(tips);
  EXPECT_EQ(tips.value().outcome, CascadeOutcome::kFalls);
  const LossReport losses =
      lose_each(spec, {.equilibrium = {.thread_count = 1}, .is_deformed = true});
  EXPECT_EQ(losses.whole.verdict, Verdict::kUnstable);
}

// What hardly bends breaks, falls and stands as by linear theory.
TEST(Cascade, of_stiff_robots_is_the_same_in_the_deformed_shape) {
  std::size_t round_count = 0;
  for (const base::Lattice& lattice : test::kLattices) {
    for (std::uint64_t seed = 0; seed < test::campaign(25U); ++seed) {
      RobotSpec spec = test::general_robot(lattice, seed);
      spec.material.elastic_modulus_mpa = 1e6;
      const auto robot = model::Robot::create(spec, 1);
      ASSERT_TRUE(robot);
      CascadeOptions options{.equilibrium = {.is_bonded = true, .thread_count = 1}};
      const auto ratio = verdict::assess(robot.value(), options.equilibrium).load_ratio_max;
      if (!ratio || *ratio <= 0) {
        continue;
      }
      spec = test::with_strengths_times(spec, *ratio * 0.7);
      const auto linear = find_cascade(spec, options);
      options.is_deformed = true;
      const auto bent = find_cascade(spec, options);
      ASSERT_TRUE(linear && bent);
      if (linear.value().outcome == CascadeOutcome::kUndecided ||
          bent.value().outcome == CascadeOutcome::kUndecided) {
        continue;
      }
      EXPECT_EQ(bent.value().standing, linear.value().standing) << seed;
      EXPECT_EQ(bent.value().broken_count(), linear.value().broken_count()) << seed;
      round_count += bent.value().rounds.size();
    }
  }
  EXPECT_GE(round_count, test::least(50U));
}

TEST(Cascade, is_none_where_nothing_breaks) {
  const auto found = find_cascade(bar_on_hangers());
  ASSERT_TRUE(found);
  EXPECT_EQ(found.value().outcome, CascadeOutcome::kHolds);
  EXPECT_TRUE(found.value().rounds.empty());
  EXPECT_EQ(found.value().standing.size(), 7U);
}

/// An arm to one side topples at once: nothing breaks, and all falls. Planned modules count.
TEST(Cascade, of_a_robot_that_topples_is_one_round) {
  const RobotSpec spec{.existing = {{0, 0, 0}, {0, 0, 1}},
                       .planned = {{1, 0, 1}, {2, 0, 1}, {3, 0, 1}}};
  const auto found = find_cascade(spec);
  ASSERT_TRUE(found) << found.error().message;
  EXPECT_EQ(found.value().outcome, CascadeOutcome::kFalls);
  ASSERT_EQ(found.value().rounds.size(), 1U);
  EXPECT_TRUE(found.value().rounds[0].broken.empty());
  EXPECT_EQ(found.value().rounds[0].fallen.size(), 5U);
}

}  // namespace
}  // namespace holdfast::plan
