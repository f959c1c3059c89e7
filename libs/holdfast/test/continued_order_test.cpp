// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
//
// A plan that is gone on with, from a step or from a robot that differs from what the plan says:
// the new plan is judged here by the code of holdfast steps, its last steps are the old plan's, and
// there is one just where an order from that robot exists.
#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "holdfast/base/lattice.hpp"
#include "holdfast/base/rng.hpp"
#include "holdfast/order.hpp"
#include "holdfast/steps.hpp"
#include "seeds.hpp"

namespace holdfast {
namespace {

using base::Cell;
using CellSet = std::set<Cell>;

constexpr std::array<base::Lattice, 4> kFourLattices = {base::kCubic, base::kFaceCentred,
                                                        base::kHexagonal, base::kHexagonalPrism};

io::Document document_of(const io::Document& like, const CellSet& cells) {
  io::Document document = like;
  document.modules.clear();
  document.extension.plan.clear();
  for (const Cell& cell : cells) {
    document.modules.push_back({.cell = cell, .is_fixed = false, .color = {}, .attributes = {}});
  }
  return document;
}

CellSet cells_of_document(const io::Document& document) {
  CellSet cells;
  for (const io::ModuleEntry& module : document.modules) {
    cells.insert(module.cell);
  }
  return cells;
}

/// Modules on a floor that grew at random.
io::Document random_document(std::uint64_t seed) {
  base::Rng rng(seed);
  const base::Lattice& lattice = kFourLattices[seed % 4];
  CellSet cells = {{0, 0, 0}};
  while (cells.size() < 6 + seed % 9) {
    auto from = cells.begin();
    std::advance(from, static_cast<std::ptrdiff_t>(rng.below(cells.size())));
    std::vector<Cell> beside;
    for (const base::Direction side : base::directions(lattice)) {
      beside.push_back(base::neighbour(lattice, *from, side));
    }
    const Cell next = beside[rng.below(beside.size())];
    if (next.z >= 0) {
      cells.insert(next);
    }
  }
  io::Document like;
  like.extension.lattice = lattice;
  return document_of(like, cells);
}

/// Does the steps of a plan, safe by the code of holdfast steps, and says what is there then.
CellSet replayed(const io::Document& plan) {
  CellSet cells = cells_of_document(plan);
  const auto judged = judge_steps({.name = "", .document = plan, .warnings = {}});
  EXPECT_TRUE(judged) << judged.error().message;
  if (judged) {
    EXPECT_EQ(judged.value().judgement.verdict(), verdict::Verdict::kSafe);
  }
  for (const model::Step& step : plan.extension.plan) {
    cells.insert(step.attach.begin(), step.attach.end());
    for (const Cell& cell : step.detach) {
      EXPECT_EQ(cells.erase(cell), 1U);
    }
  }
  return cells;
}

io::Document plan_of(const io::OrderReport& report) {
  auto steps = io::order_steps(report.target, report.result.order, report.is_reversed);
  EXPECT_TRUE(steps);
  return steps ? std::move(steps).value() : io::Document();
}

bool is_found(const base::Result<io::OrderReport>& report) {
  return report && report.value().result.order.outcome == plan::OrderOutcome::kFound;
}

/// The last `count` steps of a plan, without what they have done already.
std::vector<CellSet> last_steps(const io::Document& plan, std::size_t count, const CellSet& done) {
  std::vector<CellSet> last;
  for (const model::Step& step : plan.extension.plan) {
    CellSet cells;
    for (const auto& list : {step.attach, step.detach}) {
      std::ranges::copy_if(list, std::inserter(cells, cells.end()),
                           [&](const Cell& cell) { return !done.contains(cell); });
    }
    if (!cells.empty()) {
      last.push_back(std::move(cells));
    }
  }
  last.erase(last.begin(), last.end() - static_cast<std::ptrdiff_t>(std::min(count, last.size())));
  return last;
}

OrderRequest request_of(std::uint64_t seed, bool is_reversed) {
  OrderRequest request{.is_reversed = is_reversed, .thread_count = 1};
  request.parallel_max = 1 + seed / 16 % 3;
  if (seed % 5 == 0) {
    request.rule.reach = plan::Reach::kLine;
  }
  return request;
}

TEST(ContinuedOrder, at_a_step_keeps_all_that_are_left) {
  int found_count = 0;
  for (std::uint64_t seed = 0; seed < holdfast::test::campaign(160U); ++seed) {
    SCOPED_TRACE(seed);
    const bool is_reversed = seed / 8 % 2 == 1;
    const io::Document target = random_document(seed);
    const OrderRequest request = request_of(seed, is_reversed);
    const auto first = seek_order(target, request);
    if (!is_found(first)) {
      continue;
    }
    ++found_count;
    const io::Document plan = plan_of(first.value());
    const std::size_t count = plan.extension.plan.size();
    const std::size_t done = seed % (count + 1);
    const auto report = continue_order(target, plan, done, request);
    ASSERT_TRUE(is_found(report)) << (report ? "" : report.error().message);
    EXPECT_EQ(report.value().kept_count, count - done);
    const io::Document rest = plan_of(report.value());
    EXPECT_EQ(replayed(rest), replayed(plan));
    EXPECT_EQ(rest.extension.plan, std::vector<model::Step>(plan.extension.plan.begin() +
                                                                static_cast<std::ptrdiff_t>(done),
                                                            plan.extension.plan.end()));
    const auto beyond = continue_order(target, plan, count + 1, request);
    ASSERT_FALSE(beyond);
    EXPECT_EQ(beyond.error().where, kAtPlan);
  }
  EXPECT_GE(found_count, holdfast::test::least(60));
}

TEST(ContinuedOrder, of_a_robot_as_it_is_exists_just_where_an_order_does) {
  int found_count = 0;
  int partly_count = 0;
  for (std::uint64_t seed = 0; seed < holdfast::test::campaign(400U); ++seed) {
    SCOPED_TRACE(seed);
    const bool is_reversed = seed / 8 % 2 == 1;
    const io::Document target = random_document(seed);
    OrderRequest request = request_of(seed, is_reversed);
    const auto first = seek_order(target, request);
    if (!is_found(first)) {
      continue;
    }
    const io::Document plan = plan_of(first.value());
    const CellSet whole = cells_of_document(target);
    base::Rng rng(seed + 1000);
    CellSet now;
    for (const Cell& cell : whole) {
      if (rng.below(4) != 0) {
        now.insert(cell);
      }
    }
    const io::Document state = document_of(target, now);
    const auto report = continue_order(state, plan, std::nullopt, request);
    const CellSet end = is_reversed ? replayed(plan) : whole;
    if (is_reversed && !std::ranges::includes(now, end)) {
      ASSERT_FALSE(report);
      EXPECT_EQ(report.error().where, kAtPlan);
      continue;
    }
    const CellSet& least = is_reversed ? end : now;
    request.start = {least.begin(), least.end()};
    const auto plain = seek_order(is_reversed ? state : target, request);
    ASSERT_EQ(static_cast<bool>(report), static_cast<bool>(plain))
        << (report ? plain : report).error().message;
    if (!report) {
      continue;
    }
    ASSERT_EQ(report.value().result.order.outcome, plain.value().result.order.outcome);
    if (!is_found(report)) {
      continue;
    }
    ++found_count;
    const io::Document rest = plan_of(report.value());
    EXPECT_EQ(cells_of_document(rest), now);
    EXPECT_EQ(replayed(rest), end);
    CellSet done;
    std::ranges::set_symmetric_difference(is_reversed ? now : CellSet{}, is_reversed ? whole : now,
                                          std::inserter(done, done.end()));
    const std::size_t kept = report.value().kept_count.value_or(0);
    const auto of_rest = last_steps(rest, kept, {});
    EXPECT_EQ(of_rest, last_steps(plan, kept, done));
    partly_count += kept > 0 && kept < rest.extension.plan.size();
  }
  EXPECT_GE(found_count, holdfast::test::least(60));
  EXPECT_GE(partly_count, holdfast::test::least(5));
}

}  // namespace
}  // namespace holdfast
