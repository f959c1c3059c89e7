// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "holdfast/model/robot.hpp"

/// The rigid body on flat ground (Sec. III-B of [Piranda 2021]), decided exactly for cubes.
///
/// Cubes that weigh the same sit on a lattice, so the centre of mass is a fraction of two
/// integers, and every comparison is one of whole numbers times pitch and facet, exact for the two
/// doubles given: a margin of zero is recognised as zero, whatever the width of the facets. Other
/// lattices and masses are computed in double, and a margin below kMarginTie pitches is zero.
namespace holdfast::verdict {

/// A point in plan, mm; the centre of cell (0,0) is at the origin.
struct PlanPoint {
  double x = 0;
  double y = 0;
};

struct RigidBody {
  /// Whether there is more than zero to spare, or a fixed module or a bonded facet holds the robot.
  bool is_stable = false;
  /// The smallest signed distance from the centre of mass to the line of an edge of the support
  /// polygon, positive inside: the lever with which the weight holds the robot down, or tips it.
  /// None if the robot is held, or the polygon does not decide.
  std::optional<double> margin_mm;
  /// The edge over which the robot topples, or would first. The polygon lies on its left. None
  /// without a margin.
  std::optional<std::array<PlanPoint, 2>> edge;
  PlanPoint centre_of_mass;
  /// Corners of the support polygon, counter-clockwise.
  std::vector<PlanPoint> polygon;
};

/// The share of a pitch below which a margin that was computed in double counts as zero.
inline constexpr double kMarginTie = 1e-9;

/// Whether all facets lie in one level plane and can lift, and only weight acts, straight down:
/// then the support polygon decides.
bool is_on_flat_floor(const model::Robot& robot);

/// Assesses the rigid body: for a robot that is_on_flat_floor() all of it; for any other only the
/// centre of mass, no polygon and no margin, and `is_stable` if something holds it fast.
RigidBody assess_rigid_body(const model::Robot& robot);

/// Finds what assess_rigid_body() says of a robot with one more module, again and again, without
/// looking at the robot again: to the same digits if its mass is exact, else but for rounding. It
/// serves robots without facets or on a flat floor.
class GrowingRigidBody {
 public:
  /// The new module weighs `mass_kg`.
  GrowingRigidBody(const model::Robot& robot, double mass_kg);
  ~GrowingRigidBody();

  /// The body with one more module in a cell, which rests on the floor with its lower side or does
  /// not.
  RigidBody with(const base::Cell& cell, bool is_on_floor) const;

 private:
  struct Exact;
  struct Floating;

  // One of the two.
  std::unique_ptr<const Exact> exact_;
  std::unique_ptr<const Floating> floating_;
};

/// Finds the margin of a robot on a flat floor without one of its modules, or without some of its
/// facets, again and again. Keeps a reference. Several threads may call.
class ShrinkingRigidBody {
 public:
  /// The support polygon decides about the robot, which carries nothing besides its modules.
  explicit ShrinkingRigidBody(const model::Robot& robot);
  ~ShrinkingRigidBody();

  /// The margin in mm, as of RigidBody, less what rounding may do to it. None if no facet is left.
  /// `facets` are all those that are lost, by index, the lost module's among them.
  std::optional<double> margin_mm_without(std::optional<std::size_t> module,
                                          std::span<const std::size_t> facets) const;

 private:
  struct Whole;

  std::unique_ptr<const Whole> whole_;
};

}  // namespace holdfast::verdict
