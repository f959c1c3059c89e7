// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>

#include "holdfast/base/result.hpp"
#include "holdfast/plan/robot_state.hpp"
#include "holdfast/plan/stages.hpp"

namespace holdfast {

/// Does one step after another, from a start. Calls `visit(robot, step, transition, index)` before
/// each is done, with the robot as it is then, and ends at the first error, its own or that of a
/// step that cannot be done.
template <class Visit>
std::optional<base::Error> for_each_step(const model::RobotSpec& start,
                                         std::span<const model::Step> steps, const Visit& visit) {
  plan::RobotState robot(start);
  for (std::size_t i = 0; i < steps.size(); ++i) {
    const auto transition = plan::find_transition(robot, steps[i]);
    if (!transition) {
      return transition.error();
    }
    if (auto error = visit(robot, steps[i], transition.value(), i)) {
      return error;
    }
    plan::apply(steps[i], transition.value(), robot);
  }
  return std::nullopt;
}

}  // namespace holdfast
