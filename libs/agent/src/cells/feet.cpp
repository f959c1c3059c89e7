// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "holdfast/agent/cells/feet.hpp"

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

bool fits_plane_check(const Setup& setup, std::int64_t pressure, std::uint32_t module_count,
                      std::uint16_t extent) {
  const std::int64_t reach = std::int64_t{kPlaneParts} * (extent + 2);
  return setup.has_plane && fits_exact_check(setup, pressure) && reach < kExtentMax &&
         pressure >= module_count * reach;
}

namespace {

bool has_rows(const Setup& setup) {
  return kIsGeneral && !setup.has_plane && setup.lattice == base::kHexagonalPrism;
}

bool has_layers(const Setup& setup) {
  return kIsGeneral && !setup.has_plane &&
         (setup.lattice.shear_x != 0 || setup.lattice.shear_y != 0);
}

/// Along an axis of the plane of supports, in its parts.
std::int32_t plane_place(const Setup& setup, std::size_t axis, const base::Cell& cell) {
  const auto place = base::node_place(setup.lattice, cell);
  const auto& [x, y, z] = setup.plane_axes[axis];
  const double parts = kPlaneParts * (x * place[0] + y * place[1] + z * place[2]);
  return static_cast<std::int32_t>(parts < 0 ? parts - 0.5 : parts + 0.5);
}

/// Half of a facet's width is Setup::facet_numerator of these.
std::int64_t parts_of_cell(const Setup& setup) {
  const int halves = has_rows(setup) || has_layers(setup) ? 1 : 2;
  return setup.has_plane ? 1 : std::int64_t{halves} * setup.facet_denominator;
}

/// Half of a facet's width.
std::int64_t half_parts_of_facet(const Setup& setup) {
  if (setup.has_plane) {
    return kPlaneDoubt + 1 +
           std::int64_t{kPlaneParts} * setup.facet_numerator / (2 * setup.facet_denominator);
  }
  return setup.facet_numerator;
}

/// The distance from one row of cells along x to the next.
template <class Length = FloorLength>
Length parts_of_row(const Setup& setup) {
  if constexpr (kIsGeneral) {
    return has_rows(setup) ? Length{0, parts_of_cell(setup)} : Length{parts_of_cell(setup)};
  } else {
    return parts_of_cell(setup);
  }
}

}  // namespace

base::Cell floor_place(const Setup& setup, const base::Cell& cell, const base::Cell& from) {
  base::Cell away = {cell.x - from.x, cell.y - from.y, cell.z - from.z};
  if (setup.has_plane) {
    return {plane_place(setup, 0, cell) - plane_place(setup, 0, from),
            plane_place(setup, 1, cell) - plane_place(setup, 1, from), 0};
  }
  if (has_layers(setup)) {
    const std::int32_t shift = (cell.z & 1) - (from.z & 1);
    away.x = 2 * away.x + shift * setup.lattice.shear_x;
    away.y = 2 * away.y + shift * setup.lattice.shear_y;
  } else if (has_rows(setup)) {
    away.x = 2 * away.x + away.y;
  }
  return away;
}

FeetCheck::FeetCheck(const Setup& setup, std::int32_t mass,
                     const std::array<std::int32_t, 2>& moment)
    : pitch_(parts_of_cell(setup) * mass),
      half_width_(half_parts_of_facet(setup) * mass),
      pitch_y_(parts_of_row(setup) * mass),
      mass_{parts_of_cell(setup) * moment[0], parts_of_row(setup) * moment[1]} {}

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
  const auto place = [&](std::int32_t quarters, FloorLength pitch, FloorLength mass) {
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
