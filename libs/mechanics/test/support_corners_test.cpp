// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
//
// Which corners carry, and when they hold a robot (Sec. III-C of [Piranda 2021]). Expected values:
// the corners of a unit facet by hand, and for merged sets a brute-force search through all triples
// of all corners for one that is not on a line.
#include "holdfast/mechanics/support_corners.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "holdfast/base/rng.hpp"

namespace holdfast::mechanics {
namespace {

using base::Cell;

bool holds(const SupportCorners& set, const Corner& corner) {
  return std::find(set.corners, set.corners + set.count, corner) != set.corners + set.count;
}

SupportCorners pair_of(const Corner& a, const Corner& b) { return {.count = 2, .corners = {a, b}}; }

SupportCorners single(const Corner& corner) { return {.count = 1, .corners = {corner, {}}}; }

/// Second method: rank of all corners at once, by the largest minor of any triple.
bool spans_a_plane(const std::vector<Corner>& corners) {
  for (const Corner& a : corners) {
    for (const Corner& b : corners) {
      for (const Corner& c : corners) {
        const double u[3] = {double{1} * b.x - a.x, double{1} * b.y - a.y, double{1} * b.z - a.z};
        const double v[3] = {double{1} * c.x - a.x, double{1} * c.y - a.y, double{1} * c.z - a.z};
        for (int i = 0; i < 3; ++i) {
          if (u[i] * v[(i + 1) % 3] - u[(i + 1) % 3] * v[i] != 0) {
            return true;
          }
        }
      }
    }
  }
  return false;
}

TEST(SupportCorners, are_none_for_an_open_facet) {
  const SupportCorners set = support_corners({3, 4, 0}, {.pressed = false});
  EXPECT_FALSE(set.stable);
  EXPECT_EQ(set.count, 0);
}

TEST(SupportCorners, are_stable_for_a_closed_facet_and_a_fixed_module) {
  EXPECT_TRUE(support_corners({3, 4, 0}, {}).stable);
  EXPECT_TRUE(fixed_support().stable);
}

/// The bottom face of cell (3, 4, 5) spans 5..7 by 7..9 half cells, at 9. Tipping over +y leaves
/// the two corners at y = 9, and so on.
TEST(SupportCorners, are_the_ends_of_the_edge_that_a_tilting_facet_stands_on) {
  const Cell cell{3, 4, 5};
  const auto over_plus_y = support_corners(cell, {.tilt_x = -1});
  EXPECT_TRUE(holds(over_plus_y, {5, 9, 9}) && holds(over_plus_y, {7, 9, 9}));
  const auto over_minus_y = support_corners(cell, {.tilt_x = 1});
  EXPECT_TRUE(holds(over_minus_y, {5, 7, 9}) && holds(over_minus_y, {7, 7, 9}));
  const auto over_plus_x = support_corners(cell, {.tilt_y = 1});
  EXPECT_TRUE(holds(over_plus_x, {7, 7, 9}) && holds(over_plus_x, {7, 9, 9}));
  const auto over_minus_x = support_corners(cell, {.tilt_y = -1});
  EXPECT_TRUE(holds(over_minus_x, {5, 7, 9}) && holds(over_minus_x, {5, 9, 9}));
  for (const auto& set : {over_plus_y, over_minus_y, over_plus_x, over_minus_x}) {
    EXPECT_EQ(set.count, 2);
    EXPECT_FALSE(set.stable);
  }
}

TEST(SupportCorners, are_the_common_point_of_two_edges_when_a_facet_tilts_both_ways) {
  for (const int side_x : {-1, 1}) {
    for (const int side_y : {-1, 1}) {
      const ContactState state = {.tilt_x = static_cast<std::int8_t>(-side_y),
                                  .tilt_y = static_cast<std::int8_t>(side_x)};
      const auto set = support_corners({-2, 0, 0}, state);
      EXPECT_EQ(set.count, 1);
      EXPECT_FALSE(set.stable);
      EXPECT_TRUE(holds(set, {-4 + side_x, side_y, -1}));
    }
  }
}

TEST(SupportCorners, merge_with_the_empty_set_unchanged) {
  const SupportCorners set = pair_of({1, 1, -1}, {3, 1, -1});
  for (const auto& merged : {merge(set, {}), merge({}, set)}) {
    EXPECT_EQ(merged.count, 2);
    EXPECT_TRUE(holds(merged, {1, 1, -1}) && holds(merged, {3, 1, -1}));
  }
  EXPECT_FALSE(merge({}, {}).stable);
  EXPECT_EQ(merge({}, {}).count, 0);
}

TEST(SupportCorners, merge_with_stable_to_stable) {
  EXPECT_TRUE(merge(fixed_support(), {}).stable);
  EXPECT_TRUE(merge(single({1, 1, -1}), fixed_support()).stable);
}

TEST(SupportCorners, count_a_shared_corner_once) {
  const SupportCorners set = pair_of({1, 1, -1}, {3, 1, -1});
  EXPECT_EQ(merge(set, set).count, 2);
  EXPECT_FALSE(merge(set, set).stable);
  EXPECT_EQ(merge(single({1, 1, -1}), single({1, 1, -1})).count, 1);
}

TEST(SupportCorners, stay_two_on_a_line_and_become_stable_off_it) {
  const SupportCorners diagonal = pair_of({1, 1, -1}, {5, 5, -1});
  EXPECT_FALSE(merge(diagonal, single({-7, -7, -1})).stable);
  EXPECT_EQ(merge(diagonal, single({-7, -7, -1})).count, 2);
  EXPECT_TRUE(merge(diagonal, single({-7, -5, -1})).stable);
  const SupportCorners slope = pair_of({1, 1, -1}, {3, 5, 5});
  EXPECT_FALSE(merge(slope, single({5, 9, 11})).stable);
  EXPECT_TRUE(merge(slope, single({5, 9, 9})).stable);
}

/// The far ends of the lattice: one half cell off a line four million long must be seen. Products
/// reach 1.6e13; in 32 bits that of the last triple, 2^16 by 2^16, would be zero.
TEST(SupportCorners, are_compared_exactly_over_the_whole_lattice) {
  const std::int32_t far = 2 * base::kCoordinateMax;
  const SupportCorners ends = pair_of({-far, -far, -1}, {far, far, -1});
  EXPECT_FALSE(merge(ends, single({1, 1, -1})).stable);
  EXPECT_TRUE(merge(ends, single({1, 0, -1})).stable);
  EXPECT_TRUE(merge(pair_of({-far, far, -far}, {far, -far, far}), single({0, 0, 1})).stable);
  EXPECT_TRUE(merge(pair_of({1, 1, -1}, {65'537, 1, -1}), single({1, 65'537, -1})).stable);
}

/// Points of a line in a direction that is no ratio of whole numbers, rounded: no triple is taken
/// for a triangle, however the three are chosen, and one a hundredth of their distance away is.
TEST(SupportCorners, that_are_rounded_stay_two_on_a_line) {
  const auto place = [](double along, double across) {
    const auto part = [](double value) { return static_cast<std::int32_t>(std::lround(value)); };
    return Corner{part(along * 0.6123 - across * 0.7906), part(along * 0.7906 + across * 0.6123),
                  part(along * 0.31)};
  };
  base::Rng rng(2);
  for (int i = 0; i < 2000; ++i) {
    const auto along = [&] { return static_cast<double>(rng.below(100'000)) - 50'000; };
    SupportCorners set;
    for (int k = 0; k < 5; ++k) {
      set = merge_rounded(set, single(place(along(), 0)));
    }
    ASSERT_FALSE(set.stable) << i;
    const double reach = std::abs(static_cast<double>(set.corners[0].x - set.corners[1].x));
    EXPECT_TRUE(merge_rounded(set, single(place(along(), 1000))).stable || reach < 2000);
  }
}

SupportCorners random_set(base::Rng& rng, std::vector<Corner>& all) {
  const Cell cell{static_cast<std::int32_t>(rng.below(3)), static_cast<std::int32_t>(rng.below(3)),
                  static_cast<std::int32_t>(rng.below(2))};
  const ContactState tilted[] = {{.tilt_x = 1},
                                 {.tilt_y = -1},
                                 {.tilt_x = 1, .tilt_y = 1},
                                 {.tilt_x = -1, .tilt_y = 1},
                                 {.tilt_x = 1, .tilt_y = -1},
                                 {.tilt_x = -1, .tilt_y = -1},
                                 {.pressed = false}};
  const SupportCorners set = support_corners(cell, tilted[rng.below(std::size(tilted))]);
  all.insert(all.end(), set.corners, set.corners + set.count);
  return set;
}

/// Merges neighbours in a random tree over a random order.
SupportCorners merge_in_random_order(std::vector<SupportCorners> sets, base::Rng& rng) {
  while (sets.size() > 1) {
    const std::size_t i = rng.below(sets.size());
    std::swap(sets[i], sets.back());
    const SupportCorners last = sets.back();
    sets.pop_back();
    SupportCorners& other = sets[rng.below(sets.size())];
    other = rng.below(2) == 0 ? merge(other, last) : merge(last, other);
  }
  return sets.front();
}

TEST(SupportCorners, merge_in_any_order_to_the_rank_of_all_corners) {
  int stable_count = 0;
  base::Rng rng(1);
  for (int i = 0; i < 4000; ++i) {
    std::vector<Corner> all;
    std::vector<SupportCorners> sets(1 + rng.below(4));
    for (SupportCorners& set : sets) {
      set = random_set(rng, all);
    }
    const bool is_stable = spans_a_plane(all);
    const bool has_two =
        std::any_of(all.begin(), all.end(), [&](const Corner& c) { return c != all.front(); });
    const int count = is_stable ? 0 : (all.empty() ? 0 : (has_two ? 2 : 1));
    for (int order = 0; order < 4; ++order) {
      const SupportCorners merged = merge_in_random_order(sets, rng);
      EXPECT_EQ(merged.stable, is_stable);
      EXPECT_EQ(merged.count, count);
    }
    stable_count += is_stable ? 1 : 0;
  }
  EXPECT_GT(stable_count, 400);
  EXPECT_LT(stable_count, 3600);
}

}  // namespace
}  // namespace holdfast::mechanics
