// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
//
// Structures made of random tables: any element may come next, and which states are safe is drawn
// by lot. Whether there is an order is then a question of paths in the graph of all sets, answered
// beside the search by walking through all of them.
#include "holdfast/plan/order_search.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <thread>

#include "holdfast/base/rng.hpp"

namespace holdfast::plan {
namespace {

constexpr std::size_t kCount = 7;

std::size_t mask_of(const ElementSet& set) {
  return set.words().empty() ? 0 : static_cast<std::size_t>(set.words().front());
}

class RandomStructure final : public GrowingStructure {
 public:
  /// Makes so many of ten unsafe states undecided, all others overloaded.
  RandomStructure(std::uint64_t seed, std::uint64_t safe_of_ten,
                  std::uint64_t undecided_of_ten = 0) {
    base::Rng rng(seed);
    for (std::size_t mask = 0; mask < (1U << kCount); ++mask) {
      safe_.push_back(rng.below(10) < safe_of_ten);
    }
    for (std::size_t mask = 0; mask < (1U << kCount); ++mask) {
      undecided_.push_back(!safe_[mask] && rng.below(10) < undecided_of_ten);
    }
    safe_.back() = true;
  }

  std::size_t element_count() const override { return kCount; }

  std::vector<Element> candidates(const ElementSet& state, Sense sense,
                                  std::uint64_t /*seed*/) override {
    std::vector<Element> list;
    for (Element element = 0; element < static_cast<Element>(kCount); ++element) {
      if (state.contains(element) == (sense == Sense::kShrinking)) {
        list.push_back(element);
      }
    }
    return list;
  }

  Judgement judge(const ElementSet& state) override {
    const std::size_t mask = mask_of(state);
    return {.verdict = is_safe(mask)      ? verdict::Verdict::kSafe
                       : undecided_[mask] ? verdict::Verdict::kUndecided
                                          : verdict::Verdict::kOverload};
  }

  /// Takes what is undecided for safe.
  void trust() {
    for (std::size_t mask = 0; mask < (1U << kCount); ++mask) {
      safe_[mask] = safe_[mask] || undecided_[mask];
    }
  }

  bool is_safe(std::size_t mask) const { return safe_[mask]; }

 private:
  std::vector<bool> safe_;
  std::vector<bool> undecided_;
};

ElementSet set_of(std::size_t mask) {
  ElementSet set(kCount);
  for (std::size_t i = 0; i < kCount; ++i) {
    if ((mask >> i & 1U) != 0) {
      set.insert(static_cast<Element>(i));
    }
  }
  return set;
}

/// Whether safe sets, each with up to `group_size` elements more than the one before, lead from
/// {0} to all.
bool has_order(const RandomStructure& structure, std::size_t group_size) {
  std::vector<bool> reached(1U << kCount);
  reached[1] = structure.is_safe(1);
  for (std::size_t mask = 1; mask < reached.size(); ++mask) {
    for (std::size_t before = 0; before < mask; ++before) {
      const std::size_t added = mask & ~before;
      const bool is_step = (before & ~mask) == 0 &&
                           static_cast<std::size_t>(__builtin_popcountll(added)) <= group_size;
      reached[mask] = reached[mask] || (is_step && reached[before] && structure.is_safe(mask));
    }
  }
  return reached.back();
}

void expect_order(const RandomStructure& structure, const Order& order, std::size_t group_size) {
  std::size_t mask = mask_of(order.start);
  EXPECT_EQ(mask, 1U);
  for (const Batch& group : order.steps) {
    EXPECT_LE(group.size(), group_size);
    for (const Element element : group) {
      EXPECT_EQ(mask >> element & 1U, 0U);
      mask |= std::size_t{1} << element;
    }
    EXPECT_TRUE(structure.is_safe(mask));
  }
  EXPECT_EQ(mask, (1U << kCount) - 1);
  EXPECT_EQ(order.judgements.size(), order.steps.size() + 1);
}

/// Every set that a step leads to from one of the closure's is one of them, or is not safe; and one
/// end is in it and the other is not.
void expect_cut(const RandomStructure& structure, const Closure& closure, std::size_t group_size) {
  std::vector<bool> inside(1U << kCount);
  for (const ElementSet& state : closure.states) {
    inside[mask_of(state)] = true;
  }
  const bool is_growing = closure.sense == Sense::kGrowing;
  const std::size_t near = is_growing ? 1 : inside.size() - 1;
  const std::size_t far = is_growing ? inside.size() - 1 : 1;
  EXPECT_TRUE(inside[near] || !structure.is_safe(near));
  EXPECT_FALSE(inside[far]);
  for (std::size_t from = 0; from < inside.size(); ++from) {
    for (std::size_t to = 0; inside[from] && to < inside.size(); ++to) {
      const std::size_t small = is_growing ? from : to;
      const std::size_t large = is_growing ? to : from;
      const auto count = static_cast<std::size_t>(__builtin_popcountll(large & ~small));
      if ((small & ~large) == 0 && count > 0 && count <= group_size) {
        EXPECT_TRUE(inside[to] || !structure.is_safe(to));
      }
    }
  }
}

TEST(OrderSearch, proves_nothing_where_undecided_states_are_in_the_way) {
  int none_count = 0;
  int open_count = 0;
  for (std::uint64_t seed = 0; seed < 600; ++seed) {
    RandomStructure structure(seed, 1 + seed % 4, 2);
    const ElementSet start = set_of(1);
    const Order order = find_order(structure, std::span(&start, 1));
    EXPECT_EQ(order.outcome == OrderOutcome::kFound, has_order(structure, 1)) << seed;
    EXPECT_EQ(order.undecided_count > 0, order.outcome == OrderOutcome::kNotFound) << seed;
    structure.trust();
    if (order.outcome == OrderOutcome::kNone) {
      EXPECT_FALSE(has_order(structure, 1)) << seed;
      expect_cut(structure, *order.closure, 1);
      ++none_count;
    }
    open_count += order.outcome == OrderOutcome::kNotFound ? 1 : 0;
  }
  EXPECT_GT(none_count, 100);
  EXPECT_GT(open_count, 100);
}

/// How far safe sets lead, one element at a time: the largest one from {0}, or the smallest one
/// that leads to all.
std::size_t furthest_size(const RandomStructure& structure, Sense sense) {
  const bool is_growing = sense == Sense::kGrowing;
  std::vector<bool> reached(1U << kCount);
  std::size_t furthest = is_growing ? 0 : kCount;
  for (std::size_t i = 0; i < reached.size(); ++i) {
    const std::size_t mask = is_growing ? i : reached.size() - 1 - i;
    reached[mask] = mask == (is_growing ? 1 : reached.size() - 1);
    for (std::size_t bit = 1; bit < reached.size(); bit *= 2) {
      const bool has_before = ((mask & bit) != 0) == is_growing;
      reached[mask] = reached[mask] || (has_before && reached[mask ^ bit]);
    }
    reached[mask] = reached[mask] && structure.is_safe(mask);
    if (reached[mask]) {
      const auto size = static_cast<std::size_t>(__builtin_popcountll(mask));
      furthest = is_growing ? std::max(furthest, size) : std::min(furthest, size);
    }
  }
  return furthest;
}

TEST(OrderSearch, tells_how_far_safe_states_lead_where_it_finds_no_order) {
  int told_count = 0;
  for (std::uint64_t seed = 0; seed < 600; ++seed) {
    RandomStructure structure(seed, 3 + seed % 3, 8);
    const ElementSet start = set_of(1);
    for (const Sense sense : {Sense::kGrowing, Sense::kShrinking}) {
      const Order order = find_order(structure, {&start, 1}, {.told_end = sense});
      if (order.outcome != OrderOutcome::kNotFound) {
        continue;
      }
      if (order.judgements.empty()) {
        EXPECT_TRUE(sense == Sense::kGrowing && !structure.is_safe(1)) << seed;
        continue;
      }
      EXPECT_EQ(order.judgements.size(), order.steps.size() + 1);
      std::size_t mask = mask_of(order.start);
      EXPECT_TRUE(structure.is_safe(mask));
      EXPECT_TRUE(sense == Sense::kShrinking || mask == 1);
      for (const Batch& group : order.steps) {
        ASSERT_EQ(group.size(), 1U);
        EXPECT_EQ(mask >> group.front() & 1U, 0U);
        mask |= std::size_t{1} << group.front();
        EXPECT_TRUE(structure.is_safe(mask));
      }
      EXPECT_TRUE(sense == Sense::kGrowing || mask == (1U << kCount) - 1);
      const std::size_t end = sense == Sense::kGrowing ? mask : mask_of(order.start);
      EXPECT_EQ(static_cast<std::size_t>(__builtin_popcountll(end)),
                furthest_size(structure, sense))
          << seed;
      told_count += order.steps.empty() ? 0 : 1;
    }
  }
  EXPECT_GT(told_count, 100);
}

TEST(OrderSearch, finds_an_order_or_a_cut_as_a_walk_through_all_sets_says) {
  int found_count = 0;
  int none_count = 0;
  for (std::uint64_t seed = 0; seed < 300; ++seed) {
    for (std::size_t group_size = 1; group_size <= 3; ++group_size) {
      RandomStructure structure(seed, 2 + seed % 5);
      const ElementSet start = set_of(1);
      const Order order =
          find_order(structure, {&start, 1}, {.group_size = group_size, .seed = seed % 3});
      ASSERT_EQ(order.outcome == OrderOutcome::kFound, has_order(structure, group_size))
          << "seed " << seed << ", groups of " << group_size;
      if (order.outcome == OrderOutcome::kFound) {
        expect_order(structure, order, group_size);
        ++found_count;
      } else {
        ASSERT_EQ(order.outcome, OrderOutcome::kNone);
        expect_cut(structure, *order.closure, group_size);
        ++none_count;
      }
    }
  }
  EXPECT_GT(found_count, 100);
  EXPECT_GT(none_count, 100);
}

TEST(OrderSearch, says_so_when_states_run_out) {
  RandomStructure structure(1, 10);
  const ElementSet start = set_of(1);
  const Order order = find_order(structure, {&start, 1}, {.state_count_max = 2});
  EXPECT_EQ(order.outcome, OrderOutcome::kNotFound);
}

TEST(OrderSearch, has_nothing_to_do_where_the_start_is_the_whole) {
  RandomStructure structure(1, 10);
  const ElementSet start = set_of((1U << kCount) - 1);
  const Order order = find_order(structure, {&start, 1});
  EXPECT_EQ(order.outcome, OrderOutcome::kFound);
  EXPECT_TRUE(order.steps.empty());
}

/// A row, each state of which takes 10 ms to judge, in runs of 64.
class SlowRow final : public GrowingStructure {
 public:
  std::size_t element_count() const override { return 1000; }

  std::vector<Element> candidates(const ElementSet& state, Sense sense,
                                  std::uint64_t /*seed*/) override {
    const std::size_t next = sense == Sense::kGrowing ? state.size() : state.size() - 1;
    return {static_cast<Element>(next)};
  }

  Judgement judge(const ElementSet& /*state*/) override {
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
    return {.verdict = verdict::Verdict::kSafe};
  }

  std::size_t run_length_max() const override { return 64; }
};

TEST(OrderSearch, ends_within_its_time_also_in_the_middle_of_a_run) {
  SlowRow row;
  ElementSet start(row.element_count());
  start.insert(0);
  const auto begin = std::chrono::steady_clock::now();
  const Order order = find_order(row, {&start, 1}, {.seconds_max = 0.3});
  const std::chrono::duration<double> passed = std::chrono::steady_clock::now() - begin;
  EXPECT_EQ(order.outcome, OrderOutcome::kNotFound);
  // A run that has begun would take 0.64 s more on top; a busy machine oversleeps, too.
  EXPECT_LT(order.state_count, 33U);
  EXPECT_LT(passed.count(), 0.6);
}

/// Forty elements of which any may come next: there are 1.4 x 10^11 groups of up to 20.
class FreeElements final : public GrowingStructure {
 public:
  std::size_t element_count() const override { return 40; }

  std::vector<Element> candidates(const ElementSet& state, Sense sense,
                                  std::uint64_t /*seed*/) override {
    std::vector<Element> list;
    for (Element element = 0; element < static_cast<Element>(element_count()); ++element) {
      if (state.contains(element) == (sense == Sense::kShrinking)) {
        list.push_back(element);
      }
    }
    return list;
  }

  /// Nothing in between is safe.
  Judgement judge(const ElementSet& state) override {
    const bool is_end = state.size() == 0 || state.size() == element_count();
    return {.verdict = is_end ? verdict::Verdict::kSafe : verdict::Verdict::kOverload};
  }
};

TEST(OrderSearch, lists_groups_while_there_is_time) {
  FreeElements elements;
  int asked_count = 0;
  const auto is_late = [&] { return ++asked_count > 100; };
  const std::vector<Batch> groups =
      successors(elements, ElementSet(elements.element_count()), Sense::kGrowing, 20, 0, is_late);
  EXPECT_GT(groups.size(), elements.element_count());
  EXPECT_LT(groups.size(), 101 * elements.element_count());
  EXPECT_EQ(groups.front().size(), 1U);
}

/// What is missing of the list must not read as a proof.
TEST(OrderSearch, proves_nothing_by_groups_that_it_had_no_time_to_list) {
  FreeElements elements;
  const ElementSet nothing(elements.element_count());
  const Order order = find_order(elements, {&nothing, 1}, {.group_size = 20, .seconds_max = 0.05});
  EXPECT_EQ(order.outcome, OrderOutcome::kNotFound);
}

TEST(OrderSearch, that_is_interrupted_leaves_the_way_so_far) {
  SlowRow row;
  ElementSet start(row.element_count());
  start.insert(0);
  int asked = 0;
  const Order order =
      find_order(row, {&start, 1}, {.is_interrupted = [&] { return ++asked > 12; }});
  EXPECT_EQ(order.outcome, OrderOutcome::kNotFound);
  EXPECT_EQ(mask_of(order.start), 1U);
  ASSERT_FALSE(order.steps.empty());
  EXPECT_LT(order.steps.size(), 20U);
  for (std::size_t i = 0; i < order.steps.size(); ++i) {
    EXPECT_EQ(order.steps[i], Batch{static_cast<Element>(i + 1)});
    EXPECT_TRUE(order.judgements[i + 1].is_safe());
  }
}

}  // namespace
}  // namespace holdfast::plan
