// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "svg_layout.hpp"

#include <algorithm>
#include <limits>

namespace holdfast::io {
namespace {

constexpr double kCos30 = 0.8660254037844386;

constexpr double kEdgePxMax = 54;
constexpr double kCardWidthMin = 800;
constexpr double kCardWidthMax = 1040;
constexpr double kDrawingHeightMin = 190;
constexpr double kDrawingHeightMax = 760;
/// Room around the robot for marks, labels and the numbers along the grid.
constexpr double kPaddingX = 64;
constexpr double kPaddingY = 46;

/// An extent on the picture's lattice.
struct Extent {
  double u_min = std::numeric_limits<double>::infinity();
  double u_max = -std::numeric_limits<double>::infinity();
  double v_min = std::numeric_limits<double>::infinity();
  double v_max = -std::numeric_limits<double>::infinity();

  void add(double u, double v) {
    u_min = std::min(u_min, u);
    u_max = std::max(u_max, u);
    v_min = std::min(v_min, v);
    v_max = std::max(v_max, v);
  }
};

std::pair<double, double> lattice_of(const base::Cell& lowest, LatticePoint point) {
  // The corner with the smallest coordinates of the lowest cell is the origin.
  const double x = point.x - lowest.x + 0.5;
  const double y = point.y - lowest.y + 0.5;
  const double z = point.z - lowest.z + 0.5;
  return {x + y, x - y - 2 * z};
}

PlanRange plan_range(const model::Robot& robot) {
  PlanRange range{robot.modules().front().cell, robot.modules().front().cell};
  for (const model::Module& module : robot.modules()) {
    range.first.x = std::min(range.first.x, module.cell.x);
    range.first.y = std::min(range.first.y, module.cell.y);
    range.last.x = std::max(range.last.x, module.cell.x);
    range.last.y = std::max(range.last.y, module.cell.y);
  }
  return range;
}

Extent extent_of(const Scene& scene) {
  Extent extent;
  const auto add_point = [&](LatticePoint point) {
    const auto [u, v] = lattice_of(scene.projection.lowest, point);
    extent.add(u, v);
  };
  const VisibleSurface& surface = scene.all ? *scene.all : scene.existing;
  for (const Triangle& triangle : surface.triangles()) {
    extent.add(triangle.u, triangle.middle - 1);
    extent.add(triangle.u + 1, triangle.middle + 1);
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
        add_point({x, y, scene.ground_z()});
      }
    }
  }
  return extent;
}

/// As large as fits, in the middle of the drawing.
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

}  // namespace

ScreenPoint Projection::at(double u, double v) const {
  return origin_px + ScreenPoint{u * kCos30 * edge_px, v / 2 * edge_px};
}

ScreenPoint Projection::at(Vertex vertex) const {
  return at(static_cast<double>(vertex.u), static_cast<double>(vertex.v));
}

ScreenPoint Projection::at(LatticePoint point) const {
  const auto [u, v] = lattice_of(lowest, point);
  return at(u, v);
}

std::pair<double, double> Projection::lattice_at(ScreenPoint point) const {
  const ScreenPoint offset = point - origin_px;
  return {offset.x / (kCos30 * edge_px), offset.y * 2 / edge_px};
}

Scene::Scene(const model::Robot& a_robot, const verdict::Assessment& an_assessment)
    : robot(a_robot),
      assessment(an_assessment),
      paints(paint_modules(robot, assessment)),
      existing(robot, Cast::kExisting),
      plan(plan_range(robot)) {
  if (robot.planned_count() > 0) {
    all.emplace(robot, Cast::kAll);
  }
  projection.lowest = lowest_cell(robot);
  lay_out(*this);
}

LatticePoint Scene::on_ground(verdict::PlanPoint point) const {
  const double pitch = robot.material().pitch_mm;
  return {point.x / pitch, point.y / pitch, ground_z()};
}

LatticePoint Scene::centre_of_mass() const {
  std::int64_t z_sum = 0;
  for (const model::Module& module : robot.modules()) {
    z_sum += module.cell.z;
  }
  LatticePoint point = on_ground(assessment.simplified.centre_of_mass);
  point.z = static_cast<double>(z_sum) / static_cast<double>(robot.modules().size());
  return point;
}

bool Scene::covers(ScreenPoint point) const {
  const auto [u, v] = projection.lattice_at(point);
  return (all ? *all : existing).covers(u, v);
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
