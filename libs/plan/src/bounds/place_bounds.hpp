// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "holdfast/base/cell.hpp"
#include "holdfast/model/robot.hpp"
#include "holdfast/verdict/assessment.hpp"

namespace holdfast::plan {

/// What is known of a robot with one more module from a solution of the robot without it.
struct PlaceBound {
  /// What the largest load ratio does not exceed, if nothing breaks and all facets are stuck.
  std::optional<double> high = {};
  std::optional<double> low = {};  ///< What it is no less than, if all facets are stuck.

  /// Whether a connection breaks, as certainly as `high` says that none does.
  bool is_overload() const { return low && *low > 1 + 1e-3; }

  bool is_decided() const { return high.has_value() || is_overload(); }

  double shift_mm = 0;  ///< How far bending moves the centre of mass in plan, at most.
};

/// How places are tried.
struct PlaceWish {
  int thread_count = 0;
  /// Whether what energy alone leaves open is tried by displacements that follow the robot
  /// (FollowedRobot), which takes some iterations of multigrid for each place.
  bool follows = false;
  std::function<bool()> is_late;  ///< Nothing more is tried once it says so.
};

/// Bounds the load ratios of a robot with one more module of kind 0 in each of the cells in turn,
/// by an EnergyBound that takes each of them back. Each cell is free, beside a module, and not too
/// low for one. `solved` is the robot's. Nothing is known where an EnergyBound cannot begin.
std::vector<PlaceBound> bound_places(const model::RobotSpec& spec,
                                     const verdict::Assessment& solved,
                                     std::span<const base::Cell> cells, const PlaceWish& wish);

}  // namespace holdfast::plan
