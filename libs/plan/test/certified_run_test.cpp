// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
//
// Steps that only attach, or only detach, are judged with bounds as they are without: the same
// verdicts and margins at every stage, whether the run holds or fails, and no load ratio above its
// bound. Random robots of all lattices, on floors, beside obstacles, held, with kinds and loads, of
// modules whose strength puts the largest load ratio of a random state just below, at or above 1.
#include <gtest/gtest.h>

#include <algorithm>

#include "family_spec.hpp"
#include "general_robot.hpp"
#include "holdfast/base/rng.hpp"
#include "holdfast/plan/part_of.hpp"
#include "holdfast/plan/sequence.hpp"
#include "nearest_first.hpp"
#include "random_robot.hpp"
#include "seeds.hpp"

namespace holdfast::plan {
namespace {

/// What a test counts, so that it is seen to have tried all kinds of runs.
struct Counts {
  int runs = 0;
  int certified = 0;
  int unsafe = 0;
};

/// A robot, and steps from it.
struct Plan {
  model::RobotSpec start;
  std::vector<model::Step> steps;
};

template <class Item>
void copy_of(const std::vector<Item>& all, const base::Cell& cell, std::vector<Item>& out) {
  std::ranges::copy_if(all, std::back_inserter(out),
                       [&](const Item& item) { return item.cell == cell; });
}

bool is_robot(const model::RobotSpec& spec) { return model::Robot::create(spec).has_value(); }

/// A connected robot of some modules of the whole, with all that are fixed, and then the others one
/// by one or in twos, in an order at random; none if there is no such part.
std::optional<Plan> random_plan(const model::RobotSpec& whole, base::Rng& rng, bool is_backwards) {
  const model::Robot robot = model::Robot::create(whole).value();
  const std::vector<Element> order = holdfast::test::nearest_first(robot);
  ElementSet there(order.size());
  std::size_t count = 0;
  const auto has_fixed = [&] {
    return std::ranges::all_of(whole.fixed, [&](const base::Cell& cell) {
      const auto found = std::ranges::find(whole.existing, cell) - whole.existing.begin();
      return there.contains(static_cast<Element>(found));
    });
  };
  while (count < order.size() && (count == 0 || !has_fixed() || !is_robot(part_of(whole, there)))) {
    there.insert(order[count++]);
  }
  Plan plan{.start = part_of(whole, there), .steps = {}};
  plan.start.released = whole.released;
  plan.start.own_connectors = whole.own_connectors;
  std::vector<Element> left(order.begin() + static_cast<std::ptrdiff_t>(count), order.end());
  while (!left.empty()) {
    if (plan.steps.empty() || rng.below(4) > 0) {
      plan.steps.emplace_back();
    }
    std::vector<Element> open;
    std::ranges::copy_if(left, std::back_inserter(open), [&](Element element) {
      return std::ranges::any_of(robot.connected()[base::at(element)], [&](std::int32_t other) {
        return other != model::Robot::kNoNeighbour && there.contains(other);
      });
    });
    if (open.empty()) {
      return std::nullopt;
    }
    const Element next = open[rng.below(static_cast<std::uint32_t>(open.size()))];
    const base::Cell cell = whole.existing[base::at(next)];
    plan.steps.back().attach.push_back(cell);
    copy_of(whole.own_kinds, cell, plan.steps.back().own_kinds);
    copy_of(whole.own_masses, cell, plan.steps.back().own_masses);
    copy_of(whole.payloads, cell, plan.steps.back().payloads);
    there.insert(next);
    std::erase(left, next);
  }
  if (is_backwards) {
    std::ranges::reverse(plan.steps);
    for (model::Step& step : plan.steps) {
      step = {.detach = step.attach};
    }
    plan.start = whole;
  }
  return plan;
}

/// Scales strengths so that the largest load ratio after a random step is `ratio`.
void scale_strengths(Plan& plan, double ratio, base::Rng& rng) {
  const auto judged = judge_sequence(plan.start, plan.steps);
  if (!judged || plan.steps.empty()) {
    return;
  }
  const auto step = rng.below(static_cast<std::uint32_t>(plan.steps.size()));
  const auto found = judged.value().steps[step].stages[2].load_ratio_max;
  if (found && *found > 1e-3) {
    plan.start = holdfast::test::with_strengths_times(plan.start, *found / ratio);
  }
}

void expect_same(const StageJudgement& judged, const StageJudgement& solved) {
  EXPECT_EQ(judged.verdict, solved.verdict);
  EXPECT_EQ(judged.margin_mm.has_value(), solved.margin_mm.has_value());
  EXPECT_NEAR(judged.margin_mm.value_or(0), solved.margin_mm.value_or(0), 1e-6);
  if (judged.is_bound) {
    // Multigrid's load ratios are good for 1e-4, direct solutions for far more.
    EXPECT_LE(solved.load_ratio_max.value_or(0), *judged.load_ratio_max + 1e-4);
    EXPECT_TRUE(judged.is_safe());
  } else {
    EXPECT_EQ(judged.load_ratio_max.has_value(), solved.load_ratio_max.has_value());
    EXPECT_NEAR(judged.load_ratio_max.value_or(0), solved.load_ratio_max.value_or(0), 1e-4);
  }
}

void expect_same_with_bounds(const Plan& plan, Counts& counts) {
  const auto solved = judge_sequence(plan.start, plan.steps);
  const auto judged = judge_sequence(plan.start, plan.steps, {.solved_count_max = 0});
  ASSERT_EQ(solved.has_value(), judged.has_value());
  if (!solved) {
    EXPECT_EQ(solved.error().message, judged.error().message);
    return;
  }
  ++counts.runs;
  const SequenceJudgement& mine = judged.value();
  EXPECT_EQ(mine.first_unsafe, solved.value().first_unsafe);
  EXPECT_EQ(mine.first_undecided, solved.value().first_undecided);
  counts.unsafe += mine.first_unsafe ? 1 : 0;
  ASSERT_EQ(mine.steps.size(), solved.value().steps.size());
  for (std::size_t i = 0; i < mine.steps.size(); ++i) {
    for (std::size_t k = 0; k < kStageCount; ++k) {
      SCOPED_TRACE(testing::Message() << "step " << i << " stage " << k);
      expect_same(mine.steps[i].stages[k], solved.value().steps[i].stages[k]);
      counts.certified += mine.steps[i].stages[k].is_bound ? 1 : 0;
    }
  }
  const auto shorter =
      judge_sequence(plan.start, plan.steps, {.ends_when_unsafe = true, .solved_count_max = 0});
  EXPECT_EQ(shorter.value().first_unsafe, mine.first_unsafe);
  EXPECT_EQ(shorter.value().steps.size(),
            mine.first_unsafe ? mine.first_unsafe->step + 1 : mine.steps.size());
}

void try_robot(const model::RobotSpec& whole, std::uint64_t seed, Counts& counts) {
  SCOPED_TRACE(testing::Message() << "seed " << seed);
  base::Rng rng(seed);
  constexpr std::array<double, 5> kRatios = {0.5, 0.999, 0.9999999, 1.001, 2};
  for (const bool is_backwards : {false, true}) {
    auto plan = random_plan(whole, rng, is_backwards);
    if (plan && plan->steps.size() >= 8) {
      scale_strengths(*plan, kRatios[rng.below(kRatios.size())], rng);
      expect_same_with_bounds(*plan, counts);
    }
  }
}

TEST(CertifiedRun, is_judged_as_without_bounds_by_cubes_on_a_floor) {
  Counts counts;
  for (std::uint64_t seed = 0; seed < holdfast::test::campaign(120U); ++seed) {
    model::RobotSpec whole = holdfast::test::random_robot(seed, 14, 40);
    whole.existing.insert(whole.existing.end(), whole.planned.begin(), whole.planned.end());
    whole.planned.clear();
    try_robot(whole, seed, counts);
  }
  EXPECT_GE(counts.runs, holdfast::test::least(200));
  EXPECT_GE(counts.certified, holdfast::test::least(500));
  EXPECT_GE(counts.unsafe, holdfast::test::least(60));
}

/// A robot at random: beside obstacles and with loads, on a floor, or held by a first module.
model::RobotSpec robot_of(const base::Lattice& lattice, std::uint64_t seed) {
  model::RobotSpec whole =
      seed % 3 == 0 ? holdfast::test::held_robot(lattice, seed, holdfast::test::Fixed::kFirst)
                    : holdfast::test::general_robot(lattice, seed);
  whole.existing.insert(whole.existing.end(), whole.planned.begin(), whole.planned.end());
  whole.planned.clear();
  return seed % 3 == 1 ? holdfast::test::on_a_floor(std::move(whole), seed % 2 == 0) : whole;
}

TEST(CertifiedRun, is_judged_as_without_bounds_by_robots_of_all_lattices) {
  int certified_count = 0;
  for (const base::Lattice& lattice : holdfast::test::kLattices) {
    Counts counts;
    for (std::uint64_t seed = 0; seed < holdfast::test::campaign(90U); ++seed) {
      const model::RobotSpec whole = robot_of(lattice, seed);
      if (is_robot(whole)) {
        try_robot(whole, seed, counts);
      }
    }
    EXPECT_GE(counts.runs, holdfast::test::least(50));
    certified_count += counts.certified;
    EXPECT_GE(counts.unsafe, holdfast::test::least(20));
  }
  EXPECT_GE(certified_count, holdfast::test::least(150));
}

/// A robot that is large enough to be followed, and too weak in the end.
TEST(CertifiedRun, goes_on_behind_states_that_are_not_safe) {
  const model::RobotSpec whole = holdfast::test::family_spec("growth", 320);
  base::Rng rng(7);
  Plan plan = random_plan(whole, rng, false).value();
  scale_strengths(plan, 1.05, rng);
  Counts counts;
  expect_same_with_bounds(plan, counts);
  EXPECT_GT(counts.certified, 100);
  EXPECT_EQ(counts.unsafe, 1);
}

TEST(CertifiedRun, says_the_same_with_any_number_of_threads) {
  const model::RobotSpec whole = holdfast::test::family_spec("growth", 300);
  base::Rng rng(3);
  const Plan plan = random_plan(whole, rng, false).value();
  solver::EquilibriumOptions one;
  one.thread_count = 1;
  solver::EquilibriumOptions three;
  three.thread_count = 3;
  EXPECT_EQ(
      judge_sequence(plan.start, plan.steps, {.solver = one, .solved_count_max = 0}).value().steps,
      judge_sequence(plan.start, plan.steps, {.solver = three, .solved_count_max = 0})
          .value()
          .steps);
}

}  // namespace
}  // namespace holdfast::plan
