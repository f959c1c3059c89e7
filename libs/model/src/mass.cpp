// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "holdfast/model/mass.hpp"

#include <limits>

namespace holdfast::model {

std::array<double, 3> common_node_mm(const Robot& robot) {
  const base::NodePlaces node_mm(robot.lattice(), robot.material().pitch_mm);
  std::array<double, 3> node{};
  node.fill(-std::numeric_limits<double>::infinity());
  if (!robot.modules().empty()) {
    node = node_mm(robot.modules().front().cell);
  }
  for (double& x : node) {
    x = host::max(robot.ranks(), x);
  }
  return node;
}

Mass mass_of(const Robot& robot) {
  const base::NodePlaces node_mm(robot.lattice(), robot.material().pitch_mm);
  const std::array<double, 3> origin = common_node_mm(robot);
  Mass mass;
  for (std::size_t i = 0; i < robot.own_count(); ++i) {
    const auto node = node_mm(robot.modules()[i].cell);
    for (std::size_t k = 0; k < 3; ++k) {
      mass.centre_mm[k] += robot.mass(i) * (node[k] - origin[k]);
    }
    mass.kg += robot.mass(i);
  }
  for (const CarriedMass& carried : robot.carried()) {
    const auto node = node_mm(carried.carrier);
    for (std::size_t k = 0; k < 3; ++k) {
      mass.centre_mm[k] += carried.mass_kg * (node[k] - origin[k] + carried.offset_mm[k]);
    }
    mass.kg += carried.mass_kg;
  }
  mass.kg = host::sum(robot.ranks(), mass.kg);
  for (std::size_t k = 0; k < 3; ++k) {
    mass.centre_mm[k] = origin[k] + host::sum(robot.ranks(), mass.centre_mm[k]) / mass.kg;
  }
  return mass;
}

}  // namespace holdfast::model
