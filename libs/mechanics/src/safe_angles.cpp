// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "holdfast/mechanics/safe_angles.hpp"

#include <initializer_list>
#include <limits>

#include "holdfast/mechanics/root_three.hpp"
#include "wide.hpp"

namespace holdfast::mechanics {
namespace {

/// The sign of p q + r s.
template <class Real>
int sign_of_products(Real p, Real q, Real r, Real s) {
  const Real sum = p * q + r * s;
  return sum > 0 ? 1 : sum == 0 ? 0 : -1;
}

/// The sign of p q + r s, exact for all that has_direction() admits.
template <>
int sign_of_products(std::int64_t p, std::int64_t q, std::int64_t r, std::int64_t s) {
  constexpr std::int64_t kSmall = std::int64_t{1} << 30U;
  bool is_small = true;
  for (const std::int64_t value : {p, q, r, s}) {
    is_small = is_small && -kSmall <= value && value <= kSmall;
  }
  if (is_small) {
    const std::int64_t sum = p * q + r * s;
    return sum > 0 ? 1 : sum == 0 ? 0 : -1;
  }
  const Wide first = product(p, q);
  const Wide second = product(r, s);
  const std::uint64_t low = first.low + second.low;
  const std::uint64_t high = first.high + second.high + (low < first.low ? 1U : 0U);
  return (high >> 63U) != 0 ? -1 : (high | low) != 0 ? 1 : 0;
}

/// The sign of p q + r s, exact for all that has_direction() admits: numbers without roots may be
/// as large as whole numbers.
template <>
int sign_of_products(RootThree p, RootThree q, RootThree r, RootThree s) {
  const bool has_roots = (p.roots() | q.roots() | r.roots() | s.roots()) != 0;
  return has_roots ? sign_of_product_sum(p, q, r, s)
                   : sign_of_products(p.whole(), q.whole(), r.whole(), s.whole());
}

template <class Real>
int sign_of_cross(PlanVector<Real> a, PlanVector<Real> b) {
  return sign_of_products(a.x, b.y, -a.y, b.x);
}

template <class Real>
int sign_of_dot(PlanVector<Real> a, PlanVector<Real> b) {
  return sign_of_products(a.x, b.x, a.y, b.y);
}

/// Whether v is in the closed convex cone from `first` counter-clockwise to `last`.
template <class Real>
bool is_in_gap(const SafeAngles<Real>& angles, PlanVector<Real> v) {
  const PlanVector<Real>& first = angles.gap_first;
  const PlanVector<Real>& last = angles.gap_last;
  return sign_of_cross(first, v) >= 0 && sign_of_cross(v, last) >= 0 &&
         (sign_of_dot(first, v) > 0 || sign_of_dot(last, v) > 0);
}

/// Whether a vector is neither zero nor a NaN nor so large that products of two such overflow.
template <class Real>
bool has_direction(PlanVector<Real> v) {
  const Real square = v.x * v.x + v.y * v.y;
  return square > 0 && square <= std::numeric_limits<Real>::max();
}

template <>
bool has_direction(PlanVector<std::int64_t> v) {
  const auto is_good = [](std::int64_t x) { return -kPlanVectorMax <= x && x <= kPlanVectorMax; };
  return (v.x != 0 || v.y != 0) && is_good(v.x) && is_good(v.y);
}

template <>
bool has_direction(PlanVector<RootThree> v) {
  if (v.x.roots() == 0 && v.y.roots() == 0) {
    return has_direction(PlanVector<std::int64_t>{v.x.whole(), v.y.whole()});
  }
  bool is_good = true;
  for (const std::int64_t part : {v.x.whole(), v.x.roots(), v.y.whole(), v.y.roots()}) {
    is_good = is_good && -kRootThreeMax <= part && part <= kRootThreeMax;
  }
  return is_good;
}

/// Whether a vector and a half width can be added without overflow, which reals tell by themselves.
template <class Real>
bool is_finite_facet(PlanVector<Real>, Real) {
  return true;
}

template <>
bool is_finite_facet(PlanVector<std::int64_t> facet, std::int64_t half_width) {
  constexpr std::int64_t kMost = kPlanVectorMax / 2;
  bool is_good = true;
  for (const std::int64_t value : {facet.x, facet.y, half_width}) {
    is_good = is_good && -kMost <= value && value <= kMost;
  }
  return is_good;
}

template <>
bool is_finite_facet(PlanVector<RootThree> facet, RootThree half_width) {
  constexpr std::int64_t kMost = kPlanVectorMax / 2;
  bool is_good = true;
  for (const RootThree& value : {facet.x, facet.y, half_width}) {
    for (const std::int64_t part : {value.whole(), value.roots()}) {
      is_good = is_good && -kMost <= part && part <= kMost;
    }
  }
  return is_good;
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
  if (!is_finite_facet(facet, half_width)) {
    return {};
  }
  if (-half_width < facet.x && facet.x < half_width && -half_width < facet.y &&
      facet.y < half_width) {
    return {.range = SafeRange::kFull};
  }
  // Seen from outside, the facet spans less than a half turn (a half turn from its edge): every
  // corner lies left of the first and right of the last one, which is so if the two next to it do.
  // A corner at zero has no direction.
  SafeAngles<Real> angles{.range = SafeRange::kArc};
  constexpr int kSides[4][2] = {{-1, -1}, {1, -1}, {1, 1}, {-1, 1}};
  for (const auto& side : kSides) {
    const PlanVector<Real> candidate = {facet.x + static_cast<Real>(side[0]) * half_width,
                                        facet.y + static_cast<Real>(side[1]) * half_width};
    // Where the others lie tells the way to the two next to it: one along x, one along y.
    const bool is_x_left = static_cast<Real>(side[0]) * candidate.y >= 0;
    const bool is_x_right = static_cast<Real>(side[0]) * candidate.y <= 0;
    const bool is_y_left = static_cast<Real>(side[1]) * candidate.x <= 0;
    const bool is_y_right = static_cast<Real>(side[1]) * candidate.x >= 0;
    if (candidate.x == 0 && candidate.y == 0) {
      continue;
    }
    if (is_x_left && is_y_left) {
      angles.gap_last = {candidate.y, -candidate.x};
    }
    if (is_x_right && is_y_right) {
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
template SafeAngles<RootThree> safe_angles(PlanVector<RootThree>, RootThree);
template SafeAngles<float> merge(const SafeAngles<float>&, const SafeAngles<float>&);
template SafeAngles<double> merge(const SafeAngles<double>&, const SafeAngles<double>&);
template SafeAngles<std::int64_t> merge(const SafeAngles<std::int64_t>&,
                                        const SafeAngles<std::int64_t>&);
template SafeAngles<RootThree> merge(const SafeAngles<RootThree>&, const SafeAngles<RootThree>&);

}  // namespace holdfast::mechanics
