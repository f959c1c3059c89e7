// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "holdfast/verdict/rigid_body.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace holdfast::verdict {
namespace {

/// In units of a half pitch or a fraction of it. Scaled by the number of modules where the centre
/// of mass takes part.
struct Point {
  std::int64_t x = 0;
  std::int64_t y = 0;

  friend constexpr auto operator<=>(const Point&, const Point&) = default;
};

// Coordinates reach 2^21 times 2^12 units times 2^25 modules: products need up to 119 bits.
__extension__ using Wide = __int128;

/// Twice the signed area of the triangle a, b, c; positive if c lies left of a -> b.
Wide turn(const Point& a, const Point& b, const Point& c) {
  return static_cast<Wide>(b.x - a.x) * (c.y - a.y) - static_cast<Wide>(b.y - a.y) * (c.x - a.x);
}

/// Andrew's monotone chain; counter-clockwise, no three points on one line.
std::vector<Point> convex_hull(std::vector<Point> points) {
  if (points.empty()) {
    return points;
  }
  std::ranges::sort(points);
  points.erase(std::unique(points.begin(), points.end()), points.end());
  std::vector<Point> hull;
  for (int pass = 0; pass < 2; ++pass) {
    const std::size_t start = hull.size();
    for (const Point& point : points) {
      while (hull.size() >= start + 2 && turn(hull[hull.size() - 2], hull.back(), point) <= 0) {
        hull.pop_back();
      }
      hull.push_back(point);
    }
    hull.pop_back();
    std::ranges::reverse(points);
  }
  return hull;
}

/// Units per half pitch. A facet as wide as the pitch has its corners at odd half pitches; any
/// other width is rounded down to 1/4096 of a half pitch, towards the safe side.
std::int64_t units_per_half_pitch(const model::Material& material) {
  return material.facet_mm == material.pitch_mm ? 1 : 4096;
}

std::vector<Point> support_corners(const model::Robot& robot, std::int64_t units) {
  const model::Material& material = robot.material();
  const auto reach =
      static_cast<std::int64_t>(static_cast<double>(units) * material.facet_mm / material.pitch_mm);
  std::vector<Point> corners;
  for (const model::Module& module : robot.modules()) {
    if (module.support == model::Support::kGround) {
      const std::int64_t x = 2 * units * module.cell.x;
      const std::int64_t y = 2 * units * module.cell.y;
      corners.insert(corners.end(), {{x - reach, y - reach},
                                     {x + reach, y - reach},
                                     {x - reach, y + reach},
                                     {x + reach, y + reach}});
    }
  }
  return corners;
}

/// An edge of the polygon and the signed distance to its line, positive on the inside.
struct EdgeDistance {
  double distance = std::numeric_limits<double>::infinity();
  Point a;
  Point b;
};

bool contains_strictly(const std::vector<Point>& hull, const Point& point) {
  for (std::size_t i = 0; i < hull.size(); ++i) {
    if (turn(hull[i], hull[(i + 1) % hull.size()], point) <= 0) {
      return false;
    }
  }
  return true;
}

EdgeDistance nearest_edge(const std::vector<Point>& hull, const Point& mass) {
  EdgeDistance nearest;
  for (std::size_t i = 0; i < hull.size(); ++i) {
    const Point& a = hull[i];
    const Point& b = hull[(i + 1) % hull.size()];
    const double length =
        std::hypot(static_cast<double>(b.x - a.x), static_cast<double>(b.y - a.y));
    const double distance = static_cast<double>(turn(a, b, mass)) / length;
    if (distance < nearest.distance) {
      nearest = {.distance = distance, .a = a, .b = b};
    }
  }
  return nearest;
}

}  // namespace

RigidBody assess_rigid_body(const model::Robot& robot) {
  // Everything in half pitches times count: the centre of mass becomes an integer.
  const auto count = static_cast<std::int64_t>(robot.modules().size());
  const std::int64_t units = units_per_half_pitch(robot.material());
  const double unit_mm =
      robot.material().pitch_mm / 2 / static_cast<double>(units) / static_cast<double>(count);
  const auto plan_point = [&](const Point& point) {
    return PlanPoint{static_cast<double>(point.x) * unit_mm,
                     static_cast<double>(point.y) * unit_mm};
  };
  Point mass;
  for (const model::Module& module : robot.modules()) {
    mass.x += 2 * units * module.cell.x;
    mass.y += 2 * units * module.cell.y;
  }
  std::vector<Point> hull = convex_hull(support_corners(robot, units));
  for (Point& point : hull) {
    point = {point.x * count, point.y * count};
  }

  RigidBody body;
  body.centre_of_mass = plan_point(mass);
  for (const Point& point : hull) {
    body.polygon.push_back(plan_point(point));
  }
  if (robot.fixed_count() > 0) {
    body.is_stable = true;
    return body;
  }
  body.is_stable = contains_strictly(hull, mass);
  const EdgeDistance nearest = nearest_edge(hull, mass);
  body.margin_mm = nearest.distance * unit_mm;
  body.edge = {plan_point(nearest.a), plan_point(nearest.b)};
  return body;
}

}  // namespace holdfast::verdict
