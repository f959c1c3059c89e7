// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "holdfast/mechanics/safe_angles.hpp"

#include <limits>

namespace holdfast::mechanics {
namespace {

template <class Real>
Real cross(PlanVector<Real> a, PlanVector<Real> b) {
  return a.x * b.y - a.y * b.x;
}

template <class Real>
Real dot(PlanVector<Real> a, PlanVector<Real> b) {
  return a.x * b.x + a.y * b.y;
}

/// Is v in the closed convex cone from `first` counter-clockwise to `last`?
template <class Real>
bool is_in_gap(const SafeAngles<Real>& angles, PlanVector<Real> v) {
  const PlanVector<Real>& first = angles.gap_first;
  const PlanVector<Real>& last = angles.gap_last;
  return cross(first, v) >= 0 && cross(v, last) >= 0 && (dot(first, v) > 0 || dot(last, v) > 0);
}

/// Neither zero nor a NaN nor so large that products of two such vectors overflow.
template <class Real>
bool has_direction(PlanVector<Real> v) {
  const Real square = dot(v, v);
  return square > 0 && square <= std::numeric_limits<Real>::max();
}

/// Says nothing about any direction: empty, or an arc whose gap is not known.
template <class Real>
bool is_void(const SafeAngles<Real>& angles) {
  return angles.range == SafeRange::kEmpty ||
         (angles.range == SafeRange::kArc &&
          !(has_direction(angles.gap_first) && has_direction(angles.gap_last)));
}

}  // namespace

template <class Real>
SafeAngles<Real> safe_angles(PlanVector<Real> facet, Real half_width) {
  const PlanVector<Real> corners[4] = {{facet.x - half_width, facet.y - half_width},
                                       {facet.x + half_width, facet.y - half_width},
                                       {facet.x + half_width, facet.y + half_width},
                                       {facet.x - half_width, facet.y + half_width}};
  if (-half_width < facet.x && facet.x < half_width && -half_width < facet.y &&
      facet.y < half_width) {
    return {.range = SafeRange::kFull};
  }
  // Seen from outside, the facet spans less than a half turn (a half turn from its edge): every
  // corner lies left of the first and right of the last one. A corner at zero has no direction.
  SafeAngles<Real> angles{.range = SafeRange::kArc};
  for (const PlanVector<Real>& candidate : corners) {
    bool is_first = dot(candidate, candidate) > 0;
    bool is_last = is_first;
    for (const PlanVector<Real>& other : corners) {
      is_first = is_first && cross(candidate, other) >= 0;
      is_last = is_last && cross(other, candidate) >= 0;
    }
    if (is_first) {
      angles.gap_last = {candidate.y, -candidate.x};
    }
    if (is_last) {
      angles.gap_first = {-candidate.y, candidate.x};
    }
  }
  return is_void(angles) ? SafeAngles<Real>{} : angles;
}

template <class Real>
SafeAngles<Real> merge(const SafeAngles<Real>& a, const SafeAngles<Real>& b) {
  if (is_void(a)) {
    return is_void(b) ? SafeAngles<Real>{} : b;
  }
  if (is_void(b) || a.range == SafeRange::kFull) {
    return a;
  }
  if (b.range == SafeRange::kFull) {
    return b;
  }
  SafeAngles<Real> joined{.range = SafeRange::kArc};
  if (is_in_gap(a, b.gap_first)) {
    joined.gap_first = b.gap_first;
  } else if (is_in_gap(b, a.gap_first)) {
    joined.gap_first = a.gap_first;
  } else {
    return {.range = SafeRange::kFull};
  }
  joined.gap_last = is_in_gap(a, b.gap_last) ? b.gap_last : a.gap_last;
  return joined;
}

template SafeAngles<float> safe_angles(PlanVector<float>, float);
template SafeAngles<double> safe_angles(PlanVector<double>, double);
template SafeAngles<std::int64_t> safe_angles(PlanVector<std::int64_t>, std::int64_t);
template SafeAngles<float> merge(const SafeAngles<float>&, const SafeAngles<float>&);
template SafeAngles<double> merge(const SafeAngles<double>&, const SafeAngles<double>&);
template SafeAngles<std::int64_t> merge(const SafeAngles<std::int64_t>&,
                                        const SafeAngles<std::int64_t>&);

}  // namespace holdfast::mechanics
