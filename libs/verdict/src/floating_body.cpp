// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "floating_body.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "holdfast/base/lattice.hpp"
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
void add_corners(const std::array<double, 3>& centre, double half_width,
                 std::vector<PlanPoint>& corners) {
  for (const double x : {-half_width, half_width}) {
    for (const double y : {-half_width, half_width}) {
      corners.push_back({centre[0] + x, centre[1] + y});
    }
  }
}

}  // namespace

FloatingBody body_of(const model::Robot& robot) {
  host::Ranks& ranks = robot.ranks();
  const std::size_t count = robot.own_count();
  FloatingBody body{.is_held = host::any(ranks, robot.fixed_count() > 0) ||
                               host::any(ranks, robot.has_bonded_facets()),
                    .is_flat = is_on_flat_floor(robot),
                    .foot_half_width_mm = robot.foot_half_width_mm(),
                    .tie_mm = kMarginTie * robot.material().pitch_mm};
  const base::NodePlaces node_mm(robot.lattice(), robot.material().pitch_mm);
  body.origin_mm = model::common_node_mm(robot);
  for (std::size_t i = 0; i < count; ++i) {
    add_module(body, node_mm(robot.modules()[i].cell), robot.mass(i), false);
  }
  for (const model::CarriedMass& carried : robot.carried()) {
    std::array<double, 3> place = node_mm(carried.carrier);
    for (std::size_t k = 0; k < 3; ++k) {
      place[k] += carried.offset_mm[k];
    }
    add_module(body, place, carried.mass_kg, false);
  }
  body.kg = host::sum(ranks, body.kg);
  for (double& moment : body.moment_kgmm) {
    moment = host::sum(ranks, moment);
  }
  if (body.is_flat) {
    std::vector<PlanPoint> corners;
    for (const model::Facet& facet : robot.facets()) {
      add_corners(node_mm(robot.modules()[base::at(facet.module)].cell), body.foot_half_width_mm,
                  corners);
    }
    body.polygon = convex_hull(std::move(corners), body.tie_mm);
    if (ranks.is_shared()) {
      body.polygon = convex_hull(host::gather<PlanPoint>(ranks, body.polygon), body.tie_mm);
    }
  }
  return body;
}

void add_module(FloatingBody& body, const std::array<double, 3>& node_mm, double mass_kg,
                bool is_on_floor) {
  for (std::size_t k = 0; k < 3; ++k) {
    body.moment_kgmm[k] += mass_kg * (node_mm[k] - body.origin_mm[k]);
  }
  body.kg += mass_kg;
  if (is_on_floor) {
    body.is_flat = true;
    add_corners(node_mm, body.foot_half_width_mm, body.polygon);
    body.polygon = convex_hull(std::move(body.polygon), body.tie_mm);
  }
}

RigidBody floating_body(const FloatingBody& given) {
  RigidBody body;
  body.centre_of_mass = {given.origin_mm[0] + given.moment_kgmm[0] / given.kg,
                         given.origin_mm[1] + given.moment_kgmm[1] / given.kg};
  body.is_stable = given.is_held;
  if (!given.is_flat) {
    return body;
  }
  body.polygon = given.polygon;
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
  body.margin_mm = std::abs(margin) <= given.tie_mm ? 0 : margin;
  body.is_stable = *body.margin_mm > 0;
  return body;
}

}  // namespace holdfast::verdict
