// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "floating_body.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "holdfast/model/mass.hpp"

namespace holdfast::verdict {
namespace {

/// Twice the signed area of the triangle a, b, c, positive if c lies left of a -> b.
double turn(const PlanPoint& a, const PlanPoint& b, const PlanPoint& c) {
  return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

/// Signed distance of a point to the line a -> b, positive on its left.
double distance(const PlanPoint& a, const PlanPoint& b, const PlanPoint& point) {
  return turn(a, b, point) / std::hypot(b.x - a.x, b.y - a.y);
}

/// Andrew's monotone chain; counter-clockwise. Points nearer than `tie` to an edge are none.
std::vector<PlanPoint> convex_hull(std::vector<PlanPoint> points, double tie) {
  std::ranges::sort(points, [](const PlanPoint& a, const PlanPoint& b) {
    return a.x != b.x ? a.x < b.x : a.y < b.y;
  });
  points.erase(std::unique(points.begin(), points.end(),
                           [&](const PlanPoint& a, const PlanPoint& b) {
                             return std::hypot(a.x - b.x, a.y - b.y) <= tie;
                           }),
               points.end());
  if (points.size() < 2) {
    return points;
  }
  std::vector<PlanPoint> hull;
  for (int pass = 0; pass < 2; ++pass) {
    const std::size_t start = hull.size();
    for (const PlanPoint& point : points) {
      while (hull.size() >= start + 2 &&
             distance(hull[hull.size() - 2], point, hull.back()) >= -tie) {
        hull.pop_back();
      }
      hull.push_back(point);
    }
    hull.pop_back();
    std::ranges::reverse(points);
  }
  return hull;
}

/// The frame of a floor's facets is the global one.
std::vector<PlanPoint> facet_corners(const model::Robot& robot, const base::NodePlaces& node_mm) {
  const double b = robot.foot_half_width_mm();
  std::vector<PlanPoint> corners;
  for (const model::Facet& facet : robot.facets()) {
    const auto centre = node_mm(robot.modules()[base::at(facet.module)].cell);
    for (const double x : {-b, b}) {
      for (const double y : {-b, b}) {
        corners.push_back({centre[0] + x, centre[1] + y});
      }
    }
  }
  return corners;
}

}  // namespace

RigidBody floating_body(const model::Robot& robot) {
  RigidBody body;
  const model::Mass mass = model::mass_of(robot);
  body.centre_of_mass = {mass.centre_mm[0], mass.centre_mm[1]};
  body.is_stable = robot.fixed_count() > 0 || robot.has_bonded_facets();
  if (!is_on_flat_floor(robot)) {
    return body;
  }
  const double tie = kMarginTie * robot.material().pitch_mm;
  const base::NodePlaces node_mm(robot.lattice(), robot.material().pitch_mm);
  body.polygon = convex_hull(facet_corners(robot, node_mm), tie);
  if (body.is_stable) {
    return body;
  }
  double margin = std::numeric_limits<double>::infinity();
  const std::size_t count = body.polygon.size();
  for (std::size_t i = 0; i < count; ++i) {
    const PlanPoint& a = body.polygon[i];
    const PlanPoint& b = body.polygon[(i + 1) % count];
    // A single point is an edge without length: over it, nothing is to spare.
    const double here = count > 1
                            ? distance(a, b, body.centre_of_mass)
                            : -std::hypot(a.x - body.centre_of_mass.x, a.y - body.centre_of_mass.y);
    if (here < margin) {
      margin = here;
      body.edge = {a, b};
    }
  }
  body.margin_mm = std::abs(margin) <= tie ? 0 : margin;
  body.is_stable = *body.margin_mm > 0;
  return body;
}

}  // namespace holdfast::verdict
