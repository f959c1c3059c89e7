// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "holdfast/verdict/assessment.hpp"

namespace holdfast::io {

/// A robot and its assessment, for reports of them.
struct CheckedRobot {
  model::Robot robot;
  verdict::Assessment assessment;

  explicit CheckedRobot(const model::RobotSpec& spec)
      : robot(model::Robot::create(spec).value()), assessment(verdict::assess(robot)) {}
};

/// Twenty-five modules hanging from a fixed one: five connections carry more than Fmax.
inline model::RobotSpec long_chain() {
  model::RobotSpec spec{.existing = {{0, 0, 50}}, .fixed = {{0, 0, 50}}};
  for (int i = 1; i <= 25; ++i) {
    spec.existing.push_back({0, 0, 50 - i});
  }
  return spec;
}

}  // namespace holdfast::io
