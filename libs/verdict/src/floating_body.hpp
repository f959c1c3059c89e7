// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <vector>

#include "holdfast/verdict/rigid_body.hpp"

namespace holdfast::verdict {

/// What floating_body() needs to know of a robot.
struct FloatingBody {
  double kg = 0;
  /// A node of the robot, that of any module: sums over a thousand modules that are far from where
  /// coordinates begin would else lose what decides.
  std::array<double, 3> origin_mm{};
  std::array<double, 3> moment_kgmm{};  ///< Mass times place from the origin, over all modules.
  bool is_held = false;                 ///< By a fixed module or a bonded facet.
  bool is_flat = false;                 ///< is_on_flat_floor()
  double foot_half_width_mm = 0;
  double tie_mm = 0;                    ///< Less is nothing.
  std::vector<PlanPoint> polygon = {};  ///< Counter-clockwise.
};

FloatingBody body_of(const model::Robot& robot);

/// Adds a module whose node is there.
void add_module(FloatingBody& body, const std::array<double, 3>& node_mm, double mass_kg,
                bool is_on_floor);

/// assess_rigid_body() in double, for any lattice and masses.
RigidBody floating_body(const FloatingBody& body);

}  // namespace holdfast::verdict
