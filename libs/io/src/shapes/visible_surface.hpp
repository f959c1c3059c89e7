// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "holdfast/model/robot.hpp"

/// Finds what of a robot can be seen in isometric view, exactly and without painting over anything.
///
/// Seen along (-1, 1, -1), the corners of all cubes fall on the points of one triangular lattice,
///   u = x + y (to the right),   v = x - y - 2 z (down),   x, y, z in cells from the lowest corner,
/// and every face covers exactly two of its triangles: a ray of sight meets whole triangles only.
/// So the nearest face over each triangle is all there is to see. A ray goes from cell to cell with
/// one step in x, -y or z, so depth = x - y + z orders the cells along it strictly.
/// Triangle (u, m) lies between the columns u and u + 1 and has the middle of its upright side at
/// height m; this side is the left one if m - u is odd, the right one if it is even.
namespace holdfast::io {

/// A lattice point of the picture.
struct Vertex {
  std::int32_t u = 0;
  std::int32_t v = 0;

  friend constexpr auto operator<=>(const Vertex&, const Vertex&) = default;
};

/// The faces that can be seen: +z, -y and +x.
enum class Side : std::uint8_t { kTop, kLeft, kRight };

/// A triangle and the nearest face over it.
struct Triangle {
  std::int32_t u = 0;
  std::int32_t middle = 0;
  std::int32_t depth = 0;
  std::uint32_t module = 0;
  Side side = Side::kTop;
};

/// A face, or the visible half of one: a polygon of four or three corners.
struct VisibleFace {
  std::uint32_t module = 0;
  Side side = Side::kTop;
  std::array<Vertex, 4> corners{};
  std::size_t corner_count = 0;
};

struct VisibleEdge {
  Vertex from;
  Vertex to;
  bool is_outline = false;  ///< Behind it lies something further away, or nothing.
  bool is_planned = false;  ///< Of a planned module.
  /// The side on which the robot continues further away: 1 right of or below the edge, -1 left of
  /// or above it, 0 neither.
  std::int8_t far_side = 0;
};

/// The modules whose faces are looked for. Planned modules are drawn as glass, so there are two
/// pictures.
enum class Cast : std::uint8_t { kExisting, kAll };

class VisibleSurface {
 public:
  /// Keeps a reference to the robot; O(n log n) for n modules.
  VisibleSurface(const model::Robot& robot, Cast cast);

  /// The visible triangles, sorted by u and middle, each once.
  std::span<const Triangle> triangles() const { return triangles_; }

  /// Whether something is drawn over this point of the picture.
  bool covers(double u, double v) const;

  /// The visible faces, by module, then by side.
  std::vector<VisibleFace> faces() const;

  /// The visible edges, each once; those of existing modules are joined into long lines, those of
  /// planned modules are single cube edges, so that dashes meet in the corners.
  std::vector<VisibleEdge> edges() const;

 private:
  const Triangle* find(std::int32_t u, std::int32_t middle) const;
  std::int32_t nearness(const Triangle& triangle, Vertex point) const;
  void add_edge(const Triangle& triangle, const Triangle* other, Vertex from, Vertex to,
                std::vector<VisibleEdge>& edges) const;

  const model::Robot& robot_;
  base::Cell lowest_;
  std::vector<std::int32_t> bodies_;  ///< By module; see Robot::bodies().
  std::vector<Triangle> triangles_;
};

/// The smallest coordinates among all modules, the origin of the picture's lattice.
base::Cell lowest_cell(const model::Robot& robot);

}  // namespace holdfast::io
