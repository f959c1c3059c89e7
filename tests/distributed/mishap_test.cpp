// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
// Whatever goes wrong, no module shows a wrong or an old `safe`, and modules that hear each other
// soon say the same. What is true at every moment is the exact solver's verdict of the robot as it
// is then. `./dev bench distributed mishaps FROM TO` runs as many as one likes.
#include <gtest/gtest.h>

#include "mishap_campaign.hpp"

namespace holdfast::test {
namespace {

/// An optimised build runs 2,000; sanitizers, which take twenty times as long, fewer.
#ifdef NDEBUG
constexpr std::uint64_t kRunsEach = 223;
#else
constexpr std::uint64_t kRunsEach = 12;
#endif

class Mishaps : public ::testing::TestWithParam<std::size_t> {};

TEST_P(Mishaps, lead_to_no_wrong_and_to_no_old_safe) {
  const auto what = static_cast<Mishap>(GetParam());
  SCOPED_TRACE(name(what));
  MishapTally tally;
  for (std::uint64_t seed = 0; seed < kRunsEach; ++seed) {
    const int before = tally.faults();
    run_mishap(what, seed, tally);
    EXPECT_EQ(tally.faults(), before) << "mishaps " << seed * kMishapCount + GetParam();
  }
  EXPECT_EQ(tally.runs, static_cast<int>(kRunsEach));
}

/// Two modules come at once, and one finds a nearer parent than its first: it joins others anew,
/// but not the other newcomer, which has declined already and would do so once more.
TEST(Newcomers, of_two_at_once_neither_hears_a_second_join) {
  MishapTally tally;
  run_mishap(Mishap::kChanges, 45154, tally);
  EXPECT_EQ(tally.runs, 1);
  EXPECT_EQ(tally.faults(), 0);
}

/// A faulty module keeps the news of a plan to itself, and continues to hand on the old verdict:
/// those that know of the plan start a round before a link would be lost. There are two robots.
TEST(News, that_a_neighbour_swallows_leave_no_old_safe) {
  MishapTally tally;
  run_mishap(Mishap::kChangedRenewals, 9542, tally);
  run_mishap(Mishap::kChangedRenewals, 63231, tally);
  EXPECT_EQ(tally.runs, 2);
  EXPECT_EQ(tally.faults(), 0);
  EXPECT_LT(tally.longest, 1);
}

INSTANTIATE_TEST_SUITE_P(Kinds, Mishaps, ::testing::Range(std::size_t{0}, kMishapCount));

}  // namespace
}  // namespace holdfast::test
