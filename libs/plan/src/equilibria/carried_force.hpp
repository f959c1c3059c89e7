// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

#include "holdfast/base/lattice.hpp"
#include "holdfast/model/connector_law.hpp"
#include "holdfast/model/lattice_beam.hpp"
#include "holdfast/model/material.hpp"
#include "holdfast/model/robot.hpp"

/// Forces that are carried through a robot from module to module.
namespace holdfast::plan {

inline std::array<double, 3> cross(const double* a, const double* b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

/// What a force and a torque at one place are at another, which lies at `to` relative to it; only
/// the first three numbers of `to` are looked at.
inline base::Vec6<double> force_at(const base::Vec6<double>& force, const base::Vec6<double>& to) {
  const auto moment = cross(to.data(), force.data());
  base::Vec6<double> moved = force;
  for (std::size_t i = 0; i < 3; ++i) {
    moved[i + 3] -= moment[i];
  }
  return moved;
}

/// Where a module's node is, in mm; the last three are 0.
inline base::Vec6<double> node_place(const model::Robot& robot, std::size_t module) {
  const auto place = base::place_of(robot.lattice(),
                                    base::axial_of(robot.lattice(), robot.modules()[module].cell));
  const double pitch = robot.material().pitch_mm;
  return {pitch * place[0], pitch * place[1], pitch * place[2], 0, 0, 0};
}

/// A module's own load, about the origin; `place` is that of its node.
inline base::Vec6<double> load_about_origin(const model::Robot& robot, std::size_t module,
                                            const base::Vec6<double>& place) {
  return force_at(robot.loads()[module], {-place[0], -place[1], -place[2], 0, 0, 0});
}

/// A force at a module's node, in the middle of its beam or facet in a direction, local frame.
inline base::Vec6<double> force_in_middle(const model::LatticeBeam<double>& beam,
                                          base::Direction direction,
                                          const base::Vec6<double>& at_node, double pitch_mm) {
  base::Vec6<double> force = beam.to_local(direction, at_node);
  force[3] -= force[1] * pitch_mm / 2;
  force[4] += force[0] * pitch_mm / 2;
  return force;
}

/// What the six springs in the middle of a beam are stiff by, which know nothing of each other; all
/// beams are the same, as needs_own_solution() says of others.
inline base::Vec6<double> middle_stiffness(const model::LatticeBeam<double>& beam) {
  const auto& k = beam.stiffness(base::Direction::kPlusX);
  return {k.shear_x, k.shear_y, k.axial, k.bend_y / 4, k.bend_x / 4, k.twist};
}

/// The load ratio of a force in the middle of the beam between two modules; `direction` from a.
inline double connection_ratio(const model::Robot& robot, std::size_t a, std::size_t b,
                               int direction, const base::Vec6<double>& force) {
  const bool is_first = direction % 2 == 0;
  const model::Connection pair = {
      .a = static_cast<std::int32_t>(is_first ? a : b),
      .b = static_cast<std::int32_t>(is_first ? b : a),
      .direction = static_cast<base::Direction>(is_first ? direction : direction ^ 1)};
  const auto ratios = model::limit_ratios(robot.connector(pair), force);
  return *std::ranges::max_element(ratios);
}

}  // namespace holdfast::plan
