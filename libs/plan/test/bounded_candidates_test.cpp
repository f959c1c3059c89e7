// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
//
// Candidates that bounds judge first are judged as they are without: the same robots, verdicts and
// margins, no load ratio above its bound; the best ones are the same; and what time leaves open is
// said to be open. Random robots of all lattices, some at the limit of their strength, and robots
// that are large enough to be followed.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <set>
#include <tuple>

#include "family_spec.hpp"
#include "general_robot.hpp"
#include "holdfast/base/rng.hpp"
#include "holdfast/plan/candidates.hpp"
#include "random_robot.hpp"
#include "seeds.hpp"

namespace holdfast::plan {
namespace {

/// The load ratios of checks of large robots, by multigrid, are good for this.
constexpr double kMultigrid = 1e-4;

struct Tally {
  std::size_t count = 0;
  std::size_t bounded = 0;
  std::size_t not_safe = 0;
  std::size_t broken = 0;  ///< By a bound.
};

void expect_same(const Candidate& bounded, const Candidate& full) {
  EXPECT_FALSE(bounded.is_open);
  ASSERT_EQ(bounded.is_robot, full.is_robot);
  const Judgement& a = bounded.judgement;
  const Judgement& b = full.judgement;
  EXPECT_EQ(a.verdict, b.verdict);
  EXPECT_NEAR(a.margin_mm.value_or(0), b.margin_mm.value_or(0), 1e-6);
  if (a.is_bound && !a.is_safe()) {
    EXPECT_EQ(a.verdict, verdict::Verdict::kOverload);
    EXPECT_GT(b.load_ratio_max.value_or(0), 1);
  } else if (a.is_bound) {
    EXPECT_LE(b.load_ratio_max.value_or(0), *a.load_ratio_max + kMultigrid);
  } else {
    ASSERT_EQ(a.load_ratio_max.has_value(), b.load_ratio_max.has_value());
    EXPECT_NEAR(a.load_ratio_max.value_or(0), b.load_ratio_max.value_or(0),
                kMultigrid * std::max(1.0, std::abs(b.load_ratio_max.value_or(0))));
  }
}

/// The safe candidates, best first.
std::vector<Candidate> best_of(std::vector<Candidate> candidates) {
  sort_candidates(candidates);
  std::erase_if(candidates, [](const Candidate& each) { return !each.judgement.is_safe(); });
  return candidates;
}

/// The best few, if only their load ratios are asked for, are the first few of all.
void expect_same_best(const model::RobotSpec& spec, const std::vector<Candidate>& all,
                      CandidateOptions options) {
  options.is_exact = true;
  options.best_count = 3;
  const auto wanted = best_of(all);
  const auto found = best_of(judge_candidates(spec, free_cells(spec), options).candidates);
  ASSERT_GE(found.size(), std::min<std::size_t>(3, wanted.size()));
  for (std::size_t i = 0; i < std::min<std::size_t>(3, wanted.size()); ++i) {
    EXPECT_FALSE(found[i].judgement.is_bound);
    EXPECT_NEAR(found[i].judgement.load_ratio_max.value_or(0),
                wanted[i].judgement.load_ratio_max.value_or(0), kMultigrid);
  }
}

/// Nothing wrong is said in no time at all.
void expect_open_in_no_time(const model::RobotSpec& spec, const std::vector<Candidate>& all,
                            CandidateOptions options) {
  options.seconds_max = 0;
  const auto found = judge_candidates(spec, free_cells(spec), options).candidates;
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (!found[i].is_open) {
      EXPECT_EQ(found[i].is_robot, all[i].is_robot);
      EXPECT_EQ(found[i].judgement.verdict, all[i].judgement.verdict);
    }
  }
}

Tally compare(const model::RobotSpec& spec, CandidateOptions options = {}) {
  const std::vector<base::Cell> cells = free_cells(spec);
  const auto full = judge_candidates(spec, cells, options).candidates;
  options.solved_count_max = 0;
  const auto bounded = judge_candidates(spec, cells, options).candidates;
  Tally tally{.count = cells.size()};
  for (std::size_t i = 0; i < cells.size(); ++i) {
    SCOPED_TRACE(model::text(cells[i]));
    expect_same(bounded[i], full[i]);
    tally.bounded += bounded[i].is_robot && bounded[i].judgement.is_bound ? 1 : 0;
    tally.broken += bounded[i].judgement.is_bound && !bounded[i].judgement.is_safe() ? 1 : 0;
    tally.not_safe += full[i].is_robot && !full[i].judgement.is_safe() ? 1 : 0;
  }
  expect_same_best(spec, full, options);
  expect_open_in_no_time(spec, full, options);
  return tally;
}

void add(Tally& sum, const Tally& more) {
  sum.count += more.count;
  sum.bounded += more.bounded;
  sum.not_safe += more.not_safe;
  sum.broken += more.broken;
}

/// The robot with strengths so that its largest load ratio is near the limit, if it is loaded.
model::RobotSpec near_limit(model::RobotSpec spec, std::uint64_t seed) {
  constexpr std::array<double, 7> kRatios = {0.3, 0.9, 0.998, 0.9995, 1.0005, 1.002, 1.5};
  const auto robot = model::Robot::create(spec);
  const auto ratio = robot ? judge(robot.value()).load_ratio_max : std::nullopt;
  return ratio && *ratio > 1e-3 ? holdfast::test::with_strengths_times(
                                      std::move(spec), *ratio / kRatios[seed % kRatios.size()])
                                : spec;
}

TEST(BoundedCandidates, are_judged_as_without_bounds_beside_cubes_on_a_floor) {
  Tally sum;
  for (std::uint64_t seed = 0; seed < holdfast::test::campaign(80U); ++seed) {
    SCOPED_TRACE(seed);
    add(sum, compare(near_limit(holdfast::test::random_robot(seed), seed),
                     {.is_planned = seed % 2 == 0}));
  }
  EXPECT_GE(sum.bounded, holdfast::test::least(100U));
  EXPECT_GE(sum.not_safe, holdfast::test::least(300U));
  EXPECT_GE(sum.broken, holdfast::test::least(50U));
}

TEST(BoundedCandidates, are_judged_as_without_bounds_beside_robots_of_all_lattices) {
  Tally sum;
  for (const base::Lattice& lattice : holdfast::test::kLattices) {
    for (std::uint64_t seed = 0; seed < holdfast::test::campaign(60U); ++seed) {
      SCOPED_TRACE(seed);
      model::RobotSpec spec =
          seed % 3 == 0 ? holdfast::test::held_robot(lattice, seed, holdfast::test::Fixed::kFirst)
                        : holdfast::test::general_robot(lattice, seed);
      if (seed % 3 == 1) {
        spec = holdfast::test::on_a_floor(std::move(spec), seed % 2 == 0);
      }
      if (model::Robot::create(spec)) {
        add(sum, compare(near_limit(std::move(spec), seed)));
      }
    }
  }
  EXPECT_GE(sum.bounded, holdfast::test::least(150U));
  EXPECT_GE(sum.not_safe, holdfast::test::least(500U));
}

TEST(BoundedCandidates, are_judged_as_without_bounds_beside_larger_robots) {
  Tally sum;
  for (const auto& [family, size] : std::vector<std::pair<const char*, std::size_t>>{
           {"growth", 400}, {"cube", 7}, {"ball", 9}, {"tower", 30}}) {
    SCOPED_TRACE(family);
    add(sum, compare(holdfast::test::family_spec(family, size)));
  }
  EXPECT_GE(sum.bounded, sum.count / 4);
}

/// Mirror images and turned robots have the same candidates with the same bounds.
TEST(BoundedCandidates, turn_with_their_robot) {
  const model::RobotSpec spec = holdfast::test::family_spec("growth", 300);
  const auto judged = [](const model::RobotSpec& robot) {
    std::multiset<std::tuple<bool, int, bool>> all;
    for (const Candidate& each :
         judge_candidates(robot, free_cells(robot), {.solved_count_max = 0}).candidates) {
      all.emplace(each.is_robot, static_cast<int>(each.judgement.verdict), each.is_open);
    }
    return all;
  };
  for (const auto& symmetry : holdfast::test::symmetries(spec.lattice)) {
    if (symmetry.matrix[2][2] > 0.5) {
      EXPECT_EQ(judged(holdfast::test::turned(spec, symmetry)), judged(spec));
    }
  }
}

}  // namespace
}  // namespace holdfast::plan
