// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "holdfast/mechanics/support_corners.hpp"

namespace holdfast::mechanics {
namespace {

/// Whether three corners lie on one line; exact, as coordinates below 2^22 have products of 64
/// bits.
bool are_collinear(const Corner& a, const Corner& b, const Corner& c) {
  const std::int64_t ux = b.x - a.x;
  const std::int64_t uy = b.y - a.y;
  const std::int64_t uz = b.z - a.z;
  const std::int64_t vx = c.x - a.x;
  const std::int64_t vy = c.y - a.y;
  const std::int64_t vz = c.z - a.z;
  return ux * vy == uy * vx && uy * vz == uz * vy && uz * vx == ux * vz;
}

void add_corner(SupportCorners& set, const Corner& corner) {
  for (int i = 0; i < set.count; ++i) {
    if (set.corners[i] == corner) {
      return;
    }
  }
  if (set.count < 2) {
    set.corners[set.count++] = corner;
  } else if (!are_collinear(set.corners[0], set.corners[1], corner)) {
    set = {.stable = true};
  }
}

struct Way {
  double x = 0;
  double y = 0;
  double z = 0;
};

Way way(const Corner& from, const Corner& to) {
  return {static_cast<double>(to.x) - from.x, static_cast<double>(to.y) - from.y,
          static_cast<double>(to.z) - from.z};
}

double square(const Way& a) { return a.x * a.x + a.y * a.y + a.z * a.z; }

/// Each corner is off by at most sqrt(3)/2, so ways u and v by sqrt(3), and their cross product by
/// sqrt(3) (|u| + |v|) + 3; with (|u| + |v|)^2 <= 2 (u^2 + v^2) no root is needed.
bool may_be_collinear(const Corner& a, const Corner& b, const Corner& c) {
  const Way u = way(a, b);
  const Way v = way(a, c);
  const Way cross = {u.y * v.z - u.z * v.y, u.z * v.x - u.x * v.z, u.x * v.y - u.y * v.x};
  constexpr double kRounding = 8;  // 2 * (sqrt(3))^2, and more for the 3, as ways are long.
  return square(cross) <= kRounding * (square(u) + square(v));
}

/// The distance up to which two corners are one.
constexpr double kSameCorner = 4;

void add_rounded(SupportCorners& set, const Corner& corner) {
  for (int i = 0; i < set.count; ++i) {
    if (square(way(set.corners[i], corner)) <= kSameCorner) {
      return;
    }
  }
  if (set.count < 2) {
    set.corners[set.count++] = corner;
    return;
  }
  Corner& a = set.corners[0];
  Corner& b = set.corners[1];
  if (!may_be_collinear(a, b, corner)) {
    set = {.stable = true};
    return;
  }
  const double between = square(way(a, b));
  const double from_a = square(way(a, corner));
  const double from_b = square(way(b, corner));
  if (from_a > between && from_a >= from_b) {
    b = corner;
  } else if (from_b > between) {
    a = corner;
  }
}

}  // namespace

SupportCorners merge_rounded(const SupportCorners& a, const SupportCorners& b) {
  if (a.stable || b.stable) {
    return {.stable = true};
  }
  SupportCorners merged = a;
  for (int i = 0; i < b.count && !merged.stable; ++i) {
    add_rounded(merged, b.corners[i]);
  }
  return merged;
}

SupportCorners support_corners(const base::Cell& cell, ContactState state) {
  if (!state.pressed) {
    return {};
  }
  if (state.tilt_x == 0 && state.tilt_y == 0) {
    return {.stable = true};
  }
  // mx^ < 0 presses the +y edge, my^ > 0 the +x edge.
  const std::int32_t z = 2 * cell.z - 1;
  SupportCorners set;
  for (std::int32_t side_x = -1; side_x <= 1; side_x += 2) {
    for (std::int32_t side_y = -1; side_y <= 1; side_y += 2) {
      if (state.tilt_x != side_y && state.tilt_y != -side_x) {
        add_corner(set, {2 * cell.x + side_x, 2 * cell.y + side_y, z});
      }
    }
  }
  return set;
}

SupportCorners merge(const SupportCorners& a, const SupportCorners& b) {
  if (a.stable || b.stable) {
    return {.stable = true};
  }
  SupportCorners merged = a;
  for (int i = 0; i < b.count && !merged.stable; ++i) {
    add_corner(merged, b.corners[i]);
  }
  return merged;
}

}  // namespace holdfast::mechanics
