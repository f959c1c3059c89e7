// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "draw/svg_layout.hpp"

#include <algorithm>
#include <cmath>

namespace holdfast::io {
namespace {

constexpr double kEdgePxMax = 54;
constexpr double kCardWidthMin = 800;
constexpr double kCardWidthMax = 1040;
constexpr double kDrawingHeightMin = 190;
constexpr double kDrawingHeightMax = 760;
/// Room around the robot for marks, labels and the numbers along the grid.
constexpr double kPaddingX = 64;
constexpr double kPaddingY = 46;

/// The squares of the drawing that are known to be covered or not.
constexpr double kCoveredSquarePx = 4;

std::pair<double, double> lattice_of(const Projection& projection, LatticePoint point) {
  // The corner with the smallest coordinates of the lowest cell is the origin.
  const base::Cell& lowest = projection.lowest;
  const Place place = {point.x - lowest.x + 0.5, point.y - lowest.y + 0.5,
                       point.z - lowest.z + 0.5};
  return {dot(projection.axes.u, place), dot(projection.axes.v, place)};
}

PlanRange plan_range(const model::Robot& robot) {
  PlanRange range{robot.modules().front().cell, robot.modules().front().cell};
  for (const model::Module& module : robot.modules()) {
    const base::Cell& cell = module.cell;
    range.first = {std::min(range.first.x, cell.x), std::min(range.first.y, cell.y),
                   std::min(range.first.z, cell.z)};
    range.last = {std::max(range.last.x, cell.x), std::max(range.last.y, cell.y),
                  std::max(range.last.z, cell.z)};
  }
  return range;
}

/// Widens the extent by all bodies that are drawn.
void add_bodies(const BodyView& view, const Projection& projection, Extent& extent) {
  constexpr double kAcross = kBallRadius / kCos30;  // Of u; v is twice the height.
  const auto add_faces = [&](std::span<const SeenFace> faces, double u, double v) {
    for (const SeenFace& face : faces) {
      for (const ScreenPoint& corner : face.corners) {
        extent.add(u + corner.x / kCos30, v + 2 * corner.y);
      }
    }
  };
  for (const BodyItem& item : view.items()) {
    const auto [u, v] = lattice_of(projection, LatticePoint(view.place_of(item)));
    if (item.is_obstacle) {
      add_faces(view.obstacle_faces(), u, v);
    } else if (view.body() == Body::kBall) {
      extent.add(u - kAcross, v - 2 * kBallRadius);
      extent.add(u + kAcross, v + 2 * kBallRadius);
    } else {
      add_faces(view.module_faces(), u, v);
    }
  }
}

Extent extent_of(const Scene& scene) {
  Extent extent;
  const auto add_point = [&](LatticePoint point) {
    const auto [u, v] = lattice_of(scene.projection, point);
    extent.add(u, v);
  };
  if (scene.bodies) {
    add_bodies(*scene.bodies, scene.projection, extent);
  } else {
    for (const Triangle& triangle : (scene.all ? scene.all : scene.existing)->triangles()) {
      extent.add(triangle.u, triangle.middle - 1);
      extent.add(triangle.u + 1, triangle.middle + 1);
    }
  }
  if (scene.has_polygon()) {
    for (const verdict::PlanPoint& corner : scene.assessment.simplified.polygon) {
      add_point(scene.on_ground(corner));
    }
    add_point(scene.on_ground(scene.assessment.simplified.centre_of_mass));
  }
  if (scene.has_grid()) {
    for (const double x : {scene.plan.first.x - 1.5, scene.plan.last.x + 1.5}) {
      for (const double y : {scene.plan.first.y - 1.5, scene.plan.last.y + 1.5}) {
        add_point(scene.floor_point(x, y));
      }
    }
  }
  return extent;
}

/// Scales the scene so that it fills the drawing, up to kEdgePxMax, and centres it.
void lay_out(Scene& scene) {
  const Extent extent = extent_of(scene);
  const double u_span = extent.u_max - extent.u_min;
  const double v_span = extent.v_max - extent.v_min;
  const double room_x = kCardWidthMax - 2 * kPaddingX;
  const double room_y = kDrawingHeightMax - 2 * kPaddingY;
  const double edge = std::min({kEdgePxMax, room_x / (u_span * kCos30), room_y / (v_span / 2)});
  const double width = u_span * kCos30 * edge;
  const double height = v_span / 2 * edge;
  scene.card_width = std::max(kCardWidthMin, width + 2 * kPaddingX);
  const double drawing_height = std::max(kDrawingHeightMin, height + 2 * kPaddingY);
  scene.drawing = {.left = kCardMargin / 2,
                   .top = kHeaderHeight,
                   .right = scene.card_width - kCardMargin / 2,
                   .bottom = kHeaderHeight + drawing_height};
  scene.projection.edge_px = edge;
  scene.projection.origin_px = {
      (scene.card_width - width) / 2 - extent.u_min * kCos30 * edge,
      kHeaderHeight + (drawing_height - height) / 2 - extent.v_min / 2 * edge};
}

/// Where the lattice's own origin is on the picture's lattice, which begins at each robot's lowest
/// cell.
std::pair<double, double> own_origin(const Scene& scene) {
  return lattice_of(scene.projection, LatticePoint(0, 0, 0));
}

}  // namespace

double scale_alike(std::deque<Scene>& scenes, double width, double height_max) {
  constexpr double kPadding = 8;
  Extent common;
  for (const Scene& scene : scenes) {
    const Extent extent = extent_of(scene);
    const auto [u, v] = own_origin(scene);
    common.add(extent.u_min - u, extent.v_min - v);
    common.add(extent.u_max - u, extent.v_max - v);
  }
  const double u_span = (common.u_max - common.u_min) * kCos30;
  const double v_span = (common.v_max - common.v_min) / 2;
  const double edge =
      std::min({kEdgePxMax, (width - 2 * kPadding) / u_span, (height_max - 2 * kPadding) / v_span});
  for (Scene& scene : scenes) {
    scene.common = common;
    scene.projection.edge_px = edge;
  }
  return v_span * edge + 2 * kPadding;
}

void place_frame(Scene& scene, ScreenPoint corner, double width, double height) {
  const auto [u, v] = own_origin(scene);
  const Extent& common = scene.common;
  const double edge = scene.projection.edge_px;
  scene.projection.origin_px =
      corner + ScreenPoint{width / 2 - ((common.u_min + common.u_max) / 2 + u) * kCos30 * edge,
                           height / 2 - ((common.v_min + common.v_max) / 2 + v) / 2 * edge};
  scene.drawing = {
      .left = corner.x, .top = corner.y, .right = corner.x + width, .bottom = corner.y + height};
  if (scene.bodies) {
    scene.mark_bodies();
  }
}

ScreenPoint Projection::at(double u, double v) const {
  return origin_px + ScreenPoint{u * kCos30 * edge_px, v / 2 * edge_px};
}

ScreenPoint Projection::at(Vertex vertex) const {
  return at(static_cast<double>(vertex.u), static_cast<double>(vertex.v));
}

ScreenPoint Projection::at(LatticePoint point) const {
  const auto [u, v] = lattice_of(*this, point);
  return at(u, v);
}

std::pair<double, double> Projection::lattice_at(ScreenPoint point) const {
  const ScreenPoint offset = point - origin_px;
  return {offset.x / (kCos30 * edge_px), offset.y * 2 / edge_px};
}

Scene::Scene(const model::Robot& a_robot, const verdict::Assessment& an_assessment,
             std::span<const model::Obstacle> obstacles, FigureOptions a_figure)
    : robot(a_robot),
      assessment(an_assessment),
      figure(std::move(a_figure)),
      paints(paint_modules(robot, assessment)),
      plan(plan_range(robot)) {
  projection.axes = axes_of(figure.view);
  NearObstacles near = obstacles_near(robot, obstacles);
  const bool is_cubic = robot.lattice() == base::kCubic;
  if (is_cubic) {
    projection.lowest = lowest_cell(robot);
  }
  is_general = !is_cubic || !near.cells.empty() || near.are_too_many;
  if (!is_general && projection.axes.is_isometric) {
    existing.emplace(robot, Cast::kExisting);
    if (robot.planned_count() > 0) {
      all.emplace(robot, Cast::kAll);
    }
  } else {
    bodies.emplace(robot, std::move(near), projection.axes);
  }
  lay_out(*this);
  if (bodies) {
    mark_bodies();
  }
}

void Scene::mark_bodies() {
  const auto squares = [](double px) {
    return static_cast<std::size_t>(std::ceil(px / kCoveredSquarePx));
  };
  covered_row_length_ = squares(drawing.right - drawing.left);
  const std::size_t row_count = squares(drawing.bottom - drawing.top);
  covered_.assign(covered_row_length_ * row_count, false);
  const double radius = kBallRadius * projection.edge_px / kCoveredSquarePx;
  for (const BodyItem& item : bodies->items()) {
    if (item.is_obstacle) {
      continue;
    }
    const ScreenPoint offset = projection.at(LatticePoint(bodies->place_of(item))) -
                               ScreenPoint{drawing.left, drawing.top};
    const ScreenPoint centre = (1 / kCoveredSquarePx) * offset;
    const auto first = [&](double middle) {
      return static_cast<std::size_t>(std::max(0.0, std::floor(middle - radius)));
    };
    const auto last = [&](double middle, std::size_t count) {
      return std::min(count, static_cast<std::size_t>(std::max(0.0, std::ceil(middle + radius))));
    };
    for (std::size_t y = first(centre.y); y < last(centre.y, row_count); ++y) {
      for (std::size_t x = first(centre.x); x < last(centre.x, covered_row_length_); ++x) {
        covered_[y * covered_row_length_ + x] = true;
      }
    }
  }
}

double Scene::ground_z() const {
  // Where there is a polygon all facets are in its plane.
  const auto& facet = robot.facets().front();
  return facet_centre(facet.module, facet.direction).z;
}

double Scene::floor_z() const {
  return base::node_place(robot.lattice(), {0, 0, robot.support_z()})[2] -
         base::step_length(robot.lattice(), base::down(robot.lattice())) / 2;
}

bool Scene::has_grid() const {
  if (!robot.has_floor() || plan.first.z < robot.support_z()) {
    return false;
  }
  // Cubes on a floor that a fixed module holds have none.
  const bool may_touch =
      is_general || assessment.stability_rule == verdict::StabilityRule::kContactForces;
  return has_polygon() ||
         (may_touch && std::ranges::any_of(robot.facets(), [&](const model::Facet& facet) {
            return touches_floor(robot, facet);
          }));
}

LatticePoint Scene::floor_point(double x, double y) const {
  const Place origin = base::node_place(robot.lattice(), {0, 0, robot.support_z()});
  const Place right = base::place_of(robot.lattice(), {1, 0, 0});
  const Place back = base::place_of(robot.lattice(), {0, 1, 0});
  return LatticePoint(
      sum({origin[0], origin[1], floor_z()}, sum(scaled(x, right), scaled(y, back))));
}

LatticePoint Scene::facet_centre(std::int32_t module, base::Direction direction) const {
  const base::Cell& cell = robot.modules()[static_cast<std::size_t>(module)].cell;
  return LatticePoint(sum(base::node_place(robot.lattice(), cell),
                          scaled(0.5, base::way_to_neighbour(robot.lattice(), direction))));
}

LatticePoint Scene::on_ground(verdict::PlanPoint point) const {
  const double pitch = robot.material().pitch_mm;
  return {point.x / pitch, point.y / pitch, ground_z()};
}

LatticePoint Scene::centre_of_mass() const {
  double sum_of_moments = 0;
  double sum_of_masses = 0;
  for (std::size_t i = 0; i < robot.modules().size(); ++i) {
    // Of equal masses all sums are whole numbers in a cubic lattice.
    const double mass = robot.is_uniform() ? 1 : robot.mass(i);
    sum_of_moments += mass * base::node_place(robot.lattice(), robot.modules()[i].cell)[2];
    sum_of_masses += mass;
  }
  const auto& [x, y] = assessment.simplified.centre_of_mass;
  const double pitch = robot.material().pitch_mm;
  return {x / pitch, y / pitch, sum_of_moments / sum_of_masses};
}

bool Scene::covers(ScreenPoint point) const {
  if (!bodies) {
    const auto [u, v] = projection.lattice_at(point);
    return (all ? all : existing)->covers(u, v);
  }
  const double x = std::floor((point.x - drawing.left) / kCoveredSquarePx);
  const double y = std::floor((point.y - drawing.top) / kCoveredSquarePx);
  if (x < 0 || y < 0 || x >= static_cast<double>(covered_row_length_)) {
    return false;
  }
  const std::size_t square =
      static_cast<std::size_t>(y) * covered_row_length_ + static_cast<std::size_t>(x);
  return square < covered_.size() && covered_[square];
}

double Scene::covered_share(const Box& box) const {
  constexpr int kColumns = 6;
  constexpr int kRows = 4;
  int covered = 0;
  for (int column = 0; column <= kColumns; ++column) {
    for (int row = 0; row <= kRows; ++row) {
      covered += covers({box.left + (box.right - box.left) * column / kColumns,
                         box.top + (box.bottom - box.top) * row / kRows})
                     ? 1
                     : 0;
    }
  }
  return static_cast<double>(covered) / ((kColumns + 1) * (kRows + 1));
}

}  // namespace holdfast::io
