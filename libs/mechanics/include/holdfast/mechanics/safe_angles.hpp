// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

/// The simplified stability check of Sec. III-B: towards which directions can the robot not tip?
///
/// A support corner at d = corner - centre of mass (in plan) keeps the robot from tipping towards
/// every direction within a right angle of d. The ranges of all corners are joined over the tree;
/// the robot is stable if and only if the union is the full turn. Two things the paper leaves open:
/// - Ranges are open: a direction at exactly 90 degrees is not safe. So a centre of mass on the
///   edge of the support polygon (margin zero) is not stable: there is nothing to spare.
/// - The union is taken modulo the full turn. What a union leaves open is the intersection of
///   what its parts leave open, and that of a facet is a convex cone; so the gap is what we keep,
///   as two direction vectors. No seam, no trigonometry.
namespace holdfast::mechanics {

/// Directions of whole numbers up to here are compared exactly; larger ones count as not known.
inline constexpr std::int64_t kPlanVectorMax = std::int64_t{1} << 62U;

template <class Real>
struct PlanVector {
  Real x = 0;
  Real y = 0;
};

enum class SafeRange : std::uint8_t { kEmpty, kArc, kFull };

/// kArc: every direction is safe except the closed gap that runs counter-clockwise from
/// `gap_first` to `gap_last`, less than a half turn wide, perhaps a single direction.
template <class Real>
struct SafeAngles {
  SafeRange range = SafeRange::kEmpty;
  PlanVector<Real> gap_first = {};
  PlanVector<Real> gap_last = {};
};

/// The joined range of the four corners of a square facet, given its centre minus the centre of
/// mass. Full if the centre of mass lies strictly over the facet; empty if an argument is a NaN,
/// squares overflow, or whole numbers are larger than half of kPlanVectorMax.
template <class Real>
SafeAngles<Real> safe_angles(PlanVector<Real> facet_minus_mass, Real half_width);

/// The union of two ranges. An arc whose gap is zero, a NaN or too large, as above,
/// counts as empty: what is not known keeps no robot from tipping.
template <class Real>
SafeAngles<Real> merge(const SafeAngles<Real>& a, const SafeAngles<Real>& b);

}  // namespace holdfast::mechanics
