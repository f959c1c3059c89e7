// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
// Rigid bodies on contacts, wherever these are, against closed forms: slopes, edges, tripods,
// slots.
#include "holdfast/limit/rigid_stability.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "holdfast/base/algebra.hpp"
#include "holdfast/base/rng.hpp"
#include "seeds.hpp"

namespace holdfast::limit {
namespace {

constexpr double kDegree = std::numbers::pi / 180;
/// The accuracy of angles and coefficients: they come from products of rounded directions, and from
/// halving to ten digits.
constexpr double kTolerance = 1e-7;

constexpr std::array<Vector3, 3> kUp = {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
constexpr std::array<Vector3, 3> kDown = {{{1, 0, 0}, {0, -1, 0}, {0, 0, -1}}};

ContactFacet floor_at(double x, double y, std::optional<double> friction = {}) {
  return {.centre_mm = {x, y, 0}, .frame = kUp, .half_width_mm = 20, .friction = friction};
}

/// 10 N, gravity turned by `degrees` from -z towards +x.
BodyLoad weight_at(const Vector3& centre, double degrees = 0) {
  return {.weight_n = {10 * std::sin(degrees * kDegree), 0, -10 * std::cos(degrees * kDegree)},
          .centre_of_mass_mm = centre,
          .gyration_mm = 20};
}

double uniform(base::Rng& rng) { return static_cast<double>(rng.next() >> 11U) * 0x1p-53; }

/// A rotation by a quaternion: its columns.
std::array<Vector3, 3> random_frame(base::Rng& rng) {
  std::array<double, 4> q{};
  double square = 0;
  for (double& value : q) {
    value = 2 * uniform(rng) - 1;
    square += value * value;
  }
  for (double& value : q) {
    value /= std::sqrt(square);
  }
  const auto [w, x, y, z] = q;
  return {{{1 - 2 * (y * y + z * z), 2 * (x * y + w * z), 2 * (x * z - w * y)},
           {2 * (x * y - w * z), 1 - 2 * (x * x + z * z), 2 * (y * z + w * x)},
           {2 * (x * z + w * y), 2 * (y * z - w * x), 1 - 2 * (x * x + y * y)}}};
}

TEST(RigidStability, AFloorHasTheTiltOfMarginAndHeight) {
  const std::vector<ContactFacet> facets = {floor_at(0, 0), floor_at(40, 0)};
  const RigidStability found = assess_rigid(facets, weight_at({10, 0, 50}));
  EXPECT_TRUE(found.holds());
  EXPECT_EQ(found.friction_needed, 0);
  // The nearest edges are at x = -20 and y = -20 and 20: 20 mm beside a centre 50 mm high.
  EXPECT_NEAR(*found.tilt_margin_deg, std::atan2(20, 50) / kDegree, kTolerance);
  EXPECT_GT(*found.margin, 0);
  EXPECT_FALSE(found.motion);
}

TEST(RigidStability, ASlopeNeedsItsTangentAsFriction) {
  const std::vector<ContactFacet> facets = {floor_at(0, 0)};
  const RigidStability found = assess_rigid(facets, weight_at({0, 0, 20}, 30));
  EXPECT_TRUE(found.holds());
  EXPECT_NEAR(*found.friction_needed, std::tan(30 * kDegree), 1e-6);
  EXPECT_GE(*found.friction_needed, std::tan(30 * kDegree));
  EXPECT_NEAR(*found.tilt_margin_deg, 45 - 30, kTolerance);
}

TEST(RigidStability, WithFrictionTheConeLimitsTheTilt) {
  const std::vector<ContactFacet> facets = {floor_at(0, 0, 0.7)};
  const RigidStability found = assess_rigid(facets, weight_at({0, 0, 20}, 30));
  EXPECT_TRUE(found.holds());
  const double expected = std::atan(0.7) / kDegree - 30;
  EXPECT_LE(*found.tilt_margin_deg, expected);
  EXPECT_GE(*found.tilt_margin_deg, expected * (1 - kTiltAccuracy));
}

TEST(RigidStability, OnAWetSlopeItSlides) {
  const std::vector<ContactFacet> facets = {floor_at(0, 0, 0.3)};
  const RigidStability found = assess_rigid(facets, weight_at({0, 0, 10}, 30));
  EXPECT_EQ(found.answer, RigidAnswer::kFalls);
  EXPECT_LT(*found.margin, 0);
  EXPECT_EQ(found.tilt_margin_deg, 0);
  EXPECT_EQ(text(*found.motion), "slides along +x");
  EXPECT_NEAR(*found.friction_needed, std::tan(30 * kDegree), 1e-6);
  EXPECT_GE(*found.friction_needed, std::tan(30 * kDegree));
}

TEST(RigidStability, BeyondAnEdgeItTipsOverThatEdge) {
  const std::vector<ContactFacet> facets = {floor_at(0, 0), floor_at(0, 40)};
  const RigidStability found = assess_rigid(facets, weight_at({25, 20, 40}));
  EXPECT_EQ(found.answer, RigidAnswer::kFalls);
  EXPECT_FALSE(found.friction_needed);
  EXPECT_EQ(text(*found.motion), "tips over the edge from (20, -20, 0) to (20, 60, 0)");
}

TEST(RigidStability, OverTheEdgeThereIsNothingToSpare) {
  const std::vector<ContactFacet> facets = {floor_at(0, 0)};
  const RigidStability found = assess_rigid(facets, weight_at({20, 0, 40}));
  EXPECT_EQ(found.answer, RigidAnswer::kNothingToSpare);
  EXPECT_NEAR(*found.margin, 0, kMarginTie);
}

/// A block of any size, turned anyhow, whose centre of mass is s inside an edge of its facet, h
/// above it: a push F at it along (x across the edge, z up) tips it from (W - F z) s = F x h on, a
/// moment M about the edge from M = W s on. Just inside it holds, with that margin, and outside,
/// however little, it does not.
TEST(RigidStability, NextToAnEdgeTheMarginIsWhatStaticsSays) {
  base::Rng rng(7);
  const auto between = [&](double low, double high) {
    return low * std::pow(high / low, uniform(rng));
  };
  int held_count = 0;
  for (int i = 0; i < test::campaign(600); ++i) {
    SCOPED_TRACE(i);
    const double half_width = between(0.1, 1000);
    const double height = half_width * between(0.1, 10);
    const double gyration = half_width * between(0.3, 3);
    const double side = i % 2 == 0 ? 1 : -1;
    const double inside = side * half_width * between(1e-11, 0.1);
    const std::array<Vector3, 3> frame = random_frame(rng);
    const auto place = [&](double x, double z) {
      Vector3 sum{};
      for (std::size_t k = 0; k < 3; ++k) {
        sum[k] = x * frame[0][k] + z * frame[2][k];
      }
      return sum;
    };
    const ContactFacet facet = {.frame = frame,
                                .half_width_mm = half_width,
                                .friction = i % 3 == 0 ? std::optional(20.0) : std::nullopt};
    const BodyLoad load = {.weight_n = place(0, -between(1e-3, 1e3)),
                           .centre_of_mass_mm = place(half_width - inside, height),
                           .gyration_mm = gyration};
    double margin = 1;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double tips = std::abs(frame[0][axis] * height + frame[2][axis] * inside);
      margin = std::min({margin, inside / tips, inside / (std::abs(frame[1][axis]) * gyration)});
    }
    const RigidStability found = assess_rigid({{facet}}, load, false);
    if (margin > 2 * kMarginTie) {
      EXPECT_TRUE(found.holds());
      EXPECT_NEAR(*found.margin, margin, kMarginTie + 1e-9 * margin);
      ++held_count;
    } else if (margin < kMarginTie / 2) {
      EXPECT_FALSE(found.holds()) << margin;
    }
  }
  EXPECT_GE(held_count, test::least(200));
}

TEST(RigidStability, ACeilingThatItOnlyTouchesHoldsNothing) {
  const std::vector<ContactFacet> facets = {
      {.centre_mm = {0, 0, 40}, .frame = kDown, .half_width_mm = 20}};
  const RigidStability found = assess_rigid(facets, weight_at({0, 0, 20}));
  EXPECT_EQ(found.answer, RigidAnswer::kFalls);
  EXPECT_EQ(text(*found.motion), "comes off along -z");
}

TEST(RigidStability, ABondedFacetHoldsWhateverTheLoadIs) {
  const std::vector<ContactFacet> facets = {
      {.centre_mm = {0, 0, 40}, .frame = kDown, .half_width_mm = 20, .is_bonded = true}};
  EXPECT_TRUE(assess_rigid(facets, weight_at({70, 0, 20})).holds());
}

TEST(RigidStability, BetweenTwoWallsItIsWedged) {
  const std::array<Vector3, 3> left = {{{0, 0, 1}, {0, 1, 0}, {-1, 0, 0}}};
  const std::array<Vector3, 3> right = {{{0, 0, 1}, {0, -1, 0}, {1, 0, 0}}};
  const std::vector<ContactFacet> walls = {
      {.centre_mm = {20, 0, 20}, .frame = left, .half_width_mm = 20},
      {.centre_mm = {-20, 0, 20}, .frame = right, .half_width_mm = 20}};
  const RigidStability found = assess_rigid(walls, weight_at({0, 0, 20}));
  EXPECT_TRUE(found.holds());
  EXPECT_FALSE(found.margin);  // They can press as they like, but not without any friction.
  EXPECT_NEAR(*found.friction_needed, kFrictionLeast, 1e-6);
  EXPECT_FALSE(found.tilt_margin_deg);
}

TEST(RigidStability, ATripodTipsOverItsNearestSide) {
  std::vector<ContactFacet> feet;
  for (int i = 0; i < 3; ++i) {
    const double angle = 2 * std::numbers::pi * i / 3 + 0.3;
    feet.push_back({.centre_mm = {60 * std::cos(angle), 60 * std::sin(angle), 0}, .frame = kUp});
  }
  const RigidStability found = assess_rigid(feet, weight_at({0, 0, 100}));
  EXPECT_TRUE(found.holds());
  // The sides of the triangle are half as far away as its corners.
  EXPECT_NEAR(*found.tilt_margin_deg, std::atan2(30, 100) / kDegree, kTolerance);
}

TEST(RigidStability, OnIceAMomentTurnsIt) {
  BodyLoad load = weight_at({0, 0, 20});
  load.payload_nmm = {0, 0, 5};
  const std::vector<ContactFacet> facets = {floor_at(0, 0, 0.0)};
  const RigidStability found = assess_rigid(facets, load);
  EXPECT_EQ(found.answer, RigidAnswer::kFalls);
  EXPECT_EQ(text(*found.motion), "turns about the axis through (0, 0, 20) along +z");
}

// On ice, 1 N and a moment of 1 N times a share of the radius of gyration, 20 mm: the axis of
// turning is 20 mm over that share away.
TEST(RigidStability, WhatHardlyTurnsSlidesInWords) {
  BodyLoad load = weight_at({0, 0, 20});
  const std::vector<ContactFacet> facets = {floor_at(0, 0, 0.0)};
  load.payload_n = {1, 0, 0};
  load.payload_nmm = {0, 0, 20 * 0.01};
  EXPECT_EQ(text(*assess_rigid(facets, load).motion), "slides along +x");
  load.payload_nmm = {0, 0, 20 * 0.5};
  EXPECT_EQ(text(*assess_rigid(facets, load).motion),
            "turns about the axis through (0, 40, 20) along +z");
}

// A payload that holds down: 10 N of weight and 10 N that stay vertical, on feet 20 mm from the
// axis. Weight turned by an angle a tips it where 10 h sin a = 20 (10 cos a + 10).
TEST(RigidStability, APayloadDoesNotTurnWithGravity) {
  BodyLoad load = weight_at({0, 0, 80});
  load.payload_n = {0, 0, -10};
  const std::vector<ContactFacet> facets = {floor_at(0, 0)};
  const RigidStability found = assess_rigid(facets, load);
  double low = 0;
  double high = 90;
  while (high - low > 1e-12) {
    const double middle = (low + high) / 2;
    const double angle = middle * kDegree;
    (80 * std::sin(angle) < 20 * (std::cos(angle) + 1) ? low : high) = middle;
  }
  EXPECT_NEAR(*found.tilt_margin_deg, low, kTolerance);
}

TEST(RigidStability, WithoutALoadThereIsNothingToSay) {
  BodyLoad load;
  const RigidStability found = assess_rigid(std::vector<ContactFacet>{floor_at(0, 0)}, load);
  EXPECT_EQ(found.answer, RigidAnswer::kNothingToSpare);
  EXPECT_FALSE(found.motion);
}

// The same corners as of four facets, and many more within: what they add is nothing.
TEST(RigidStability, FacetsWithinTheHullChangeNothing) {
  std::vector<ContactFacet> outer;
  std::vector<ContactFacet> all;
  for (int x = 0; x < 6; ++x) {
    for (int y = 0; y < 6; ++y) {
      all.push_back(floor_at(40 * x, 40 * y, 0.4));
      if (x % 5 == 0 && y % 5 == 0) {
        outer.push_back(all.back());
      }
    }
  }
  const BodyLoad load = weight_at({70, 110, 90}, 5);
  const RigidStability a = assess_rigid(outer, load);
  const RigidStability b = assess_rigid(all, load);
  EXPECT_NEAR(*a.margin, *b.margin, 1e-9);
  EXPECT_NEAR(*a.tilt_margin_deg, *b.tilt_margin_deg, 1e-7);
}

/// A facet that pushes along `normal`, one of the axes or its opposite.
ContactFacet wall_at(const Vector3& centre, std::size_t axis, double sign,
                     std::optional<double> friction = {}) {
  std::array<Vector3, 3> frame{};
  frame[0][(axis + 1) % 3] = 1;
  frame[1][(axis + 2) % 3] = sign;
  frame[2][axis] = sign;
  return {.centre_mm = centre, .frame = frame, .half_width_mm = 20, .friction = friction};
}

// Weight along -x, away from a wall, and a floor: it turns about the edge where both meet, which is
// above the wall's other corners. These do not move then, and what is left of their pushes beside
// forces that hold sideways is rounding, of either sign.
TEST(RigidStability, ACornerThatDoesNotMoveHoldsNothing) {
  for (const double far : {0.0, 1e4, 1e7}) {
    SCOPED_TRACE(far);
    const std::vector<ContactFacet> facets = {wall_at({far - 20, 0, -40}, 0, 1),
                                              wall_at({far + 40, 40, -20}, 2, 1)};
    const BodyLoad load = {
        .weight_n = {-1, 0, 0}, .centre_of_mass_mm = {far + 10, 20, -10}, .gyration_mm = 30};
    const RigidStability found = assess_rigid(facets, load);
    EXPECT_EQ(found.answer, RigidAnswer::kFalls);
    EXPECT_LT(*found.margin, -0.01);
  }
}

// What can be balanced by cones of friction is smooth. Against its definition: gravity turned by a
// little less than the margin, whatever the direction, is balanced, and in one by little more not.
TEST(RigidStability, TheTiltOfConesIsWhereItEnds) {
  int count = 0;
  for (int seed = 0; seed < test::campaign(5, 2); ++seed) {
    SCOPED_TRACE(seed);
    const double x = 0.37 * std::sin(3.0 * seed);
    const double y = 0.29 * std::cos(5.0 * seed);
    const std::vector<ContactFacet> facets = {wall_at({0, 0, -20}, 2, 1, 0.6),
                                              wall_at({-20, 0, 0}, 0, 1, 0.2 + 0.002 * seed),
                                              wall_at({0, 20, 0}, 1, -1, 0.25)};
    BodyLoad load = {.weight_n = {10 * x, 10 * y, -10},
                     .centre_of_mass_mm = {3, -2, 1.0 * (seed % 7)},
                     .gyration_mm = 20};
    load.payload_n = {0.3 * (seed % 3), 0, -0.2 * (seed % 5)};
    const RigidStability found = assess_rigid(facets, load);
    if (!found.holds()) {
      continue;
    }
    ASSERT_TRUE(found.tilt_margin_deg);
    ++count;
    ASSERT_GT(*found.tilt_margin_deg, 0);
    const Vector3 down = load.weight_n;
    const double weight = std::hypot(down[0], down[1], down[2]);
    const Vector3 side = {-down[2] / std::hypot(down[0], down[2]), 0,
                          down[0] / std::hypot(down[0], down[2])};
    const Vector3 other = {down[1] * side[2], down[2] * side[0] - down[0] * side[2],
                           -down[1] * side[0]};
    const auto holds = [&](double degrees, double turn) {
      BodyLoad turned = load;
      for (std::size_t k = 0; k < 3; ++k) {
        const double across = weight * std::cos(turn) * side[k] + std::sin(turn) * other[k];
        turned.weight_n[k] =
            std::cos(degrees * kDegree) * down[k] + std::sin(degrees * kDegree) * across;
      }
      return assess_rigid(facets, turned).holds();
    };
    bool is_any_moving = false;
    for (int i = 0; i < 36; i += test::every(3)) {
      EXPECT_TRUE(holds(*found.tilt_margin_deg * 0.999, 10 * i * kDegree)) << i;
      is_any_moving = is_any_moving || !holds(*found.tilt_margin_deg * 1.03, 10 * i * kDegree);
    }
    EXPECT_TRUE(is_any_moving);
  }
  EXPECT_GE(count, test::least(3, 2));
}

}  // namespace
}  // namespace holdfast::limit
