// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "holdfast/model/step.hpp"
#include "holdfast/plan/robot_state.hpp"

/// Where single modules of a robot can go in one step.
namespace holdfast::plan {

/// All cells between two corners, which belong to it.
struct CellBox {
  base::Cell low;
  base::Cell high;

  bool contains(const base::Cell& cell) const {
    return low.x <= cell.x && cell.x <= high.x && low.y <= cell.y && cell.y <= high.y &&
           low.z <= cell.z && cell.z <= high.z;
  }
};

/// What bars a module's way besides modules and obstacles.
struct MoveRule {
  /// Cubes that turn about an edge of a neighbour instead of sliding along it, and so need the
  /// cells that they sweep; cubic lattice only. A quarter turn leads to the next cell beside two
  /// modules in a row, half a turn around the corner of one ([Feshbach 2021]).
  bool pivots = false;
  /// No module goes below; none: there is nothing that bars it.
  std::optional<std::int32_t> floor_z = {};
  /// No module leaves it.
  std::optional<CellBox> within = {};
};

/// The modules without which all others are still one piece, and which are not fixed: indices,
/// ascending. By lowest points of a depth-first search [Tarjan 1972].
std::vector<std::int32_t> loose_modules(const RobotState& robot);

/// Every move of one module that find_transition() takes and the rule allows, slides first. A
/// carrier is named only where there is more than one way around a corner.
std::vector<model::Move> moves_of(const RobotState& robot, std::int32_t module,
                                  const MoveRule& rule);

}  // namespace holdfast::plan
