// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>

#include "statics/contact_cone.hpp"

namespace holdfast::limit {
namespace {

/// Corners in one plane, with the place of each along its first facet's x' and y'.
struct Plane {
  struct Corner {
    double x = 0;
    double y = 0;
    Vector3d place;
  };

  ContactPoint kind;  ///< Normal, directions across and friction of all.
  std::vector<Corner> corners;
};

/// Andrew's monotone chain. Corners on an edge of the hull may stay.
void keep_hull(std::vector<Plane::Corner>& corners) {
  std::ranges::sort(corners, [](const auto& a, const auto& b) {
    return std::tie(a.x, a.y) < std::tie(b.x, b.y);
  });
  std::vector<Plane::Corner> hull;
  for (int pass = 0; pass < 2 && corners.size() > 2; ++pass) {
    const std::size_t start = hull.size();
    for (const Plane::Corner& next : corners) {
      while (hull.size() >= start + 2) {
        const Plane::Corner& a = hull[hull.size() - 2];
        const Plane::Corner& b = hull.back();
        if ((b.x - a.x) * (next.y - a.y) - (b.y - a.y) * (next.x - a.x) > 0) {
          break;
        }
        hull.pop_back();
      }
      hull.push_back(next);
    }
    hull.pop_back();
    std::ranges::reverse(corners);
  }
  if (!hull.empty()) {
    corners = std::move(hull);
  }
}

/// What distinguishes planes, in steps far below any facet and far above rounding.
std::array<std::int64_t, 5> key(const ContactFacet& facet) {
  constexpr double kSteps = 1e6;
  const Vector3d normal = vector(facet.frame[2]);
  return {std::llround(normal[0] * kSteps), std::llround(normal[1] * kSteps),
          std::llround(normal[2] * kSteps),
          std::llround(normal.dot(vector(facet.centre_mm)) * kSteps),
          std::llround(facet.friction.value_or(-1) * kSteps * kSteps)};
}

}  // namespace

std::vector<ContactPoint> contact_points(std::span<const ContactFacet> facets,
                                         const Vector3d& centre_of_mass) {
  std::map<std::array<std::int64_t, 5>, Plane> planes;
  for (const ContactFacet& facet : facets) {
    const Vector3d x = vector(facet.frame[0]);
    const Vector3d y = vector(facet.frame[1]);
    Plane& plane = planes[key(facet)];
    if (plane.corners.empty()) {
      plane.kind = {.place = Vector3d::Zero(),
                    .normal = vector(facet.frame[2]),
                    .across = {x, y},
                    .friction = facet.friction};
    }
    const int corner_count = facet.half_width_mm > 0 ? 4 : 1;
    for (int corner = 0; corner < corner_count; ++corner) {
      const double sign_x = corner % 2 == 0 ? 1 : -1;
      const double sign_y = corner / 2 == 0 ? 1 : -1;
      const Vector3d place = vector(facet.centre_mm) - centre_of_mass +
                             facet.half_width_mm * (sign_x * x + sign_y * y);
      plane.corners.push_back(
          {plane.kind.across[0].dot(place), plane.kind.across[1].dot(place), place});
    }
  }
  std::vector<ContactPoint> points;
  for (auto& [unused, plane] : planes) {
    keep_hull(plane.corners);
    for (const Plane::Corner& corner : plane.corners) {
      points.push_back(plane.kind);
      points.back().place = corner.place;
    }
  }
  return points;
}

}  // namespace holdfast::limit
