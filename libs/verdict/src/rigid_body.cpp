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
#include "holdfast/base/lattice.hpp"
#include "holdfast/model/mass.hpp"
#include "situation.hpp"

namespace holdfast::verdict {
namespace {

/// A point in half pitches and half facets. All are scaled by the number of modules where the
/// centre of mass takes part: coordinates reach 2^21 times 2^25 modules, products 2^70.
struct Point {
  Length x;
  Length y;
};

/// Twice the signed area of the triangle a, b, c, where c is `count` times as large;
/// positive if c lies left of a -> b.
Area turn(const Point& a, const Point& b, const Point& c, std::int64_t count = 1) {
  return (b.x - a.x) * (c.y - count * a.y) - (b.y - a.y) * (c.x - count * a.x);
}

/// Finds a chain around points by Andrew's monotone chain, counter-clockwise. It leaves out points
/// that are the same as the one before in the order of `is_before`, and those that are no corner
/// between two others.
template <class Item, class IsBefore, class IsSame, class IsCorner>
std::vector<Item> chain_around(std::vector<Item> points, const IsBefore& is_before,
                               const IsSame& is_same, const IsCorner& is_corner) {
  std::ranges::sort(points, is_before);
  points.erase(std::unique(points.begin(), points.end(), is_same), points.end());
  if (points.size() < 2) {
    return points;
  }
  std::vector<Item> hull;
  for (int pass = 0; pass < 2; ++pass) {
    const std::size_t start = hull.size();
    for (const Item& point : points) {
      while (hull.size() >= start + 2 && !is_corner(hull[hull.size() - 2], hull.back(), point)) {
        hull.pop_back();
      }
      hull.push_back(point);
    }
    hull.pop_back();
    std::ranges::reverse(points);
  }
  return hull;
}

/// The convex hull; no three of its points are on one line.
std::vector<Point> convex_hull(std::vector<Point> points, const Measure& measure) {
  const auto compare = [&](const Point& a, const Point& b) {
    const int x = measure.sign(a.x - b.x);
    return x != 0 ? x : measure.sign(a.y - b.y);
  };
  return chain_around(
      std::move(points), [&](const Point& a, const Point& b) { return compare(a, b) < 0; },
      [&](const Point& a, const Point& b) { return compare(a, b) == 0; },
      [&](const Point& a, const Point& b, const Point& c) {
        return measure.sign(turn(a, b, c)) > 0;
      });
}

/// The first and the last of feet in a row along x.
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
std::vector<Point> support_corners(const model::Robot& robot) {
  std::map<std::int32_t, Row> rows;
  for (const model::Facet& facet : robot.facets()) {
    const auto [x, y, z] = robot.modules()[base::at(facet.module)].cell;
    add_row({.y = y, .first = x, .last = x}, rows);
  }
  std::vector<Row> mine;
  mine.reserve(rows.size());
  for (const auto& [y, row] : rows) {
    mine.push_back(row);
  }
  for (const Row& row : host::gather<Row>(robot.ranks(), mine)) {
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

/// Whether the centre of mass is strictly inside; `mass` is `count` times as large.
bool contains_strictly(const std::vector<Point>& hull, const Point& mass, std::int64_t count,
                       const Measure& measure) {
  for (std::size_t i = 0; i < hull.size(); ++i) {
    if (measure.sign(turn(hull[i], hull[(i + 1) % hull.size()], mass, count)) <= 0) {
      return false;
    }
  }
  return true;
}

/// The edge nearest to the centre of mass, and its distance in half pitches, times `count`.
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

/// Twice the sums of all ranks' modules' coordinates.
Point plan_sum(const model::Robot& robot) {
  Point mine;
  for (const model::Module& module : robot.modules().first(robot.own_count())) {
    mine.x.pitches += 2 * std::int64_t{module.cell.x};
    mine.y.pitches += 2 * std::int64_t{module.cell.y};
  }
  Point all;
  for (const Point& one : host::gather(robot.ranks(), std::span<const Point>(&mine, 1))) {
    all.x.pitches += one.x.pitches;
    all.y.pitches += one.y.pitches;
  }
  return all;
}

Cubes cubes_of(const Situation& here) {
  const model::Robot& robot = here.robot;
  const model::Material& material = robot.material();
  Cubes cubes{.measure = Measure(material.pitch_mm, material.facet_mm),
              .pitch_mm = material.pitch_mm,
              .facet_mm = material.facet_mm,
              .is_fixed = here.rule == StabilityRule::kHeld,
              .count = static_cast<std::int64_t>(here.module_count),
              .mass = plan_sum(robot)};
  cubes.hull = convex_hull(support_corners(robot), cubes.measure);
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

/// Twice the signed area of the triangle a, b, c, positive if c lies left of a -> b.
double turn(const PlanPoint& a, const PlanPoint& b, const PlanPoint& c) {
  return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

/// Signed distance of a point to the line a -> b, positive on its left.
double distance(const PlanPoint& a, const PlanPoint& b, const PlanPoint& point) {
  return turn(a, b, point) / std::hypot(b.x - a.x, b.y - a.y);
}

/// Points nearer than `tie` to an edge are none.
std::vector<PlanPoint> convex_hull(std::vector<PlanPoint> points, double tie) {
  return chain_around(
      std::move(points),
      [](const PlanPoint& a, const PlanPoint& b) { return a.x != b.x ? a.x < b.x : a.y < b.y; },
      [&](const PlanPoint& a, const PlanPoint& b) {
        return std::hypot(a.x - b.x, a.y - b.y) <= tie;
      },
      [&](const PlanPoint& a, const PlanPoint& b, const PlanPoint& c) {
        return !(distance(a, c, b) >= -tie);
      });
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

/// The facts of a robot that floating_body() needs to know.
struct FloatingBody {
  double kg = 0;
  /// A node of the robot, that of any module: sums over a thousand modules that are far from where
  /// coordinates begin would else lose what decides.
  std::array<double, 3> origin_mm{};
  std::array<double, 3> moment_kgmm{};  ///< Mass times place from the origin, over all modules.
  bool is_held = false;                 ///< By a fixed module or a bonded facet.
  bool is_flat = false;                 ///< On a flat floor.
  double foot_half_width_mm = 0;
  double tie_mm = 0;                    ///< Less is nothing.
  std::vector<PlanPoint> polygon = {};  ///< Counter-clockwise.
};

/// Adds a module whose node is there.
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

FloatingBody body_of(const Situation& here) {
  const model::Robot& robot = here.robot;
  host::Ranks& ranks = robot.ranks();
  FloatingBody body{.is_held = here.rule == StabilityRule::kHeld,
                    .is_flat = here.is_on_flat_floor,
                    .foot_half_width_mm = robot.foot_half_width_mm(),
                    .tie_mm = kMarginTie * robot.material().pitch_mm};
  const base::NodePlaces node_mm(robot.lattice(), robot.material().pitch_mm);
  body.origin_mm = model::common_node_mm(robot);
  for (std::size_t i = 0; i < robot.own_count(); ++i) {
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

/// The rigid body in double, for any lattice and masses.
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

}  // namespace

RigidBody rigid_body(const Situation& here) {
  return here.is_exact ? exact_body(cubes_of(here)) : floating_body(body_of(here));
}

RigidBody assess_rigid_body(const model::Robot& robot) { return rigid_body(Situation(robot)); }

struct GrowingRigidBody::Exact {
  Cubes cubes;
};

struct GrowingRigidBody::Floating {
  FloatingBody body;
  base::NodePlaces node_mm;
  double mass_kg = 0;
};

GrowingRigidBody::GrowingRigidBody(const model::Robot& robot, double mass_kg) {
  const Situation here(robot);
  if (here.is_exact && robot.mass(0) == mass_kg) {
    exact_ = std::make_unique<Exact>(Exact{cubes_of(here)});
  } else {
    floating_ = std::make_unique<Floating>(
        Floating{.body = body_of(here),
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

struct ShrinkingRigidBody::Whole {
  const model::Robot& robot;
  base::NodePlaces node_mm;
  FloatingBody body;

  /// The corners of the facets but these.
  std::vector<PlanPoint> corners_without(std::span<const std::size_t> lost) const {
    std::vector<PlanPoint> corners;
    for (std::size_t i = 0; i < robot.facets().size(); ++i) {
      if (std::ranges::find(lost, i) == lost.end()) {
        add_corners_of(i, corners);
      }
    }
    return corners;
  }

  void add_corners_of(std::size_t facet, std::vector<PlanPoint>& corners) const {
    add_corners(node_mm(robot.modules()[base::at(robot.facets()[facet].module)].cell),
                body.foot_half_width_mm, corners);
  }

  /// Whether the polygon may be another without some facets.
  bool needs(std::span<const std::size_t> facets) const {
    std::vector<PlanPoint> own;
    for (const std::size_t facet : facets) {
      add_corners_of(facet, own);
    }
    const auto is_near = [&](const PlanPoint& a, const PlanPoint& b) {
      return std::hypot(a.x - b.x, a.y - b.y) <= 4 * body.tie_mm;
    };
    return std::ranges::any_of(body.polygon, [&](const PlanPoint& corner) {
      return std::ranges::any_of(own,
                                 [&](const PlanPoint& point) { return is_near(corner, point); });
    });
  }
};

ShrinkingRigidBody::ShrinkingRigidBody(const model::Robot& robot)
    : whole_(std::make_unique<Whole>(
          Whole{.robot = robot,
                .node_mm = base::NodePlaces(robot.lattice(), robot.material().pitch_mm),
                .body = body_of(Situation(robot))})) {}

ShrinkingRigidBody::~ShrinkingRigidBody() = default;

std::optional<double> ShrinkingRigidBody::margin_mm_without(
    std::optional<std::size_t> module, std::span<const std::size_t> facets) const {
  /// What rounding may do, in pitches: far more than it does, and than what kMarginTie leaves out.
  constexpr double kRounding = 1e-6;
  const model::Robot& robot = whole_->robot;
  FloatingBody body = whole_->body;
  if (whole_->needs(facets)) {
    body.polygon = convex_hull(whole_->corners_without(facets), body.tie_mm);
  }
  if (body.polygon.empty()) {
    return std::nullopt;
  }
  if (module) {
    add_module(body, whole_->node_mm(robot.modules()[*module].cell), -robot.mass(*module), false);
  }
  const auto margin = floating_body(body).margin_mm;
  return margin ? std::optional(*margin - kRounding * robot.material().pitch_mm) : std::nullopt;
}

}  // namespace holdfast::verdict
