// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0

// A run is judged as checks of its states, each made by itself, judge them: certified states are
// safe and have no larger load ratio than is said, and the first unsafe one ends the run. Threads
// change nothing, and a way back is solved state by state.

#include "bounds/run_judge.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "bounds/energy_bound.hpp"
#include "family_spec.hpp"
#include "holdfast/plan/part_of.hpp"
#include "nearest_first.hpp"

namespace holdfast::plan {
namespace {

using verdict::Verdict;

/// A robot, an order of its modules, and the state before the last of them.
struct Growing {
  model::RobotSpec spec;
  model::Robot target;
  std::vector<Element> order;
  ElementSet begin;
};

Growing growing_of(model::RobotSpec spec, std::size_t length) {
  model::Robot target = model::Robot::create(spec).value();
  std::vector<Element> order = holdfast::test::nearest_first(target);
  ElementSet begin(order.size());
  for (std::size_t i = 0; i + length < order.size(); ++i) {
    begin.insert(order[i]);
  }
  order.erase(order.begin(), order.end() - static_cast<std::ptrdiff_t>(length));
  return {std::move(spec), std::move(target), std::move(order), std::move(begin)};
}

bool is_never_late() { return false; }

TEST(RunJudge, certifies_what_checks_find_safe_and_within_its_bound) {
  int certified_count = 0;
  for (const auto& [family, size] : std::vector<std::pair<const char*, std::size_t>>{
           {"growth", 300}, {"cube", 7}, {"tower", 40}, {"ball", 9}}) {
    const Growing run = growing_of(holdfast::test::family_spec(family, size), 40);
    RunJudge judge(run.spec, run.target, 1);
    const auto judged =
        judge.judge(run.begin, Sense::kGrowing, run.order, {.is_late = is_never_late});
    ASSERT_EQ(judged.size(), run.order.size()) << family;
    ElementSet state = run.begin;
    for (std::size_t i = 0; i < judged.size(); ++i) {
      state.insert(run.order[i]);
      const auto whole = plan::judge(model::Robot::create(part_of(run.spec, state)).value());
      EXPECT_EQ(judged[i].verdict, whole.verdict) << family << i;
      // Multigrid's load ratios are good for 1e-4.
      EXPECT_LE(*whole.load_ratio_max, *judged[i].load_ratio_high + 1e-4) << family << i;
      EXPECT_NEAR(judged[i].margin_mm.value(), whole.margin_mm.value(), 1e-6) << family << i;
      certified_count += judged[i].is_bound ? 1 : 0;
    }
  }
  EXPECT_GT(certified_count, 80);
}

TEST(RunJudge, says_the_same_with_any_number_of_threads) {
  const Growing run = growing_of(holdfast::test::family_spec("growth", 300), 60);
  RunJudge one(run.spec, run.target, 1);
  RunJudge three(run.spec, run.target, 3);
  EXPECT_EQ(one.judge(run.begin, Sense::kGrowing, run.order, {.is_late = is_never_late}),
            three.judge(run.begin, Sense::kGrowing, run.order, {.is_late = is_never_late}));
}

TEST(RunJudge, ends_at_the_first_state_that_is_not_safe) {
  // A row that grows beyond its foot: the fourth module of it topples the robot.
  model::RobotSpec spec{.existing = {{0, 0, 0}, {0, 0, 1}}};
  for (int x = 1; x < 7; ++x) {
    spec.existing.push_back({x, 0, 1});
  }
  const Growing run = growing_of(spec, 7);
  RunJudge judge(run.spec, run.target, 1);
  const auto judged =
      judge.judge(run.begin, Sense::kGrowing, run.order, {.is_late = is_never_late});
  ASSERT_FALSE(judged.empty());
  EXPECT_LT(judged.size(), run.order.size());
  EXPECT_EQ(judged.back().verdict, Verdict::kUnstable);
  EXPECT_TRUE(std::all_of(judged.begin(), judged.end() - 1,
                          [](const Judgement& state) { return state.is_safe(); }));
}

TEST(RunJudge, solves_every_state_on_a_way_back) {
  const Growing run = growing_of(holdfast::test::family_spec("cube", 5), 20);
  ElementSet whole = run.begin;
  std::vector<Element> back = run.order;
  std::ranges::for_each(back, [&](Element element) { whole.insert(element); });
  std::ranges::reverse(back);
  RunJudge judge(run.spec, run.target, 1);
  const auto judged = judge.judge(whole, Sense::kShrinking, back, {.is_late = is_never_late});
  EXPECT_EQ(judged.size(), back.size());
  EXPECT_TRUE(std::ranges::none_of(judged, &Judgement::is_bound));
}

TEST(EnergyBound, certifies_nothing_but_from_a_safe_state_that_was_solved) {
  const Growing run = growing_of(holdfast::test::family_spec("cube", 4), 8);
  const LocalAdjoints nearby(run.target);
  EnergyBound bound(run.target, nearby);
  EXPECT_FALSE(bound.add(run.order[0]));
  RunJudge judge(run.spec, run.target, 1);
  verdict::Assessment solved = judge.assess(run.begin);
  ASSERT_TRUE(bound.begin(run.begin.elements(), solved));
  EXPECT_TRUE(bound.add(run.order[0]));
  solved.verdict = Verdict::kUndecided;
  EXPECT_FALSE(bound.begin(run.begin.elements(), solved));
  EXPECT_FALSE(bound.add(run.order[0]));
}

}  // namespace
}  // namespace holdfast::plan
