// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
//
// Time steps of several modules in any order: every part of every step is a robot of its own, which
// verdict::assess judges here; and every module has to get to its cell, and touch what was there
// before, whichever part of the others has come.
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <set>

#include "family_spec.hpp"
#include "general_robot.hpp"
#include "holdfast/base/lattice.hpp"
#include "holdfast/base/rng.hpp"
#include "holdfast/plan/order.hpp"
#include "holdfast/plan/sequence.hpp"
#include "holdfast/verdict/assessment.hpp"
#include "seeds.hpp"

namespace holdfast::plan {
namespace {

using base::Cell;
using Cells = std::vector<Cell>;

constexpr std::size_t kAll = std::numeric_limits<std::size_t>::max();

Cells cells_of_parts(const model::RobotSpec& spec, const std::vector<Element>& elements) {
  Cells cells;
  for (const Element element : elements) {
    cells.push_back(spec.existing[base::at(element)]);
  }
  return cells;
}

/// What a robot of some modules of a target is.
verdict::Assessment assess_cells(const model::RobotSpec& target, const Cells& cells) {
  model::RobotSpec spec = target;
  spec.existing = cells;
  model::forget_absent(spec);
  const auto robot = model::Robot::create(spec);
  EXPECT_TRUE(robot) << robot.error().message;
  return robot ? verdict::assess(robot.value()) : verdict::Assessment{};
}

/// The parts of a batch of so many, each as bits: all of them, or some by chance.
std::vector<std::uint64_t> parts_of(std::size_t count, std::size_t part_max, std::uint64_t seed) {
  std::vector<std::uint64_t> parts;
  if (count < 20 && std::size_t{1} << count <= part_max) {
    for (std::uint64_t bits = 1; bits < std::uint64_t{1} << count; ++bits) {
      parts.push_back(bits);
    }
    return parts;
  }
  base::Rng rng(seed);
  const std::uint64_t all = count < 64 ? (std::uint64_t{1} << count) - 1 : ~std::uint64_t{0};
  while (parts.size() < part_max) {
    const std::uint64_t bits = rng.next() & all & (parts.size() % 2 == 0 ? all : rng.next());
    if (bits != 0) {
      parts.push_back(bits);
    }
  }
  return parts;
}

/// Counts of what was looked at.
struct Looked {
  int part_count = 0;
  int bound_count = 0;    ///< Steps of several modules that a bound has certified.
  int checked_count = 0;  ///< And those whose parts were checked.
};

/// Looks at every part, or so many of them, of every step.
void expect_safe_in_any_order(const OrderTask& task, const RobotOrder& result, std::size_t part_max,
                              Looked& looked) {
  const Order& order = result.order;
  const ReachFinder finder(task.target, task.rule);
  ElementSet state = order.start;
  EXPECT_TRUE(order.is_any_order);
  EXPECT_GE(order.steps.size(), result.step_count_least.value());
  for (std::size_t i = 0; i < order.steps.size(); ++i) {
    const Batch& batch = order.steps[i];
    const Judgement& judged = order.judgements[i + 1];
    ASSERT_LE(batch.size(), task.parallel_max);
    (judged.is_bound ? looked.bound_count : looked.checked_count) += batch.size() > 1 ? 1 : 0;
    for (const std::uint64_t bits : parts_of(batch.size(), part_max, i)) {
      ElementSet part = state;
      for (std::size_t k = 0; k < batch.size(); ++k) {
        if ((bits >> k & 1U) != 0) {
          part.insert(batch[k]);
        }
      }
      const verdict::Assessment found =
          assess_cells(task.target, cells_of_parts(task.target, part.elements()));
      ++looked.part_count;
      ASSERT_EQ(found.verdict, verdict::Verdict::kSafe) << "step " << i << ", part " << bits;
      if (found.load_ratio_max) {
        // Multigrid's load ratios are within 1e-4.
        EXPECT_LE(*found.load_ratio_max, judged.load_ratio_high.value_or(0) + 1e-4) << i;
      }
      if (found.simplified.margin_mm && judged.margin_mm) {
        EXPECT_GE(*found.simplified.margin_mm, *judged.margin_mm - 1e-9) << i;
      }
      for (std::size_t k = 0; k < batch.size(); ++k) {
        if (!part.contains(batch[k])) {
          EXPECT_TRUE(finder.can_reach(part, task.target.existing[base::at(batch[k])]))
              << "step " << i << ", part " << bits << ", module " << k;
        }
      }
    }
    state = changed(std::move(state), Sense::kGrowing, batch);
  }
  EXPECT_EQ(state.size(), task.target.existing.size());
}

/// The robot with strengths by which its largest load is this share of what it bears.
model::RobotSpec loaded_to(model::RobotSpec spec, double share) {
  const auto whole = verdict::assess(model::Robot::create(spec).value());
  const double ratio = whole.load_ratio_max.value_or(0);
  return ratio > 1e-3 ? test::with_strengths_times(std::move(spec), ratio / share) : spec;
}

TEST(TimeSteps, of_small_robots_are_safe_whichever_part_has_come) {
  // Robots of all lattices on a floor, with payloads, masses and fixed modules, and held by
  // obstacles anywhere, such that most are near their limits.
  Looked looked;
  int found_count = 0;
  int several_count = 0;
  for (std::uint64_t seed = 0; seed < holdfast::test::campaign(400U); ++seed) {
    const base::Lattice& lattice = test::kLattices[seed % 4];
    model::RobotSpec spec = test::general_robot(lattice, seed);
    if (seed % 3 != 0) {
      spec = test::on_a_floor(std::move(spec), seed % 3 == 1);
    }
    if (!model::Robot::create(spec) || spec.existing.size() > 16) {
      continue;
    }
    OrderTask task{.target = loaded_to(std::move(spec), 0.6 + 0.1 * static_cast<double>(seed % 5)),
                   .parallel_max = seed % 2 == 0 ? kAll : 2 + seed % 3};
    if (seed % 5 == 1) {
      task.rule.reach = Reach::kLine;
    }
    OrderTask single = task;
    single.parallel_max = 1;
    const RobotOrderOptions options{.state_count_max = 3000};
    const auto one_by_one = find_robot_order(single, options);
    const auto result = find_robot_order(task, options);
    ASSERT_EQ(static_cast<bool>(result), static_cast<bool>(one_by_one)) << seed;
    if (!result) {
      continue;
    }
    ASSERT_EQ(result.value().order.outcome, one_by_one.value().order.outcome) << seed;
    if (result.value().order.outcome == OrderOutcome::kFound) {
      SCOPED_TRACE(seed);
      ++found_count;
      expect_safe_in_any_order(task, result.value(), 1024, looked);
      several_count += std::ranges::any_of(result.value().order.steps,
                                           [](const Batch& batch) { return batch.size() > 1; });
    }
  }
  EXPECT_GE(found_count, holdfast::test::least(80));
  EXPECT_GE(several_count, holdfast::test::least(60));
  EXPECT_GE(looked.bound_count, holdfast::test::least(25));
  EXPECT_GE(looked.checked_count, holdfast::test::least(10));
}

TEST(TimeSteps, of_large_batches_are_safe_whichever_part_has_come) {
  Looked looked;
  for (const auto& [family, size] :
       std::vector<std::pair<const char*, std::size_t>>{{"growth", 60},
                                                        {"growth", 300},
                                                        {"cube", 5},
                                                        {"tower", 20},
                                                        {"ball", 6},
                                                        {"scaffold", 9},
                                                        {"prism-wall", 6},
                                                        {"sheet", 8},
                                                        {"arch", 9},
                                                        {"bridge", 8}}) {
    for (const double share : {0.1, 0.7, 0.9}) {
      if (holdfast::test::kIsShort && share != 0.7) {
        continue;
      }
      OrderTask task{.target = loaded_to(test::family_spec(family, size), share),
                     .parallel_max = share < 0.5 ? kAll : 12};
      const auto result = find_robot_order(task, {.state_count_max = 4000});
      ASSERT_TRUE(result) << result.error().message;
      if (result.value().order.outcome == OrderOutcome::kFound) {
        SCOPED_TRACE(family);
        expect_safe_in_any_order(task, result.value(), 12, looked);
      }
    }
  }
  EXPECT_GE(looked.bound_count, holdfast::test::least(100));
}

TEST(TimeSteps, get_along_the_surface_whichever_part_has_come) {
  Looked looked;
  int found_count = 0;
  for (std::uint64_t seed = 0; seed < holdfast::test::campaign(60U); ++seed) {
    base::Rng rng(seed);
    std::set<Cell> cells = {{0, 0, 0}};
    while (cells.size() < 6 + seed % 8) {
      auto from = cells.begin();
      std::advance(from, static_cast<std::ptrdiff_t>(rng.below(cells.size())));
      const Cell next = base::neighbour(*from, base::kDirections[rng.below(6)]);
      if (next.z >= 0) {
        cells.insert(next);
      }
    }
    OrderTask task{.target = {.existing = {cells.begin(), cells.end()}}, .parallel_max = kAll};
    const Cell first = *cells.begin();
    task.rule = {.reach = Reach::kSurface, .source = Cell{first.x - 1, first.y, first.z}};
    const auto result = find_robot_order(task, {.state_count_max = 3000});
    if (result && result.value().order.outcome == OrderOutcome::kFound) {
      SCOPED_TRACE(seed);
      ++found_count;
      expect_safe_in_any_order(task, result.value(), 1024, looked);
    }
  }
  EXPECT_GE(found_count, holdfast::test::least(15));
  EXPECT_GE(looked.bound_count + looked.checked_count, holdfast::test::least(20));
}

TEST(TimeSteps, are_few_where_nothing_is_in_the_way) {
  // The measure of list scheduling: max(critical path, work / machines).
  const std::vector<std::pair<const char*, std::size_t>> families = {{"tower", 60}, {"cube", 10}};
  for (const auto& [family, size] : families) {
    if (holdfast::test::kIsShort && size < 60) {
      continue;
    }
    const OrderTask task{.target = test::family_spec(family, size), .parallel_max = 20};
    const auto result = find_robot_order(task).value();
    EXPECT_LE(result.order.steps.size(), result.step_count_least.value() * 13 / 10) << family;
  }
  // A column has one way: module after module.
  const OrderTask column{.target = {.existing = {{0, 0, 0}, {0, 0, 1}, {0, 0, 2}, {0, 0, 3}}},
                         .parallel_max = kAll};
  const auto result = find_robot_order(column).value();
  EXPECT_EQ(result.order.steps.size(), 3U);
  EXPECT_EQ(result.step_count_least, 3U);
}

TEST(TimeSteps, do_not_depend_on_the_number_of_threads) {
  const OrderTask task{.target = test::family_spec("growth", 120), .parallel_max = 10};
  const auto one = find_robot_order(task, {.thread_count = 1}).value();
  const auto four = find_robot_order(task, {.thread_count = 4}).value();
  EXPECT_EQ(one.order.steps, four.order.steps);
  EXPECT_EQ(one.order.judgements, four.order.judgements);
}

TEST(TimeSteps, come_one_by_one_once_time_is_over) {
  const OrderTask task{.target = test::family_spec("cube", 5), .parallel_max = kAll};
  int asked = 0;
  const auto result =
      find_robot_order(task, {.is_interrupted = [&] { return ++asked > 4000; }, .thread_count = 1})
          .value();
  if (result.order.outcome == OrderOutcome::kFound) {
    Looked looked;
    expect_safe_in_any_order(task, result, 64, looked);
  }
}

TEST(TimeSteps, are_not_mixed_with_groups) {
  const OrderTask task{.target = test::family_spec("cube", 2), .group_size = 2, .parallel_max = 2};
  EXPECT_FALSE(find_robot_order(task));
}

/// A foot with a beam to +x of `length`, and a step that attaches one more module at each of two
/// cells.
model::RobotSpec arm(std::int32_t length) {
  model::RobotSpec spec{.existing = {{0, 0, 0}}};
  for (std::int32_t x = 0; x <= length; ++x) {
    spec.existing.push_back({x, 0, 1});
  }
  return spec;
}

TEST(StepsInAnyOrder, are_judged_by_their_worst_part) {
  // Four modules, whose centre of mass is 3 * 40 / 4 = 30 mm beside the foot's middle, topple over
  // its edge at 20 mm; with a counterweight they do not.
  model::Step step{.attach = {{2, 0, 1}, {-1, 0, 1}}};
  const auto together = judge_sequence(arm(1), std::vector{step}).value();
  EXPECT_EQ(together.verdict(), verdict::Verdict::kSafe);
  step.is_any_order = true;
  const auto apart = judge_sequence(arm(1), std::vector{step}).value();
  EXPECT_EQ(apart.verdict(), verdict::Verdict::kUnstable);
  EXPECT_NEAR(apart.margin_min_mm.value(), -10, 1e-9);
  const StageJudgement& connect = apart.steps.front().stages[2];
  ASSERT_EQ(connect.reasons.back().reason.code, verdict::ReasonCode::kPartHasCome);
  EXPECT_EQ(connect.reasons.back().cells, Cells({{2, 0, 1}}));
  // Taken apart the same parts are left: it is the counterweight that must not go first.
  model::RobotSpec whole = arm(2);
  whole.existing.push_back({-1, 0, 1});
  const model::Step back{.detach = step.attach, .is_any_order = true};
  const auto taken = judge_sequence(whole, std::vector{back}).value();
  EXPECT_EQ(taken.verdict(), verdict::Verdict::kUnstable);
  EXPECT_NEAR(taken.margin_min_mm.value(), -10, 1e-9);
}

TEST(StepsInAnyOrder, have_modules_that_each_can_come_first) {
  const model::Step step{.attach = {{1, 0, 0}, {2, 0, 1}, {2, 0, 0}}, .is_any_order = true};
  EXPECT_TRUE(judge_sequence({.existing = {{0, 0, 0}}},
                             std::vector{model::Step{.attach = {{1, 0, 0}, {2, 0, 0}}}}));
  const auto judged = judge_sequence({.existing = {{0, 0, 0}, {0, 0, 1}}}, std::vector{step});
  ASSERT_FALSE(judged);
  EXPECT_NE(judged.error().message.find("in any order"), std::string::npos)
      << judged.error().message;
}

TEST(StepsInAnyOrder, are_judged_as_all_their_parts) {
  // Random steps, safe and unsafe: the verdict is that of the worst part.
  int unsafe_count = 0;
  for (std::uint64_t seed = 0; seed < holdfast::test::campaign(200U); ++seed) {
    model::RobotSpec spec =
        test::on_a_floor(test::general_robot(test::kLattices[seed % 4], seed), seed % 3 == 1);
    if (spec.existing.size() < 4 || !model::Robot::create(spec)) {
      continue;
    }
    spec =
        loaded_to(std::move(spec), seed % 2 == 0 ? 0.2 : 0.9 + 0.1 * static_cast<double>(seed % 3));
    // The modules that can each be taken away are a step.
    model::Step step{.is_any_order = true};
    for (const Cell& cell : Cells(spec.existing.begin() + 1, spec.existing.end())) {
      model::RobotSpec rest = spec;
      std::erase(rest.existing, cell);
      std::erase_if(rest.existing,
                    [&](const Cell& other) { return std::ranges::count(step.attach, other) > 0; });
      model::forget_absent(rest);
      if (step.attach.size() < 5 && model::Robot::create(rest) &&
          std::ranges::count(spec.fixed, cell) == 0) {
        step.attach.push_back(cell);
      }
    }
    std::swap(step.attach, step.detach);
    const auto judged = judge_sequence(spec, std::vector{step});
    if (!judged || step.detach.size() < 2) {
      continue;  // Parts may be in pieces that nothing holds.
    }
    auto worst = verdict::Verdict::kSafe;
    for (std::uint64_t bits = 1; bits < std::uint64_t{1} << step.detach.size(); ++bits) {
      Cells cells = spec.existing;
      for (std::size_t k = 0; k < step.detach.size(); ++k) {
        if ((bits >> k & 1U) != 0) {
          std::erase(cells, step.detach[k]);
        }
      }
      model::RobotSpec part = spec;
      part.existing = cells;
      model::forget_absent(part);
      const auto robot = model::Robot::create(part);
      if (robot) {
        const auto found = verdict::assess(robot.value()).verdict;
        worst = verdict::severity(found) > verdict::severity(worst) ? found : worst;
      } else {
        worst = verdict::Verdict::kUndecided;  // In pieces: not compared.
        break;
      }
    }
    if (worst != verdict::Verdict::kUndecided) {
      EXPECT_EQ(judged.value().steps.front().stages[1].verdict, worst) << seed;
      unsafe_count += worst != verdict::Verdict::kSafe;
    }
  }
  EXPECT_GE(unsafe_count, holdfast::test::least(20));
}

TEST(StepsInAnyOrder, of_an_order_are_as_safe_as_it_says) {
  for (const auto& [family, size] :
       std::vector<std::pair<const char*, std::size_t>>{{"growth", 60}, {"ball", 6}}) {
    const OrderTask task{.target = test::family_spec(family, size), .parallel_max = kAll};
    const Order order = find_robot_order(task).value().order;
    model::RobotSpec start = task.target;
    start.existing = cells_of_parts(task.target, order.start.elements());
    std::vector<model::Step> steps;
    for (const Batch& batch : order.steps) {
      steps.push_back({.attach = cells_of_parts(task.target, batch), .is_any_order = true});
    }
    const auto judged = judge_sequence(start, steps).value();
    EXPECT_EQ(judged.verdict(), verdict::Verdict::kSafe);
    int bound_count = 0;
    for (std::size_t i = 0; i < steps.size(); ++i) {
      const StageJudgement& connect = judged.steps[i].stages[2];
      EXPECT_EQ(connect.is_bound, order.judgements[i + 1].is_bound) << i;
      EXPECT_NEAR(connect.load_ratio_max.value_or(0),
                  order.judgements[i + 1].load_ratio_max.value_or(0), 1e-6)
          << i;
      bound_count += connect.is_bound ? 1 : 0;
    }
    EXPECT_GE(2 * bound_count, static_cast<int>(steps.size()));
  }
}

TEST(StepsInAnyOrder, of_too_many_parts_are_undecided) {
  // The elastic modulus is stated, so that no bound serves: nine modules have 510 parts.
  model::RobotSpec spec{.existing = {{0, 0, 0}}};
  spec.is_modulus_stated = true;
  for (std::int32_t x = 1; x < 9; ++x) {
    spec.existing.push_back({x, 0, 0});
  }
  model::Step step{.is_any_order = true};
  for (std::int32_t x = 0; x < 9; ++x) {
    step.attach.push_back({x, 1, 0});
  }
  const auto judged = judge_sequence(spec, std::vector{step}).value();
  EXPECT_EQ(judged.verdict(), verdict::Verdict::kUndecided);
  EXPECT_EQ(judged.steps.front().stages[2].reasons.front().reason.code,
            verdict::ReasonCode::kPartsNotKnown);
  step.attach.pop_back();
  EXPECT_EQ(judge_sequence(spec, std::vector{step}).value().verdict(), verdict::Verdict::kSafe);
}

}  // namespace
}  // namespace holdfast::plan
