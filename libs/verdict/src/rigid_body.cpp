// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "holdfast/verdict/rigid_body.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <span>
#include <utility>

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

/// Feet in a row along x: the first and the last.
struct Row {
  std::int32_t y = 0;
  std::int32_t first = 0;
  std::int32_t last = 0;
};

void add_row(const Row& more, std::map<std::int32_t, Row>& rows) {
  Row& row = rows.try_emplace(more.y, more).first->second;
  row.first = std::min(row.first, more.first);
  row.last = std::max(row.last, more.last);
}

/// Corners of the feet, as far as they can be corners of the polygon: of every row along x those at
/// its two ends.
std::vector<Point> support_corners(const model::Robot& robot, host::Ranks& ranks) {
  std::map<std::int32_t, Row> rows;
  for (const model::Facet& facet : robot.facets()) {
    const auto [x, y, z] = robot.modules()[base::at(facet.module)].cell;
    add_row({.y = y, .first = x, .last = x}, rows);
  }
  std::vector<Row> mine;
  for (const auto& [y, row] : rows) {
    mine.push_back(row);
  }
  for (const Row& row : host::gather<Row>(ranks, mine)) {
    add_row(row, rows);
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

/// Cubes that weigh the same.
struct Cubes {
  Measure measure;
  double pitch_mm = 0;
  double facet_mm = 0;
  bool is_fixed = false;
  std::int64_t count = 0;
  Point mass = {};               ///< Times count, in half pitches: whole numbers.
  std::vector<Point> hull = {};  ///< Of the feet.

  PlanPoint plan_point(const Point& point) const {
    const auto length = [&](const Length& part) {
      return (static_cast<double>(part.pitches) * pitch_mm +
              static_cast<double>(part.facets) * facet_mm) /
             2;
    };
    return {length(point.x), length(point.y)};
  }
};

/// Twice the sums of the modules' coordinates, and how many there are; of all ranks' modules.
struct CubeSums {
  std::int64_t x = 0;
  std::int64_t y = 0;
  std::int64_t count = 0;
};

CubeSums cube_sums(const model::Robot& robot) {
  const std::size_t count = robot.own_count();
  CubeSums mine{.count = static_cast<std::int64_t>(count)};
  for (const model::Module& module : robot.modules().first(count)) {
    mine.x += 2 * std::int64_t{module.cell.x};
    mine.y += 2 * std::int64_t{module.cell.y};
  }
  CubeSums all;
  for (const CubeSums& one : host::gather(robot.ranks(), std::span<const CubeSums>(&mine, 1))) {
    all.x += one.x;
    all.y += one.y;
    all.count += one.count;
  }
  return all;
}

Cubes cubes_of(const model::Robot& robot) {
  const CubeSums sums = cube_sums(robot);
  const model::Material& material = robot.material();
  Cubes cubes{.measure = Measure(material.pitch_mm, material.facet_mm),
              .pitch_mm = material.pitch_mm,
              .facet_mm = material.facet_mm,
              .is_fixed = host::any(robot.ranks(), robot.fixed_count() > 0),
              .count = sums.count};
  cubes.mass.x.pitches = sums.x;
  cubes.mass.y.pitches = sums.y;
  cubes.hull = convex_hull(support_corners(robot, robot.ranks()), cubes.measure);
  return cubes;
}

RigidBody exact_body(const Cubes& cubes) {
  RigidBody body;
  const double half_pitch_mm = cubes.pitch_mm / 2 / static_cast<double>(cubes.count);
  body.centre_of_mass = {static_cast<double>(cubes.mass.x.pitches) * half_pitch_mm,
                         static_cast<double>(cubes.mass.y.pitches) * half_pitch_mm};
  for (const Point& point : cubes.hull) {
    body.polygon.push_back(cubes.plan_point(point));
  }
  if (cubes.is_fixed) {
    body.is_stable = true;
    return body;
  }
  body.is_stable = contains_strictly(cubes.hull, cubes.mass, cubes.count, cubes.measure);
  const EdgeDistance nearest = nearest_edge(cubes.hull, cubes.mass, cubes.count, cubes.measure);
  body.margin_mm = nearest.distance * half_pitch_mm;
  body.edge = {cubes.plan_point(nearest.a), cubes.plan_point(nearest.b)};
  return body;
}

/// Whether exact_body() decides.
bool is_exact(const model::Robot& robot) {
  host::Ranks& ranks = robot.ranks();
  const double mass_max = host::max(ranks, robot.mass(0));  // All ranks ask.
  const bool is_alike = robot.is_uniform() && robot.mass(0) == mass_max;
  const bool is_plain = robot.lattice() == base::kCubic && is_alike && robot.carried().empty();
  const bool has_facets = host::any(ranks, !robot.facets().empty());
  return host::all(ranks, is_plain) && (!has_facets || is_on_flat_floor(robot));
}

}  // namespace

bool is_on_flat_floor(const model::Robot& robot) {
  host::Ranks& ranks = robot.ranks();
  const auto& [x, y, z] = robot.gravity();
  const bool has_facets = host::any(ranks, !robot.facets().empty());
  const bool has_payloads = host::any(ranks, robot.has_payloads());
  if (!has_facets || x != 0 || y != 0 || z >= 0 || has_payloads) {
    return false;
  }
  const base::Direction down = base::down(robot.lattice());
  const auto level = [&](const model::Facet& facet) {
    return robot.modules()[base::at(facet.module)].cell.z;
  };
  const auto first = robot.facets().empty() ? std::numeric_limits<std::int32_t>::min()
                                            : level(robot.facets().front());
  const double highest = host::max(ranks, first);
  return host::all(ranks, std::ranges::all_of(robot.facets(), [&](const model::Facet& facet) {
                     return facet.direction == down && !facet.is_bonded() &&
                            level(facet) == highest;
                   }));
}

RigidBody assess_rigid_body(const model::Robot& robot) {
  return is_exact(robot) ? exact_body(cubes_of(robot)) : floating_body(body_of(robot));
}

struct GrowingRigidBody::Exact {
  Cubes cubes;
};

struct GrowingRigidBody::Floating {
  FloatingBody body;
  base::NodePlaces node_mm;
  double mass_kg = 0;
};

GrowingRigidBody::GrowingRigidBody(const model::Robot& robot, double mass_kg) {
  if (is_exact(robot) && robot.mass(0) == mass_kg) {
    exact_ = std::make_unique<Exact>(Exact{cubes_of(robot)});
  } else {
    floating_ = std::make_unique<Floating>(
        Floating{.body = body_of(robot),
                 .node_mm = base::NodePlaces(robot.lattice(), robot.material().pitch_mm),
                 .mass_kg = mass_kg});
  }
}

GrowingRigidBody::~GrowingRigidBody() = default;

RigidBody GrowingRigidBody::with(const base::Cell& cell, bool is_on_floor) const {
  if (floating_) {
    FloatingBody body = floating_->body;
    add_module(body, floating_->node_mm(cell), floating_->mass_kg, is_on_floor);
    return floating_body(body);
  }
  Cubes cubes = exact_->cubes;
  cubes.mass.x.pitches += 2 * std::int64_t{cell.x};
  cubes.mass.y.pitches += 2 * std::int64_t{cell.y};
  ++cubes.count;
  if (is_on_floor) {
    for (const std::int64_t x : {-1, 1}) {
      for (const std::int64_t y : {-1, 1}) {
        cubes.hull.push_back({{2 * std::int64_t{cell.x}, x}, {2 * std::int64_t{cell.y}, y}});
      }
    }
    cubes.hull = convex_hull(std::move(cubes.hull), cubes.measure);
  }
  return exact_body(cubes);
}

}  // namespace holdfast::verdict
