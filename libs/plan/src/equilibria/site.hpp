// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include "holdfast/base/cell.hpp"
#include "holdfast/base/lattice.hpp"
#include "holdfast/model/cell_index.hpp"
#include "holdfast/model/environment.hpp"
#include "holdfast/model/robot.hpp"

namespace holdfast::plan {

/// A neighbour of a new module, and the direction from it to the new one.
struct Link {
  std::size_t host = 0;
  base::Direction direction = base::Direction::kPlusX;
  std::size_t to = 0;  ///< Which of the new modules, where there are several.
};

/// What a module in a cell would touch.
struct Site {
  enum class Kind : std::uint8_t {
    kOpen,  ///< A module can be there.
    kImpossible,
    kUnknown,  ///< Only Robot::create() knows, or what follows needs a check.
  };

  base::Cell cell;
  Kind kind = Kind::kUnknown;
  std::vector<Link> links = {};
  bool is_on_floor = false;
};

/// Finds out what modules in cells would touch. Keeps references to both.
class SiteFinder {
 public:
  SiteFinder(const model::Robot& robot, const model::RobotSpec& spec);

  Site find(const base::Cell& cell) const;

  /// Whether the robot stands on a level plane, so that the support polygon decides.
  bool has_polygon() const { return has_polygon_; }

 private:
  bool touches_obstacle(const base::Cell& cell) const;
  bool is_polygon_kept_by(const Site& site) const;

  const model::Robot& robot_;
  const model::RobotSpec& spec_;
  model::CellIndex index_;
  model::ObstacleIndex obstacles_;
  bool has_polygon_ = false;
  model::FloorRule floor_rule_;
};

}  // namespace holdfast::plan
