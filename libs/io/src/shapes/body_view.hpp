// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "obstacle_cells.hpp"
#include "shapes/view_axes.hpp"

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

/// The faces that the eye sees of a body without neighbours; none of a ball, which is a circle of
/// kBallRadius.
std::vector<SeenFace> seen_faces(const base::Lattice& lattice, const ViewAxes& axes);

/// The visible faces of an obstacle's cell without neighbours.
std::vector<SeenFace> seen_cell_faces(const base::Lattice& lattice, const ViewAxes& axes);

/// Obstacles are glass. Those that hide nothing of the robot, and those of which it hides nothing,
/// are drawn as one pane each; only those among its modules come in between.
enum class Layer : std::uint8_t { kBehind, kAmong, kInFront };

/// Something that is drawn, and may be seen.
struct BodyItem {
  Layer layer = Layer::kAmong;
  double nearness = 0;
  std::uint32_t index = 0;  ///< Of a module, or of an obstacle cell.
  bool is_obstacle = false;
  std::uint16_t hidden_faces = 0;  ///< A bit for each seen face that a neighbour covers.
};

class BodyView {
 public:
  /// Keeps a reference to the robot.
  BodyView(const model::Robot& robot, NearObstacles obstacles, const ViewAxes& axes = {});

  const NearObstacles& obstacles() const { return obstacles_; }

  /// All items from back to front: obstacles behind, then what is among the modules, then obstacles
  /// in front.
  std::span<const BodyItem> items() const { return items_; }

  base::Cell cell_of(const BodyItem& item) const;

  /// The place of an item's node, in pitches.
  Place place_of(const BodyItem& item) const;

  Body body() const { return body_; }

  /// The visible faces of a module without neighbours.
  std::span<const SeenFace> module_faces() const { return module_faces_; }

  std::span<const SeenFace> obstacle_faces() const { return obstacle_faces_; }

 private:
  void add_modules();
  void add_obstacles();
  void sort_obstacles_into_layers();
  std::uint16_t faces_hidden_by_neighbours(std::size_t module) const;

  const model::Robot& robot_;
  NearObstacles obstacles_;
  ViewAxes axes_;
  Body body_;
  std::vector<SeenFace> module_faces_;
  std::vector<SeenFace> obstacle_faces_;
  std::vector<BodyItem> items_;
};

}  // namespace holdfast::io
