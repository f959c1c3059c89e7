// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "shapes/visible_surface.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>

namespace holdfast::io {
namespace {

constexpr std::array kSides = {Side::kTop, Side::kLeft, Side::kRight};

constexpr base::Direction direction_of(Side side) {
  switch (side) {
    case Side::kTop:
      return base::Direction::kPlusZ;
    case Side::kLeft:
      return base::Direction::kMinusY;
    case Side::kRight:
      break;
  }
  return base::Direction::kPlusX;
}

/// The corner of a cube that is nearest to the eye.
Vertex near_corner(base::Cell cell) {
  return {.u = cell.x + cell.y + 1, .v = cell.x - cell.y - 2 * cell.z - 1};
}

/// The two triangles (u, middle) of a face, given the near corner of its cube.
std::array<Vertex, 2> face_triangles(Side side, Vertex corner) {
  const auto [u, v] = corner;
  switch (side) {
    case Side::kTop:
      return {{{u - 1, v - 1}, {u, v - 1}}};
    case Side::kLeft:
      return {{{u - 1, v}, {u - 1, v + 1}}};
    case Side::kRight:
      break;
  }
  return {{{u, v}, {u, v + 1}}};
}

std::array<Vertex, 4> face_corners(Side side, Vertex corner) {
  const auto [u, v] = corner;
  switch (side) {
    case Side::kTop:
      return {{{u, v}, {u + 1, v - 1}, {u, v - 2}, {u - 1, v - 1}}};
    case Side::kLeft:
      return {{{u, v}, {u - 1, v - 1}, {u - 1, v + 1}, {u, v + 2}}};
    case Side::kRight:
      break;
  }
  return {{{u, v}, {u, v + 2}, {u + 1, v + 1}, {u + 1, v - 1}}};
}

bool is_left_based(std::int32_t u, std::int32_t middle) { return (middle - u) % 2 != 0; }

std::array<Vertex, 3> triangle_corners(std::int32_t u, std::int32_t middle) {
  if (is_left_based(u, middle)) {
    return {{{u, middle - 1}, {u + 1, middle}, {u, middle + 1}}};
  }
  return {{{u + 1, middle - 1}, {u + 1, middle + 1}, {u, middle}}};
}

base::Cell difference(base::Cell a, base::Cell b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }

/// Edges on one straight line have equal keys but for the last entry, where they begin.
auto line_key(const VisibleEdge& edge) {
  const std::int32_t slope = edge.to.v - edge.from.v;  // 2, 1 or -1
  const std::int32_t line = slope == 2   ? edge.from.u
                            : slope == 1 ? edge.from.v - edge.from.u
                                         : edge.from.v + edge.from.u;
  const std::int32_t begin = slope == 2 ? edge.from.v : edge.from.u;
  return std::tuple(edge.is_planned, edge.is_outline, edge.far_side, slope, line, begin);
}

/// Joins edges that continue one another; planned ones stay single.
std::vector<VisibleEdge> join(std::vector<VisibleEdge> edges) {
  std::ranges::sort(edges, {}, line_key);
  std::vector<VisibleEdge> joined;
  std::int32_t last_slope = 0;
  for (const VisibleEdge& edge : edges) {
    const std::int32_t slope = edge.to.v - edge.from.v;
    if (!joined.empty() && !edge.is_planned && joined.back().to == edge.from &&
        last_slope == slope && joined.back().is_outline == edge.is_outline &&
        joined.back().far_side == edge.far_side) {
      joined.back().to = edge.to;
    } else {
      joined.push_back(edge);
    }
    last_slope = slope;
  }
  return joined;
}

}  // namespace

base::Cell lowest_cell(const model::Robot& robot) {
  base::Cell lowest = robot.modules().front().cell;
  for (const model::Module& module : robot.modules()) {
    lowest.x = std::min(lowest.x, module.cell.x);
    lowest.y = std::min(lowest.y, module.cell.y);
    lowest.z = std::min(lowest.z, module.cell.z);
  }
  return lowest;
}

VisibleSurface::VisibleSurface(const model::Robot& robot, Cast cast)
    : robot_(robot), lowest_(lowest_cell(robot)), bodies_(robot.bodies()) {
  const auto modules = robot.modules();
  // Existing modules come first.
  const std::size_t count =
      cast == Cast::kAll ? modules.size() : modules.size() - robot.planned_count();
  for (std::size_t i = 0; i < count; ++i) {
    const base::Cell cell = difference(modules[i].cell, lowest_);
    for (const Side side : kSides) {
      const std::int32_t neighbour =
          robot.neighbours()[i][static_cast<std::size_t>(base::index(direction_of(side)))];
      if (neighbour != model::Robot::kNoNeighbour && static_cast<std::size_t>(neighbour) < count) {
        continue;
      }
      for (const auto& [u, middle] : face_triangles(side, near_corner(cell))) {
        triangles_.push_back({.u = u,
                              .middle = middle,
                              .depth = cell.x - cell.y + cell.z,
                              .module = static_cast<std::uint32_t>(i),
                              .side = side});
      }
    }
  }
  std::ranges::sort(triangles_, {}, [](const Triangle& triangle) {
    return std::tuple(triangle.u, triangle.middle, -triangle.depth);
  });
  // std::ranges::unique does not compile with clang 14 and libstdc++ 12.
  const auto hidden = std::unique(
      triangles_.begin(), triangles_.end(),
      [](const Triangle& a, const Triangle& b) { return a.u == b.u && a.middle == b.middle; });
  triangles_.erase(hidden, triangles_.end());
}

const Triangle* VisibleSurface::find(std::int32_t u, std::int32_t middle) const {
  const auto found = std::ranges::lower_bound(
      triangles_, std::pair(u, middle), {},
      [](const Triangle& triangle) { return std::pair(triangle.u, triangle.middle); });
  const bool is_there = found != triangles_.end() && found->u == u && found->middle == middle;
  return is_there ? &*found : nullptr;
}

bool VisibleSurface::covers(double u, double v) const {
  constexpr double kFarthest = 1e8;  // No module is, and a place still is a whole number.
  if (!(std::abs(u) < kFarthest && std::abs(v) < kFarthest)) {
    return false;
  }
  const double column = std::floor(u);
  const double share = u - column;
  const auto column_index = static_cast<std::int32_t>(column);
  // At `share` of the way to the right, left-based triangles have narrowed to 1 - share.
  const double odd = 2 * std::floor((v - column - 1) / 2 + 0.5) + column + 1;
  if (std::abs(v - odd) <= 1 - share) {
    return find(column_index, static_cast<std::int32_t>(odd)) != nullptr;
  }
  const double even = 2 * std::floor((v - column) / 2 + 0.5) + column;
  return find(column_index, static_cast<std::int32_t>(even)) != nullptr;
}

std::vector<VisibleFace> VisibleSurface::faces() const {
  std::vector<Triangle> by_face = triangles_;
  std::ranges::sort(by_face, {}, [](const Triangle& triangle) {
    return std::tuple(triangle.module, triangle.side, triangle.u, triangle.middle);
  });
  std::vector<VisibleFace> faces;
  for (std::size_t i = 0; i < by_face.size(); ++i) {
    const Triangle& half = by_face[i];
    VisibleFace face{.module = half.module, .side = half.side};
    const bool is_whole = i + 1 < by_face.size() && by_face[i + 1].module == half.module &&
                          by_face[i + 1].side == half.side;
    if (is_whole) {
      const base::Cell cell = difference(robot_.modules()[half.module].cell, lowest_);
      face.corners = face_corners(half.side, near_corner(cell));
      face.corner_count = 4;
      ++i;
    } else {
      std::ranges::copy(triangle_corners(half.u, half.middle), face.corners.begin());
      face.corner_count = 3;
    }
    faces.push_back(face);
  }
  return faces;
}

/// x - y + z of the point of the face's plane that is seen at a lattice point; larger is nearer.
/// From u = x + y, v = x - y - 2 z and one of z, y, x being fixed by the plane. Doubled, as it is a
/// half where the plane passes between corners.
std::int32_t VisibleSurface::nearness(const Triangle& triangle, Vertex point) const {
  const base::Cell cell = difference(robot_.modules()[triangle.module].cell, lowest_);
  switch (triangle.side) {
    case Side::kTop:
      return 2 * (point.v + 3 * (cell.z + 1));
    case Side::kLeft:
      return 3 * point.u - 6 * cell.y - point.v;
    case Side::kRight:
      break;
  }
  return 6 * (cell.x + 1) - 3 * point.u - point.v;
}

void VisibleSurface::add_edge(const Triangle& triangle, const Triangle* other, Vertex from,
                              Vertex to, std::vector<VisibleEdge>& edges) const {
  const auto is_planned = [&](const Triangle& one) {
    return robot_.modules()[one.module].is_planned;
  };
  VisibleEdge edge{.from = from, .to = to, .is_outline = true, .is_planned = is_planned(triangle)};
  if (other != nullptr) {
    if (other->module == triangle.module && other->side == triangle.side) {
      return;
    }
    const std::int32_t step_from = nearness(triangle, from) - nearness(*other, from);
    const std::int32_t step_to = nearness(triangle, to) - nearness(*other, to);
    edge.is_outline = step_from != 0 || step_to != 0;
    const std::int32_t body = bodies_[triangle.module];
    if (!edge.is_outline && other->side == triangle.side && body == bodies_[other->module] &&
        body != model::OwnConnector::kNoBody) {
      return;  // No seam inside a body.
    }
    if (!edge.is_outline) {
      edge.is_planned = edge.is_planned || is_planned(*other);
    } else {
      // `other` lies left of or above `triangle`.
      const bool is_other_far = step_from + step_to > 0;
      edge.far_side = is_other_far ? -1 : 1;
      edge.is_planned = is_planned(is_other_far ? triangle : *other);
    }
  }
  edges.push_back(edge);
}

std::vector<VisibleEdge> VisibleSurface::edges() const {
  std::vector<VisibleEdge> edges;
  for (const Triangle& triangle : triangles_) {
    const std::int32_t u = triangle.u;
    const std::int32_t m = triangle.middle;
    const bool is_left = is_left_based(u, m);
    // Every triangle has its upper edge and, on the left, an upright one; the others only where no
    // neighbour has them.
    const Vertex tip = is_left ? Vertex{u + 1, m} : Vertex{u, m};
    const auto slanted = [&](std::int32_t v) {
      return is_left ? std::pair(Vertex{u, v}, tip) : std::pair(tip, Vertex{u + 1, v});
    };
    const auto [above_from, above_to] = slanted(m - 1);
    add_edge(triangle, find(u, m - 1), above_from, above_to, edges);
    if (find(u, m + 1) == nullptr) {
      const auto [below_from, below_to] = slanted(m + 1);
      add_edge(triangle, nullptr, below_from, below_to, edges);
    }
    const std::int32_t column = is_left ? u : u + 1;
    const Triangle* beside = find(is_left ? u - 1 : u + 1, m);
    if (is_left || beside == nullptr) {
      add_edge(triangle, beside, {column, m - 1}, {column, m + 1}, edges);
    }
  }
  return join(std::move(edges));
}

}  // namespace holdfast::io
