// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "holdfast/verdict/rigid_body.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "exact_sign.hpp"
#include "floating_body.hpp"

namespace holdfast::verdict {
namespace {

/// In half pitches and half facets. Scaled by the number of modules where the centre of mass takes
/// part: coordinates reach 2^21 times 2^25 modules, products 2^70.
struct Point {
  Length x;
  Length y;
};

/// Twice the signed area of the triangle a, b, c, where c is `count` times as large;
/// positive if c lies left of a -> b.
Area turn(const Point& a, const Point& b, const Point& c, std::int64_t count = 1) {
  return (b.x - a.x) * (c.y - count * a.y) - (b.y - a.y) * (c.x - count * a.x);
}

/// Andrew's monotone chain; counter-clockwise, no three points on one line.
std::vector<Point> convex_hull(std::vector<Point> points, const Measure& measure) {
  if (points.empty()) {
    return points;
  }
  const auto compare = [&](const Point& a, const Point& b) {
    const int x = measure.sign(a.x - b.x);
    return x != 0 ? x : measure.sign(a.y - b.y);
  };
  std::ranges::sort(points, [&](const Point& a, const Point& b) { return compare(a, b) < 0; });
  points.erase(std::unique(points.begin(), points.end(),
                           [&](const Point& a, const Point& b) { return compare(a, b) == 0; }),
               points.end());
  std::vector<Point> hull;
  for (int pass = 0; pass < 2; ++pass) {
    const std::size_t start = hull.size();
    for (const Point& point : points) {
      while (hull.size() >= start + 2 &&
             measure.sign(turn(hull[hull.size() - 2], hull.back(), point)) <= 0) {
        hull.pop_back();
      }
      hull.push_back(point);
    }
    hull.pop_back();
    std::ranges::reverse(points);
  }
  return hull;
}

/// Corners of the feet, as far as they can be corners of the polygon: of every row along x those at
/// its two ends.
std::vector<Point> support_corners(const model::Robot& robot) {
  struct Row {
    std::int32_t first;
    std::int32_t last;
  };

  std::map<std::int32_t, Row> rows;
  for (const model::Facet& facet : robot.facets()) {
    const auto [x, y, z] = robot.modules()[base::at(facet.module)].cell;
    Row& row = rows.try_emplace(y, Row{x, x}).first->second;
    row = {std::min(row.first, x), std::max(row.last, x)};
  }
  std::vector<Point> corners;
  for (const auto& [y, row] : rows) {
    for (const std::int64_t side : {-1, 1}) {
      corners.push_back({{2 * std::int64_t{row.first}, -1}, {2 * std::int64_t{y}, side}});
      corners.push_back({{2 * std::int64_t{row.last}, 1}, {2 * std::int64_t{y}, side}});
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

/// `mass` is `count` times as large.
bool contains_strictly(const std::vector<Point>& hull, const Point& mass, std::int64_t count,
                       const Measure& measure) {
  for (std::size_t i = 0; i < hull.size(); ++i) {
    if (measure.sign(turn(hull[i], hull[(i + 1) % hull.size()], mass, count)) <= 0) {
      return false;
    }
  }
  return true;
}

/// In half pitches, times `count`.
EdgeDistance nearest_edge(const std::vector<Point>& hull, const Point& mass, std::int64_t count,
                          const Measure& measure) {
  EdgeDistance nearest;
  for (std::size_t i = 0; i < hull.size(); ++i) {
    const Point& a = hull[i];
    const Point& b = hull[(i + 1) % hull.size()];
    const double length = std::hypot(measure.value(b.x - a.x), measure.value(b.y - a.y));
    const double distance = measure.value(turn(a, b, mass, count)) / length;
    if (distance < nearest.distance) {
      nearest = {.distance = distance, .a = a, .b = b};
    }
  }
  return nearest;
}

/// Of cubes that weigh the same.
RigidBody exact_body(const model::Robot& robot) {
  const model::Material& material = robot.material();
  const Measure measure(material.pitch_mm, material.facet_mm);
  const auto plan_point = [&](const Point& point) {
    const auto length = [&](const Length& part) {
      return (static_cast<double>(part.pitches) * material.pitch_mm +
              static_cast<double>(part.facets) * material.facet_mm) /
             2;
    };
    return PlanPoint{length(point.x), length(point.y)};
  };
  // Times count, the centre of mass is a whole number of half pitches.
  const auto count = static_cast<std::int64_t>(robot.modules().size());
  Point mass;
  for (const model::Module& module : robot.modules()) {
    mass.x.pitches += 2 * std::int64_t{module.cell.x};
    mass.y.pitches += 2 * std::int64_t{module.cell.y};
  }
  const std::vector<Point> hull = convex_hull(support_corners(robot), measure);

  RigidBody body;
  const double half_pitch_mm = material.pitch_mm / 2 / static_cast<double>(count);
  body.centre_of_mass = {static_cast<double>(mass.x.pitches) * half_pitch_mm,
                         static_cast<double>(mass.y.pitches) * half_pitch_mm};
  for (const Point& point : hull) {
    body.polygon.push_back(plan_point(point));
  }
  if (robot.fixed_count() > 0) {
    body.is_stable = true;
    return body;
  }
  body.is_stable = contains_strictly(hull, mass, count, measure);
  const EdgeDistance nearest = nearest_edge(hull, mass, count, measure);
  body.margin_mm = nearest.distance * half_pitch_mm;
  body.edge = {plan_point(nearest.a), plan_point(nearest.b)};
  return body;
}

}  // namespace

bool is_on_flat_floor(const model::Robot& robot) {
  const auto& [x, y, z] = robot.gravity();
  if (robot.facets().empty() || x != 0 || y != 0 || z >= 0 || robot.has_payloads()) {
    return false;
  }
  const base::Direction down = base::down(robot.lattice());
  const auto level = [&](const model::Facet& facet) {
    return robot.modules()[base::at(facet.module)].cell.z;
  };
  return std::ranges::all_of(robot.facets(), [&](const model::Facet& facet) {
    return facet.direction == down && !facet.is_bonded() &&
           level(facet) == level(robot.facets().front());
  });
}

RigidBody assess_rigid_body(const model::Robot& robot) {
  const bool is_exact =
      robot.lattice() == base::kCubic && robot.is_uniform() && robot.carried().empty();
  if (is_exact && (robot.facets().empty() || is_on_flat_floor(robot))) {
    return exact_body(robot);
  }
  return floating_body(robot);
}

}  // namespace holdfast::verdict
