// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "holdfast/model/robot.hpp"

namespace holdfast::io {

/// A cell that the environment occupies.
struct ObstacleCell {
  base::Cell cell;
  bool is_bonded = false;
};

/// More obstacle cells than this are not drawn.
inline constexpr std::size_t kObstacleCellsMax = 100'000;

/// The obstacle cells that belong into a picture: those that facets touch; of an obstacle that is
/// touched, those at most two cells from there along each coordinate; of any other, those at most
/// one cell from the box around the robot.
struct NearObstacles {
  std::vector<ObstacleCell> cells;  ///< Each once.
  bool are_too_many = false;        ///< More than kObstacleCellsMax: `cells` is empty.
};

NearObstacles obstacles_near(const model::Robot& robot, std::span<const model::Obstacle> obstacles);

/// Whether a facet touches the floor, not an obstacle.
bool touches_floor(const model::Robot& robot, const model::Facet& facet);

}  // namespace holdfast::io
