// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "module_shape.hpp"
#include "obstacle_cells.hpp"
#include "svg_text.hpp"

/// A robot as bodies that are drawn one over the other, from back to front: every lattice, and
/// cubes among obstacles. Exact, by module_shape.hpp; costs a polygon or more for each body that
/// may be seen.
namespace holdfast::io {

/// A face, or the outline of a whole body, as it is seen of a body at (0, 0); unit: one edge.
struct SeenFace {
  Place normal{};
  std::vector<ScreenPoint> corners;
  std::optional<base::Direction> direction;
};

/// What the eye sees of a body that has no neighbours; nothing of a ball, which is a circle of
/// kBallRadius.
std::vector<SeenFace> seen_faces(const base::Lattice& lattice);

/// The same of the cell of an obstacle.
std::vector<SeenFace> seen_cell_faces(const base::Lattice& lattice);

/// Something that is drawn, and may be seen.
struct BodyItem {
  double nearness = 0;
  std::uint32_t index = 0;  ///< Of a module, or of an obstacle cell.
  bool is_obstacle = false;
  std::uint16_t hidden_faces = 0;  ///< A bit for each seen face that a neighbour covers.
};

class BodyView {
 public:
  /// Keeps a reference to the robot.
  BodyView(const model::Robot& robot, NearObstacles obstacles);

  const NearObstacles& obstacles() const { return obstacles_; }

  /// Back to front.
  std::span<const BodyItem> items() const { return items_; }

  base::Cell cell_of(const BodyItem& item) const;

  /// Where the node of an item is, in pitches.
  Place place_of(const BodyItem& item) const;

  Body body() const { return body_; }

  /// Of a module, and of an obstacle cell, without neighbours.
  std::span<const SeenFace> module_faces() const { return module_faces_; }

  std::span<const SeenFace> obstacle_faces() const { return obstacle_faces_; }

 private:
  void add_modules();
  void add_obstacles();
  std::uint16_t faces_hidden_by_neighbours(std::size_t module) const;

  const model::Robot& robot_;
  NearObstacles obstacles_;
  Body body_;
  std::vector<SeenFace> module_faces_;
  std::vector<SeenFace> obstacle_faces_;
  std::vector<BodyItem> items_;
};

}  // namespace holdfast::io
