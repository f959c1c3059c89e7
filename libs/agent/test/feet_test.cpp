// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
//
// Does it topple, in whole numbers? Expected values: the centre of mass against the convex hull of
// all corners (second method, for small robots), and closed forms for rows that are as long as
// rows can be.
#include "holdfast/agent/cells/feet.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <vector>

#include "holdfast/base/rng.hpp"
#include "test_setup.hpp"

namespace holdfast::agent {
namespace {

using namespace holdfast::agent::test;
using mechanics::SafeRange;

struct Place {
  std::int32_t x = 0;
  std::int32_t y = 0;
};

/// Is there a line through the origin and a corner with all corners on one side? Numbers up to
/// `tie` are zero.
template <class Real>
bool has_all_on_one_side(const std::vector<std::array<Real, 2>>& corners, Real tie) {
  const auto is_zero = [&](Real value) { return -tie <= value && value <= tie; };
  for (const auto& border : corners) {
    for (const int side : {-1, 1}) {
      bool holds_all = !is_zero(border[0]) || !is_zero(border[1]);
      for (const auto& corner : corners) {
        holds_all = holds_all && side * (border[0] * corner[1] - border[1] * corner[0]) >= -tie;
      }
      if (holds_all) {
        return true;
      }
    }
  }
  return false;
}

/// The range of feet merged one by one.
SafeRange range_of(const FeetCheck& check, const std::vector<Place>& feet) {
  SafeCorners all;
  for (const Place& foot : feet) {
    all = check.merge(check.of_foot(foot.x, foot.y), all);
  }
  return all.range;
}

/// Second method: a line through the centre of mass and a corner with all corners on one side.
bool topples(const std::vector<Place>& feet, std::int64_t half_width, std::int64_t pitch,
             const Place& mass_times_count, std::int64_t count) {
  std::vector<std::array<std::int64_t, 2>> corners;
  for (const Place& foot : feet) {
    for (const std::int64_t sx : {-half_width, half_width}) {
      for (const std::int64_t sy : {-half_width, half_width}) {
        corners.push_back({(pitch * foot.x + sx) * count - pitch * mass_times_count.x,
                           (pitch * foot.y + sy) * count - pitch * mass_times_count.y});
      }
    }
  }
  return has_all_on_one_side<std::int64_t>(corners, 0);
}

/// Feet within a few cells, and the sum of the places of so many masses.
struct SmallRobot {
  std::vector<Place> feet;
  std::int32_t count = 0;
  Place sum;
};

/// A robot with facets of any width, which go into the setup.
SmallRobot random_robot(base::Rng& rng, Setup& setup) {
  setup.facet_denominator = 1 + static_cast<std::int32_t>(rng.below(4));
  setup.facet_numerator = 1 + static_cast<std::int32_t>(rng.below(5));
  SmallRobot robot;
  robot.feet.resize(1 + rng.below(5));
  for (Place& foot : robot.feet) {
    foot = {static_cast<std::int32_t>(rng.below(9)) - 4,
            static_cast<std::int32_t>(rng.below(9)) - 4};
  }
  robot.count = static_cast<std::int32_t>(1 + rng.below(20));
  robot.sum = {static_cast<std::int32_t>(rng.below(80)) - 40,
               static_cast<std::int32_t>(rng.below(80)) - 40};
  return robot;
}

TEST(Feet, small_robots_topple_when_their_mass_is_not_over_them) {
  base::Rng rng(11);
  int stable_count = 0;
  for (int sample = 0; sample < 4000; ++sample) {
    auto setup = table_setup();
    const auto [feet, count, sum] = random_robot(rng, setup);
    const FeetCheck check(setup, count, {sum.x, sum.y});
    const bool is_stable =
        !topples(feet, setup.facet_numerator, 2 * setup.facet_denominator, sum, count);
    EXPECT_EQ(range_of(check, feet) == SafeRange::kFull, is_stable) << "sample " << sample;
    stable_count += is_stable ? 1 : 0;
  }
  EXPECT_GT(stable_count, 400);
}

/// A row from -n to n on one foot in its middle, and one module more on top of place k: the centre
/// of mass is at k / (2 n + 2), the edge of the foot at 1/2. On the edge there is nothing to spare.
TEST(Feet, the_longest_rows_are_exact) {
  const auto setup = table_setup();
  for (const std::int32_t n : {100, 8191, 8192, 16'384, 65'533}) {
    const std::int32_t count = 2 * n + 2;
    for (const std::int32_t k : {n, n + 1}) {
      const FeetCheck along_x(setup, count, {k, 0});
      const FeetCheck along_y(setup, count, {0, -k});
      const SafeRange expected = k == n ? SafeRange::kFull : SafeRange::kArc;
      EXPECT_EQ(range_of(along_x, {{0, 0}}), expected) << n;
      EXPECT_EQ(range_of(along_y, {{0, 0}}), expected) << n;
    }
  }
}

/// Feet at (r, 1), (-r, 1) and (0, -r), facets of a millionth less than a cell: the edge between
/// the first two is y = 3/2 - 1/2000000. All numbers are as large as they may be: 2^24 modules.
TEST(Feet, the_largest_numbers_are_exact) {
  auto setup = table_setup();
  setup.facet_denominator = 1'000'000;
  setup.facet_numerator = 999'999;
  constexpr std::int32_t kReach = 65'534;
  constexpr auto kCount = static_cast<std::int32_t>(kCheckedMassMax);
  ASSERT_TRUE(fits_exact_check(setup, kCount));
  const std::vector<Place> feet = {{kReach, 1}, {-kReach, 1}, {0, -kReach}};
  // kCount x 1.4999995 = 25165815.6114
  EXPECT_EQ(range_of(FeetCheck(setup, kCount, {0, 25'165'815}), feet), SafeRange::kFull);
  EXPECT_EQ(range_of(FeetCheck(setup, kCount, {0, 25'165'816}), feet), SafeRange::kArc);
  EXPECT_EQ(range_of(FeetCheck(setup, kCount, {0x7fffffff, -0x7fffffff}), feet), SafeRange::kFull);
  EXPECT_EQ(range_of(FeetCheck(setup, kCount, {0x7fffffff, 25'165'816}), feet), SafeRange::kArc);
}

/// Rows of prisms are sqrt(3)/2 of a pitch apart. Second method: as above, in long double, whose
/// digits tell numbers a + b sqrt(3) of this size from zero.
TEST(Feet, small_robots_of_prisms_topple_when_their_mass_is_not_over_them) {
  base::Rng rng(12);
  int stable_count = 0;
  for (int sample = 0; sample < 4000; ++sample) {
    auto setup = table_setup();
    setup.lattice = base::kHexagonalPrism;
    const auto [feet, count, sum] = random_robot(rng, setup);
    std::vector<std::array<long double, 2>> corners;
    for (const Place& foot : feet) {
      for (const int side_x : {-1, 1}) {
        for (const int side_y : {-1, 1}) {
          const long double half = setup.facet_numerator;
          const long double pitch = setup.facet_denominator;
          corners.push_back({(pitch * foot.x + half * side_x) * count - pitch * sum.x,
                             (pitch * foot.y * std::sqrt(3.0L) + half * side_y) * count -
                                 pitch * sum.y * std::sqrt(3.0L)});
        }
      }
    }
    const FeetCheck check(setup, count, {sum.x, sum.y});
    const bool is_stable = !has_all_on_one_side(corners, 1e-9L);
    EXPECT_EQ(range_of(check, feet) == SafeRange::kFull, is_stable) << "sample " << sample;
    stable_count += is_stable ? 1 : 0;
  }
  EXPECT_GT(stable_count, 400);
}

/// One foot half a pitch wide, and a mass m of n in the next row of prisms: the centre of mass is
/// m sqrt(3) / (2 n) pitches away, so it stands if (2 m)^2 3 < n^2. n = 2 x and m = y with x^2 - 3
/// y^2 = 1, or -2 on the other side, are as near to the edge as whole numbers come.
TEST(Feet, rows_of_prisms_are_exact) {
  auto setup = table_setup();
  setup.lattice = base::kHexagonalPrism;
  setup.facet_denominator = 2;
  int count = 0;
  for (std::array<std::int32_t, 4> xy = {2, 1, 5, 3}; 2 * xy[2] < kCheckedMassMax;
       xy = {2 * xy[0] + 3 * xy[1], xy[0] + 2 * xy[1], 2 * xy[2] + 3 * xy[3], xy[2] + 2 * xy[3]}) {
    const auto& [x, y, x_over, y_over] = xy;
    for (const std::int32_t side : {-1, 1}) {
      const FeetCheck stands(setup, 2 * x, {0, side * y});
      EXPECT_EQ(range_of(stands, {{0, 0}}), SafeRange::kFull) << x;
      const FeetCheck falls(setup, 2 * x_over, {0, side * y_over});
      EXPECT_EQ(range_of(falls, {{0, 0}}), SafeRange::kArc) << x_over;
      // The same foot a row and a half aside.
      EXPECT_EQ(range_of(FeetCheck(setup, 2 * x, {6 * x, side * (y + 4 * x)}), {{3, 2 * side}}),
                SafeRange::kFull);
      EXPECT_EQ(range_of(FeetCheck(setup, 2 * x_over, {6 * x_over, side * (y_over + 4 * x_over)}),
                         {{3, 2 * side}}),
                SafeRange::kArc);
    }
    ++count;
  }
  EXPECT_GE(count, 11);
}

/// What comes off the wire is a corner of a cell, at the end of the largest robot at most.
TEST(Feet, corners_stay_what_they_are) {
  const auto setup = table_setup();
  const FeetCheck check(setup, 4, {-2, 2});
  const SafeCorners foot = check.of_foot(-1, 0);
  EXPECT_EQ(foot.range, SafeRange::kArc);
  EXPECT_EQ(foot.first, (FootCorner{-5, 1}));
  EXPECT_EQ(foot.last, (FootCorner{-3, -1}));
  const SafeCorners both = check.merge(foot, {});
  EXPECT_EQ(both.first, foot.first);
  EXPECT_EQ(both.last, foot.last);
}

}  // namespace
}  // namespace holdfast::agent
