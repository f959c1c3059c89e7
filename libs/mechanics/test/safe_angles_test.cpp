// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
//
// Directions in which a robot cannot tip (Sec. III-B of [Piranda 2021]). By Fig. 4b their union is
// the full turn exactly if the centre of mass lies strictly inside the convex hull of the corners;
// that is decided here without any angle, by looking for a half plane that holds all corners.
// Coordinates are small integers, so both scalars and the second method are exact.
#include "holdfast/mechanics/safe_angles.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <cstdlib>
#include <limits>
#include <vector>

#include "holdfast/base/rng.hpp"

namespace holdfast::mechanics {
namespace {

/// A square facet, its centre relative to the centre of mass.
struct Facet {
  std::int64_t x = 0;
  std::int64_t y = 0;
  std::int64_t half_width = 1;
};

/// Second method. The centre of mass is not strictly inside if and only if all corners lie in a
/// closed half plane; its border can be turned until it meets a corner.
bool surrounds_origin(const std::vector<Facet>& facets) {
  std::vector<std::array<std::int64_t, 2>> corners;
  for (const Facet& f : facets) {
    for (const std::int64_t sx : {-f.half_width, f.half_width}) {
      for (const std::int64_t sy : {-f.half_width, f.half_width}) {
        corners.push_back({f.x + sx, f.y + sy});
      }
    }
  }
  for (const auto& border : corners) {
    for (const std::int64_t side : {-1, 1}) {
      bool holds_all = border[0] != 0 || border[1] != 0;
      for (const auto& corner : corners) {
        holds_all = holds_all && side * (border[0] * corner[1] - border[1] * corner[0]) >= 0;
      }
      if (holds_all) {
        return false;
      }
    }
  }
  return !corners.empty();
}

template <class Real>
SafeAngles<Real> angles_of(const Facet& facet) {
  return safe_angles<Real>({static_cast<Real>(facet.x), static_cast<Real>(facet.y)},
                           static_cast<Real>(facet.half_width));
}

template <class Real>
SafeAngles<Real> joined(const std::vector<Facet>& facets) {
  SafeAngles<Real> angles;
  for (const Facet& facet : facets) {
    angles = merge(angles, angles_of<Real>(facet));
  }
  return angles;
}

template <class Real>
bool is_stable(const std::vector<Facet>& facets) {
  return joined<Real>(facets).range == SafeRange::kFull;
}

std::vector<Facet> random_facets(base::Rng& rng) {
  const std::uint64_t reach = 2 + rng.below(7);
  std::vector<Facet> facets(1 + rng.below(6));
  const auto half_width = static_cast<std::int64_t>(1 + rng.below(3));
  const auto shift_x = static_cast<std::int64_t>(rng.below(reach + 1));
  const auto shift_y = static_cast<std::int64_t>(rng.below(reach + 1));
  for (Facet& facet : facets) {
    facet.x = static_cast<std::int64_t>(rng.below(2 * reach + 1)) - shift_x;
    facet.y = static_cast<std::int64_t>(rng.below(2 * reach + 1)) - shift_y;
    facet.half_width = half_width;
  }
  return facets;
}

template <class Real>
class SafeAnglesOf : public testing::Test {};

using Scalars = testing::Types<float, double>;
TYPED_TEST_SUITE(SafeAnglesOf, Scalars);

TYPED_TEST(SafeAnglesOf, nothing_are_empty) {
  EXPECT_EQ(joined<TypeParam>({}).range, SafeRange::kEmpty);
}

TYPED_TEST(SafeAnglesOf, one_facet_are_full_only_if_the_mass_is_strictly_over_it) {
  for (std::int64_t x = -3; x <= 3; ++x) {
    for (std::int64_t y = -3; y <= 3; ++y) {
      const bool is_over = std::abs(x) < 2 && std::abs(y) < 2;
      EXPECT_EQ(is_stable<TypeParam>({{x, y, 2}}), is_over) << x << ", " << y;
    }
  }
}

TYPED_TEST(SafeAnglesOf, random_facets_are_full_exactly_if_they_surround_the_mass) {
  int stable_count = 0;
  base::Rng rng(1);
  for (int i = 0; i < 20'000; ++i) {
    const auto facets = random_facets(rng);
    EXPECT_EQ(is_stable<TypeParam>(facets), surrounds_origin(facets)) << "sample " << i;
    stable_count += surrounds_origin(facets) ? 1 : 0;
  }
  EXPECT_GT(stable_count, 4000);
  EXPECT_LT(stable_count, 16'000);
}

/// The mass on an edge between two facets, on one facet's own edge, on a corner of the polygon.
TYPED_TEST(SafeAnglesOf, a_tie_are_not_full) {
  EXPECT_FALSE(is_stable<TypeParam>({{-3, 1, 1}, {5, 1, 1}}));
  EXPECT_FALSE(is_stable<TypeParam>({{-3, -1, 1}, {5, -1, 1}}));
  EXPECT_FALSE(is_stable<TypeParam>({{1, 4, 1}, {1, -2, 1}, {7, 3, 1}}));
  EXPECT_FALSE(is_stable<TypeParam>({{0, 1, 1}, {4, 5, 1}}));
  EXPECT_FALSE(is_stable<TypeParam>({{1, 1, 1}, {5, 3, 1}}));
  EXPECT_FALSE(is_stable<TypeParam>({{-2, 4, 1}, {4, -2, 1}, {5, 5, 1}}));
  // One step beyond the last tie, whose edge runs diagonally from (-3, 3) to (3, -3).
  EXPECT_TRUE(is_stable<TypeParam>({{-3, 4, 1}, {4, -2, 1}, {5, 5, 1}}));
}

/// Feet at +x only, all around the seam of atan2: joined by smallest and largest angle they would
/// seem to cover every direction.
TYPED_TEST(SafeAnglesOf, an_overhang_in_any_direction_are_not_full) {
  for (const std::int64_t side : {-1, 1}) {
    EXPECT_FALSE(is_stable<TypeParam>({{side * 2, -4, 1}, {side * 2, 0, 1}, {side * 2, 4, 1}}));
    EXPECT_FALSE(is_stable<TypeParam>({{-4, side * 2, 1}, {0, side * 2, 1}, {4, side * 2, 1}}));
    EXPECT_FALSE(is_stable<TypeParam>({{side * 2, 40, 1}, {side * 2, -40, 1}}));
  }
  EXPECT_TRUE(is_stable<TypeParam>({{2, -4, 1}, {2, 4, 1}, {-2, 0, 1}}));
}

/// Two facets left and right, then one more above: what stays open is a closed cone downwards.
TYPED_TEST(SafeAnglesOf, an_overhang_leave_the_gap_open_over_which_it_tips) {
  const auto angles = joined<TypeParam>({{-4, 3, 1}, {4, 3, 1}, {0, 9, 1}});
  ASSERT_EQ(angles.range, SafeRange::kArc);
  // Perpendicular to the outermost corners (-5, 2) and (5, 2), seen from the mass.
  const auto& [first_x, first_y] = angles.gap_first;
  const auto& [last_x, last_y] = angles.gap_last;
  EXPECT_EQ(-5 * first_x + 2 * first_y, 0);
  EXPECT_EQ(5 * last_x + 2 * last_y, 0);
  EXPECT_TRUE(first_x < 0 && first_y < 0);
  EXPECT_TRUE(last_x > 0 && last_y < 0);
}

template <class Real>
SafeAngles<Real> joined_in_random_order(const std::vector<Facet>& facets, base::Rng& rng) {
  std::vector<SafeAngles<Real>> parts;
  for (const Facet& facet : facets) {
    parts.push_back(angles_of<Real>(facet));
  }
  while (parts.size() > 1) {
    std::swap(parts[rng.below(parts.size())], parts.back());
    const SafeAngles<Real> last = parts.back();
    parts.pop_back();
    SafeAngles<Real>& other = parts[rng.below(parts.size())];
    other = rng.below(2) == 0 ? merge(other, last) : merge(last, other);
  }
  return parts.front();
}

template <class Real>
bool is_same_ray(const PlanVector<Real>& a, const PlanVector<Real>& b) {
  return a.x * b.y == a.y * b.x && a.x * b.x + a.y * b.y > 0;
}

TYPED_TEST(SafeAnglesOf, a_tree_do_not_depend_on_its_order) {
  base::Rng rng(2);
  for (int i = 0; i < 4000; ++i) {
    const auto facets = random_facets(rng);
    const auto expected = joined<TypeParam>(facets);
    const auto angles = joined_in_random_order<TypeParam>(facets, rng);
    ASSERT_EQ(angles.range, expected.range) << "sample " << i;
    if (angles.range == SafeRange::kArc) {
      EXPECT_TRUE(is_same_ray(angles.gap_first, expected.gap_first)) << "sample " << i;
      EXPECT_TRUE(is_same_ray(angles.gap_last, expected.gap_last)) << "sample " << i;
    }
  }
}

/// Whole numbers stay exact far beyond 32 bits: no factor changes an answer.
TEST(SafeAnglesOfLargeNumbers, are_those_of_small_ones) {
  base::Rng rng(17);
  constexpr std::int64_t kFactor = 123'456'789'012'345'677;  // Times 9: half of kPlanVectorMax.
  for (int sample = 0; sample < 3000; ++sample) {
    std::vector<Facet> small(1 + rng.below(4));
    std::vector<Facet> large;
    for (Facet& facet : small) {
      facet = {static_cast<std::int64_t>(rng.below(17)) - 8,
               static_cast<std::int64_t>(rng.below(17)) - 8,
               1 + static_cast<std::int64_t>(rng.below(3))};
      large.push_back({facet.x * kFactor, facet.y * kFactor, facet.half_width * kFactor});
    }
    EXPECT_EQ(joined<std::int64_t>(large).range, joined<std::int64_t>(small).range);
    EXPECT_EQ(joined<std::int64_t>(small).range == SafeRange::kFull, surrounds_origin(small));
  }
  constexpr std::int64_t kMost = kPlanVectorMax / 2;
  EXPECT_EQ(safe_angles<std::int64_t>({kMost, 0}, 1).range, SafeRange::kArc);
  EXPECT_EQ(safe_angles<std::int64_t>({kMost + 1, 0}, 1).range, SafeRange::kEmpty);
  EXPECT_EQ(safe_angles<std::int64_t>({0, 0}, kMost + 1).range, SafeRange::kEmpty);
  const SafeAngles<std::int64_t> good = safe_angles<std::int64_t>({4, 0}, 1);
  const SafeAngles<std::int64_t> bad = {
      .range = SafeRange::kArc, .gap_first = {1, kPlanVectorMax + 1}, .gap_last = {1, 1}};
  EXPECT_EQ(merge(bad, good).range, SafeRange::kArc);
  EXPECT_EQ(merge(bad, bad).range, SafeRange::kEmpty);
}

/// An operand that is not a number counts as nothing, so it can only make the answer less safe.
TYPED_TEST(SafeAnglesOf, what_is_not_a_number_are_never_full) {
  using Real = TypeParam;
  constexpr Real kNan = std::numeric_limits<Real>::quiet_NaN();
  constexpr Real kInfinity = std::numeric_limits<Real>::infinity();
  constexpr Real kLargest = std::numeric_limits<Real>::max();
  const SafeAngles<Real> good = angles_of<Real>({4, 0, 1});
  const auto expect_nothing = [&](const SafeAngles<Real>& bad) {
    EXPECT_EQ(merge(good, bad).range, SafeRange::kArc);
    EXPECT_EQ(merge(bad, good).range, SafeRange::kArc);
    EXPECT_EQ(merge(bad, bad).range, SafeRange::kEmpty);
  };
  for (const Real x : {kNan, kInfinity, -kInfinity, kLargest}) {
    EXPECT_EQ(safe_angles<Real>({x, 0}, 1).range, SafeRange::kEmpty);
    EXPECT_EQ(safe_angles<Real>({0, x}, 1).range, SafeRange::kEmpty);
    for (int component = 0; component < 4; ++component) {
      SafeAngles<Real> bad = good;
      Real* components[] = {&bad.gap_first.x, &bad.gap_first.y, &bad.gap_last.x, &bad.gap_last.y};
      *components[component] = x;
      expect_nothing(bad);
    }
  }
  EXPECT_EQ(safe_angles<Real>({4, 0}, kNan).range, SafeRange::kEmpty);
  EXPECT_EQ(safe_angles<Real>({0, 0}, kNan).range, SafeRange::kEmpty);
  expect_nothing({.range = SafeRange::kArc});  // Gap vectors of length zero.
}

}  // namespace
}  // namespace holdfast::mechanics
