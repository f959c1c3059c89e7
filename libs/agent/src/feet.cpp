// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "holdfast/agent/feet.hpp"

namespace holdfast::agent {

using mechanics::SafeRange;

bool is_good_corner(const FootCorner& corner) {
  for (const std::int32_t value : {corner.x, corner.y}) {
    constexpr std::int32_t kMost = 4 * std::int32_t{kExtentMax} + 1;
    if (value % 2 == 0 || value < -kMost || value > kMost) {
      return false;
    }
  }
  return true;
}

bool fits_exact_check(const Setup& setup, std::int64_t mass) {
  return mass > 0 && mass <= kCheckedMassMax && setup.facet_numerator <= kFacetPartMax &&
         setup.facet_denominator <= kFacetPartMax;
}

FeetCheck::FeetCheck(const Setup& setup, std::int32_t mass,
                     const std::array<std::int32_t, 2>& moment)
    : pitch_(2 * std::int64_t{setup.facet_denominator} * mass),
      half_width_(std::int64_t{setup.facet_numerator} * mass),
      mass_{2 * std::int64_t{setup.facet_denominator} * moment[0],
            2 * std::int64_t{setup.facet_denominator} * moment[1]} {}

SafeCorners FeetCheck::of_foot(std::int32_t x, std::int32_t y) const {
  const Vector centre = {x * pitch_ - mass_.x, y * pitch_ - mass_.y};
  const Angles angles = mechanics::safe_angles(centre, half_width_);
  SafeCorners corners{.range = angles.range};
  if (angles.range == SafeRange::kArc) {
    // A quarter turn back; the corner is on that side of the centre.
    const Vector first = {-angles.gap_last.y, angles.gap_last.x};
    const Vector last = {angles.gap_first.y, -angles.gap_first.x};
    const auto corner_at = [&](const Vector& place) {
      return FootCorner{4 * x + (place.x > centre.x ? 1 : -1),
                        4 * y + (place.y > centre.y ? 1 : -1)};
    };
    corners.first = corner_at(first);
    corners.last = corner_at(last);
  }
  return corners;
}

/// A corner from the centre of mass.
FeetCheck::Vector FeetCheck::seen(const FootCorner& corner) const {
  const auto place = [&](std::int32_t quarters, std::int64_t mass) {
    const std::int32_t cell = (quarters + 1) >> 2;
    return cell * pitch_ + (quarters > 4 * cell ? half_width_ : -half_width_) - mass;
  };
  return {place(corner.x, mass_.x), place(corner.y, mass_.y)};
}

FeetCheck::Angles FeetCheck::angles_of(const SafeCorners& corners) const {
  if (corners.range != SafeRange::kArc) {
    return {.range = corners.range};
  }
  const Vector first = seen(corners.first);
  const Vector last = seen(corners.last);
  return {
      .range = SafeRange::kArc, .gap_first = {-last.y, last.x}, .gap_last = {first.y, -first.x}};
}

SafeCorners FeetCheck::merge(const SafeCorners& a, const SafeCorners& b) const {
  const Angles of_a = angles_of(a);
  const Angles joined = mechanics::merge(of_a, angles_of(b));
  SafeCorners corners{.range = joined.range};
  if (joined.range == SafeRange::kArc) {
    const auto is_same = [](const Vector& v, const Vector& w) { return v.x == w.x && v.y == w.y; };
    const bool has_a = a.range == SafeRange::kArc;
    corners.first = has_a && is_same(joined.gap_last, of_a.gap_last) ? a.first : b.first;
    corners.last = has_a && is_same(joined.gap_first, of_a.gap_first) ? a.last : b.last;
  }
  return corners;
}

}  // namespace holdfast::agent
