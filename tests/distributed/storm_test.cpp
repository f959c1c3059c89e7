// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
// Deaths, cuts, restarts, plans: whatever comes together, nobody says `safe` of a robot that is
// not, and where nothing is broken in the end all say what the exact solver says. `./dev bench
// distributed storms` runs as many as one likes.
#include <gtest/gtest.h>

#include "seeds.hpp"
#include "storm_campaign.hpp"

namespace holdfast {
namespace {

TEST(Storm, leads_to_no_wrong_verdict) {
  test::StormTally tally;
  for (std::uint64_t seed = 0; seed < test::campaign(150U, 8U); ++seed) {
    const int before = tally.faults();
    test::run_storm(seed, tally);
    EXPECT_EQ(tally.faults(), before) << "storms " << seed << " " << seed + 1;
  }
  EXPECT_GE(tally.whole_runs, test::least(40, 8));
  // What is in the end would take one fresh start; what came before may be in the middle of one,
  // and a neighbour that is gone is first missed.
  EXPECT_LT(tally.latest, 3);
}

}  // namespace
}  // namespace holdfast
