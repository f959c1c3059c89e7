// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "holdfast/steps.hpp"

namespace holdfast::web {

/// A sequence whose steps can be done, to be looked at stage by stage.
class SequenceView {
 public:
  explicit SequenceView(io::Sequence sequence);

  /// Returns what the page draws of each step: how many cells it attaches and detaches, how many
  /// groups move; x, y, z of these cells; the number of modules and of waypoints of each group,
  /// then x, y, z of each of its modules before and after, then plan::Group::way, all waypoints.
  std::vector<std::int32_t> transitions() const;

  /// The first scene of a stage at a waypoint, which is void but in the shift.
  base::Result<plan::Scene> scene(std::size_t step, plan::Stage stage, std::size_t waypoint);

 private:
  void go_to(std::size_t step);

  io::Sequence sequence_;
  std::size_t step_ = 0;
  plan::RobotState robot_;  ///< Before that step.
};

}  // namespace holdfast::web
