// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "holdfast/large/follow.hpp"

/// Contacts that begin as a robot bends: of modules with the floor, and with each other.
namespace holdfast::large {

/// The smallest distance, mm, negative where bodies overlap, and between what.
struct Gap {
  double mm = 0;
  std::vector<std::size_t> modules = {};  ///< Indices: one and the floor, or two.
};

/// The bodies of a robot's modules, and of obstacles' cells: cubes, spheres, discs or prisms that
/// fill their cells. Keeps references.
class Bodies {
 public:
  Bodies(const model::Robot& robot, std::span<const model::Obstacle> obstacles);

  /// The distance of the lowest point above the floor, of the modules that are above its layer at
  /// rest; infinite without a floor or such modules.
  Gap above_floor(std::span<const mechanics::Pose> poses) const;

  /// The least distance of two modules, or of a module and an obstacle, that do not touch at rest,
  /// as far as one is less than a tenth of the pitch; infinite if none is. Bodies are taken to be
  /// apart where a plane across the line of centres, along a face, or along an edge of both
  /// separates them.
  Gap between_bodies(std::span<const mechanics::Pose> poses) const;

 private:
  using Vector3 = mechanics::Vector3;

  enum class Shape { kCube, kSphere, kDisc, kPrism };

  double half_width(const mechanics::Pose& pose, const Vector3& direction) const;
  double separation(const mechanics::Pose& a, const Vector3& at_a, const mechanics::Pose& b,
                    const Vector3& at_b) const;
  std::vector<Vector3> own_axes(const mechanics::Pose& pose) const;
  base::Cell cell_at(const Vector3& place) const;
  void add_modules(std::span<const mechanics::Pose> poses, std::span<const Vector3> centres,
                   Gap& least) const;
  void add_obstacles(std::span<const mechanics::Pose> poses, std::span<const Vector3> centres,
                     Gap& least) const;
  Vector3 centre(std::size_t module, const mechanics::Pose& pose) const;

  const model::Robot& robot_;
  Shape shape_ = Shape::kCube;
  double pitch_;
  Vector3 sides_{1, 1, 1};  ///< Of the bodies, in pitches.
  double radius_ = 0;       ///< Of the ball around a body, mm.
  std::vector<model::Obstacle> obstacles_;
  model::ObstacleIndex obstacle_index_;
  std::vector<Vector3> places_;  ///< Of the nodes at rest, mm, by module.
};

}  // namespace holdfast::large
