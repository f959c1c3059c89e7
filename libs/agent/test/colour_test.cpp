// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
// The colours of Fig. 6 and Sec. IV-B: green to orange is safe, blinking red breaks, blue is fixed,
// the blinking purple of the centroid means that the robot topples.
#include "holdfast/agent/colour.hpp"

#include <gtest/gtest.h>

#include <limits>

namespace holdfast::agent {
namespace {

TEST(Colour, goes_from_green_by_yellow_to_orange) {
  EXPECT_EQ(colour_of(Verdict::kSafe, 0, false, false), (Colour{0, 255, 0, false}));
  EXPECT_EQ(colour_of(Verdict::kSafe, 0.5F, false, false), (Colour{255, 255, 0, false}));
  const Colour orange = colour_of(Verdict::kSafe, 0.999F, false, true);
  EXPECT_EQ(orange.red, 255);
  EXPECT_NEAR(orange.green, 128, 1);
  EXPECT_FALSE(orange.blinks);
  // Compression is as good as no load.
  EXPECT_EQ(colour_of(Verdict::kSafe, -3, false, false), (Colour{0, 255, 0, false}));
}

TEST(Colour, blinks_red_where_a_connection_breaks_and_only_there) {
  const Colour red = {255, 0, 0, true};
  EXPECT_EQ(colour_of(Verdict::kOverload, 1, false, false), red);
  EXPECT_EQ(colour_of(Verdict::kOverload, 20, true, false), red);
  EXPECT_EQ(colour_of(Verdict::kOverload, std::numeric_limits<float>::quiet_NaN(), false, false),
            red);
  EXPECT_NE(colour_of(Verdict::kOverload, 0.2F, false, false), red);
}

TEST(Colour, tells_fixed_toppling_and_undecided_robots_apart) {
  EXPECT_EQ(colour_of(Verdict::kSafe, 0.2F, true, false), (Colour{0, 0, 255, false}));
  EXPECT_TRUE(colour_of(Verdict::kUnstable, 0, false, true).blinks);
  EXPECT_EQ(colour_of(Verdict::kUnstable, 5, false, false), Colour());
  EXPECT_EQ(colour_of(Verdict::kUndecided, 0, false, false), (Colour{255, 255, 255, false}));
  EXPECT_EQ(colour_of(Verdict::kNone, 0, true, true), Colour());
}

}  // namespace
}  // namespace holdfast::agent
