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

namespace {

#ifndef HOLDFAST_AGENT_FLOOR_ONLY

/// sqrt(3), to three parts in ten million. What is compared is A + B sqrt(3) with whole numbers A
/// and B, which is zero for this number, too, where it is zero; with a better one 64 bits would not
/// do.
constexpr std::int64_t kRootNumerator = 1351;
constexpr std::int64_t kRootDenominator = 780;

bool has_rows(const Setup& setup) { return setup.lattice == base::kHexagonalPrism; }

bool has_layers(const Setup& setup) {
  return setup.lattice.shear_x != 0 || setup.lattice.shear_y != 0;
}

#endif

/// All lengths of the check are so many times as large as they would have to be.
std::int64_t scale_of([[maybe_unused]] const Setup& setup) {
#ifdef HOLDFAST_AGENT_FLOOR_ONLY
  return 1;
#else
  return has_rows(setup) ? kRootDenominator : 1;
#endif
}

/// Half of a facet's width is Setup::facet_numerator of these times the scale.
std::int64_t parts_of_cell(const Setup& setup) {
#ifdef HOLDFAST_AGENT_FLOOR_ONLY
  return 2 * std::int64_t{setup.facet_denominator};
#else
  const int halves = has_rows(setup) || has_layers(setup) ? 1 : 2;
  return scale_of(setup) * halves * setup.facet_denominator;
#endif
}

std::int64_t parts_of_row(const Setup& setup) {
#ifndef HOLDFAST_AGENT_FLOOR_ONLY
  if (has_rows(setup)) {
    return kRootNumerator * setup.facet_denominator;
  }
#endif
  return parts_of_cell(setup);
}

}  // namespace

base::Cell floor_place([[maybe_unused]] const Setup& setup, const base::Cell& cell,
                       const base::Cell& from) {
  base::Cell away = {cell.x - from.x, cell.y - from.y, cell.z - from.z};
#ifndef HOLDFAST_AGENT_FLOOR_ONLY
  if (has_layers(setup)) {
    const std::int32_t shift = (cell.z & 1) - (from.z & 1);
    away.x = 2 * away.x + shift * setup.lattice.shear_x;
    away.y = 2 * away.y + shift * setup.lattice.shear_y;
  } else if (has_rows(setup)) {
    away.x = 2 * away.x + away.y;
  }
#endif
  return away;
}

FeetCheck::FeetCheck(const Setup& setup, std::int32_t mass,
                     const std::array<std::int32_t, 2>& moment)
    : pitch_(parts_of_cell(setup) * mass),
      half_width_(scale_of(setup) * setup.facet_numerator * mass),
#ifndef HOLDFAST_AGENT_FLOOR_ONLY
      pitch_y_(parts_of_row(setup) * mass),
#endif
      mass_{parts_of_cell(setup) * moment[0], parts_of_row(setup) * moment[1]} {
}

SafeCorners FeetCheck::of_foot(std::int32_t x, std::int32_t y) const {
  const Vector centre = {x * pitch_ - mass_.x, y * pitch_y() - mass_.y};
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
  const auto place = [&](std::int32_t quarters, std::int64_t pitch, std::int64_t mass) {
    const std::int32_t cell = (quarters + 1) >> 2;
    return cell * pitch + (quarters > 4 * cell ? half_width_ : -half_width_) - mass;
  };
  return {place(corner.x, pitch_, mass_.x), place(corner.y, pitch_y(), mass_.y)};
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
