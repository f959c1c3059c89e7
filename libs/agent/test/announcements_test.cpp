// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
//
// What a module keeps of what it was told. The rules are those of announcements.hpp: what a module
// itself was told last holds; between modules a plan that the robot knows is older than a
// withdrawal.
#include "holdfast/agent/groups/announcements.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace holdfast::agent {
namespace {

using base::Cell;

constexpr Cell kA = {1, 2, 3};
constexpr Cell kB = {-4, 5, 6};

/// What is held of a cell.
Told told(const Announcements& list, const Cell& cell) {
  Told found = Told::kNothing;
  for (int i = 0; i < list.count(); ++i) {
    if (list.cell(i) == cell) {
      EXPECT_EQ(found, Told::kNothing) << "held twice";
      found = list.told(i);
    }
  }
  return found;
}

TEST(Announcements, told_six_times_is_told_once) {
  Announcements list;
  for (int i = 0; i < 6; ++i) {
    list.plan(kA);
  }
  EXPECT_EQ(list.count(), 1);
  EXPECT_EQ(list.plan_count(), 1);
  EXPECT_FALSE(list.is_overfull());
}

TEST(Announcements, a_plan_is_forgotten_when_fulfilled_whenever_it_came) {
  for (const bool is_known : {false, true}) {
    Announcements list;
    list.plan(kA);
    list.plan(kB);
    if (is_known) {
      list.settle();
    }
    list.forget(kA, true);
    EXPECT_EQ(told(list, kA), Told::kNothing);
    EXPECT_EQ(told(list, kB), is_known ? Told::kKnownPlan : Told::kPlan);
  }
}

TEST(Announcements, a_known_plan_is_older_than_a_withdrawal_elsewhere) {
  Announcements list;
  list.plan(kA);
  list.settle();
  list.forget(kA, false);
  EXPECT_EQ(list, Announcements());
}

TEST(Announcements, a_plan_that_may_be_younger_than_its_withdrawal_is_disputed) {
  Announcements list;
  list.plan(kA);
  list.forget(kA, false);
  EXPECT_EQ(told(list, kA), Told::kDisputedPlan);
  // The round is given up, and the same withdrawal comes again: it settles nothing.
  list.begin_anew();
  list.forget(kA, false);
  EXPECT_EQ(told(list, kA), Told::kDisputedPlan);
  list.settle();
  EXPECT_EQ(told(list, kA), Told::kKnownDispute);
  Announcements again = list;
  again.plan(kA);
  EXPECT_EQ(told(again, kA), Told::kPlan);
  Announcements withdrawn = list;
  withdrawn.forget(kA, false);
  EXPECT_EQ(withdrawn, Announcements());
  list.forget(kA, true);
  EXPECT_EQ(list, Announcements());
}

TEST(Announcements, what_one_module_was_told_last_holds) {
  Announcements list;
  list.plan(kA);
  list.withdraw(kA);
  EXPECT_EQ(told(list, kA), Told::kWithdrawal);
  EXPECT_EQ(list.plan_count(), 0);
  list.plan(kA);
  EXPECT_EQ(told(list, kA), Told::kPlan);
  list.withdraw(kA);
  list.forget(kA, false);
  list.finish_forgetting();
  EXPECT_EQ(list, Announcements());
}

/// The order may not have reached those that hold the plan.
TEST(Announcements, a_withdrawal_is_kept_until_all_have_forgotten_the_plan) {
  Announcements list;
  list.withdraw(kA);
  list.withdraw(kB);
  list.forget(kA, false);
  EXPECT_EQ(told(list, kA), Told::kCarriedWithdrawal);
  list.begin_anew();
  EXPECT_EQ(told(list, kA), Told::kWithdrawal);
  list.forget(kA, false);
  list.finish_forgetting();
  EXPECT_EQ(told(list, kA), Told::kNothing);
  EXPECT_EQ(told(list, kB), Told::kWithdrawal);
}

TEST(Announcements, one_too_many_stays_lost_until_all_are_withdrawn) {
  Announcements list;
  for (int i = 0; i < kAnnouncedMax; ++i) {
    list.plan({i, 0, 0});
  }
  EXPECT_FALSE(list.is_overfull());
  list.plan({0, 0, 0});
  EXPECT_FALSE(list.is_overfull());
  list.plan(kA);
  EXPECT_TRUE(list.is_overfull());
  EXPECT_EQ(list.plan_count(), kAnnouncedMax + 1);
  list.settle();
  for (int i = 0; i < kAnnouncedMax; ++i) {
    list.forget({i, 0, 0}, i % 2 == 0);
  }
  EXPECT_EQ(list.count(), 1);
  EXPECT_TRUE(list.is_overfull());
  // Lost is not only what was planned: a withdrawal that finds no place counts the same.
  Announcements elsewhere = list;
  elsewhere.forget(kEveryCell, false);
  EXPECT_EQ(elsewhere, Announcements());
  list.withdraw(kEveryCell);
  EXPECT_FALSE(list.is_overfull());
  EXPECT_EQ(told(list, kEveryCell), Told::kWithdrawal);
  list.forget(kEveryCell, false);
  list.finish_forgetting();
  EXPECT_EQ(list, Announcements());
}

/// The bytes of the cell would be refused, or name another cell.
TEST(Announcements, a_plan_outside_the_lattice_is_lost) {
  constexpr std::int32_t kFar = base::kCoordinateMax + 1;
  for (const Cell cell : {Cell{kFar, 0, 0}, Cell{0, -kFar - 1, 0}, Cell{0, 0, 1 << 30}}) {
    Announcements list;
    list.withdraw(cell);
    EXPECT_EQ(list, Announcements());
    list.plan(cell);
    EXPECT_TRUE(list.is_overfull());
    EXPECT_EQ(told(list, cell), Told::kNothing);
  }
  Announcements list;
  list.plan({kFar - 1, 1 - kFar, 0});
  EXPECT_FALSE(list.is_overfull());
}

TEST(Announcements, a_withdrawal_of_all_spares_what_may_be_younger) {
  Announcements list;
  list.plan(kA);
  list.settle();
  list.plan(kB);
  list.withdraw({7, 7, 7});
  list.forget(kEveryCell, false);
  list.finish_forgetting();
  EXPECT_EQ(list.count(), 1);
  EXPECT_EQ(told(list, kB), Told::kDisputedPlan);
  for (int i = 0; i < kAnnouncedMax; ++i) {
    list.plan({i, 0, 0});
  }
  ASSERT_TRUE(list.is_overfull());
  list.forget(kEveryCell, false);
  EXPECT_TRUE(list.is_overfull());
}

/// What count(), cell() and told() give is all there is to know.
TEST(Announcements, are_the_same_after_they_were_recalled) {
  Announcements list;
  list.plan(kA);
  list.settle();
  list.plan(kB);
  list.forget(kB, false);
  list.withdraw({0, 0, 9});
  for (int i = 0; i < 3; ++i) {
    list.plan({i, 0, 0});
  }
  ASSERT_TRUE(list.is_overfull());
  Announcements copy;
  for (int i = 0; i < list.count(); ++i) {
    copy.recall(list.cell(i), list.told(i));
  }
  EXPECT_EQ(copy, list);
}

}  // namespace
}  // namespace holdfast::agent
