// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "equilibria/sway.hpp"

namespace holdfast::plan {

Sway::Sway(const model::Robot& robot, const solver::Influence& influence) {
  std::vector<solver::LaneBlock> pulls(influence.slot_count());
  const auto& displacement = influence.displacement();
  for (std::size_t module = 0; module < displacement.size(); ++module) {
    const double mass = robot.mass(module);
    for (std::size_t axis = 0; axis < 2; ++axis) {
      pulls[influence.slot(module)].values[axis][axis] += mass;
    }
    alone_.add(mass, displacement[module][0], displacement[module][1]);
  }
  influence.solve(pulls);
  by_load_.resize(displacement.size());
  for (std::size_t module = 0; module < displacement.size(); ++module) {
    for (std::size_t axis = 0; axis < 2; ++axis) {
      for (std::size_t k = 0; k < 6; ++k) {
        by_load_[module][axis][k] = pulls[influence.slot(module)].values[k][axis];
      }
    }
  }
}

verdict::MovedMass Sway::moved(std::span<const PointLoad> more) const {
  verdict::MovedMass moved = alone_;
  for (const PointLoad& point : more) {
    moved.x_kg_mm += base::dot(by_load_[point.module][0], point.load);
    moved.y_kg_mm += base::dot(by_load_[point.module][1], point.load);
  }
  return moved;
}

}  // namespace holdfast::plan
