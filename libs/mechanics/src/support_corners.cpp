// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "holdfast/mechanics/support_corners.hpp"

namespace holdfast::mechanics {
namespace {

/// Exact: coordinates are below 2^22, so products fit in 64 bits.
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

}  // namespace

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
