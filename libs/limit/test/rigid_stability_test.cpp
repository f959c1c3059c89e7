// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
// Rigid bodies on contacts, wherever these are, against closed forms: slopes, edges, tripods,
// slots.
#include "holdfast/limit/rigid_stability.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

namespace holdfast::limit {
namespace {

constexpr double kDegree = std::numbers::pi / 180;
/// Of angles and coefficients: they come from products of rounded directions, and from halving to
/// ten digits.
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
  EXPECT_NEAR(*found.friction_needed, std::tan(30 * kDegree), kTolerance);
  EXPECT_NEAR(*found.tilt_margin_deg, 45 - 30, kTolerance);
}

TEST(RigidStability, WithFrictionTheConeLimitsTheTilt) {
  const std::vector<ContactFacet> facets = {floor_at(0, 0, 0.7)};
  const RigidStability found = assess_rigid(facets, weight_at({0, 0, 20}, 30));
  EXPECT_TRUE(found.holds());
  EXPECT_NEAR(*found.tilt_margin_deg, std::atan(0.7) / kDegree - 30, 1e-5);
}

TEST(RigidStability, OnAWetSlopeItSlides) {
  const std::vector<ContactFacet> facets = {floor_at(0, 0, 0.3)};
  const RigidStability found = assess_rigid(facets, weight_at({0, 0, 10}, 30));
  EXPECT_EQ(found.answer, RigidAnswer::kFalls);
  EXPECT_LT(*found.margin, 0);
  EXPECT_EQ(found.tilt_margin_deg, 0);
  EXPECT_EQ(text(*found.motion), "slides along +x");
  EXPECT_NEAR(*found.friction_needed, std::tan(30 * kDegree), kTolerance);
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
  EXPECT_FALSE(found.margin);  // They can press as they like.
  EXPECT_EQ(found.friction_needed, 0);
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

}  // namespace
}  // namespace holdfast::limit
