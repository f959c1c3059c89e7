// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "holdfast/model/robot.hpp"

/// The rigid body on flat ground (Sec. III-B of [Piranda 2021]), decided exactly.
///
/// All modules weigh the same and sit on a lattice, so the centre of mass is a fraction of two
/// integers, and every comparison is one of whole numbers times pitch and facet, exact for the two
/// doubles given: a margin of zero is recognised as zero, whatever the width of the facets.
namespace holdfast::verdict {

/// A point in plan, mm; the centre of cell (0,0) is at the origin.
struct PlanPoint {
  double x = 0;
  double y = 0;
};

struct RigidBody {
  /// More than zero to spare, or held by a fixed module.
  bool is_stable = false;
  /// The smallest signed distance from the centre of mass to the line of an edge of the support
  /// polygon, positive inside: the lever with which the weight holds the robot down, or tips it.
  /// None if a fixed module holds the robot.
  std::optional<double> margin_mm;
  /// The edge over which the robot topples, or would first. The polygon lies on its left. None if a
  /// fixed module holds the robot.
  std::optional<std::array<PlanPoint, 2>> edge;
  PlanPoint centre_of_mass;
  /// Corners of the support polygon, counter-clockwise.
  std::vector<PlanPoint> polygon;
};

RigidBody assess_rigid_body(const model::Robot& robot);

}  // namespace holdfast::verdict
