// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "holdfast/model/robot.hpp"
#include "holdfast/plan/element_set.hpp"

namespace holdfast::test {

/// Modules by their distance from the supports, so that each prefix is connected to one.
inline std::vector<plan::Element> nearest_first(const model::Robot& robot) {
  std::vector<plan::Element> order;
  std::vector<bool> is_found(robot.modules().size());
  const auto find = [&](std::size_t module) {
    if (!is_found[module]) {
      is_found[module] = true;
      order.push_back(static_cast<plan::Element>(module));
    }
  };
  for (std::size_t i = 0; i < robot.modules().size(); ++i) {
    if (robot.modules()[i].support != model::Support::kNone) {
      find(i);
    }
  }
  for (std::size_t i = 0; i < order.size(); ++i) {
    for (const std::int32_t other : robot.connected()[base::at(order[i])]) {
      if (other != model::Robot::kNoNeighbour) {
        find(base::at(other));
      }
    }
  }
  return order;
}

}  // namespace holdfast::test
