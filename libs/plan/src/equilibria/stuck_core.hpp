// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "holdfast/model/robot.hpp"
#include "holdfast/plan/element_set.hpp"
#include "holdfast/solver/linear_system.hpp"

namespace holdfast::plan {

/// The equations of a part of a robot, all its facets stuck, and what loads instead of its own do
/// to it.
class StuckCore {
 public:
  using Vecs = std::vector<base::Vec6<double>>;

  /// Makes the equations; none if these modules are no robot, or they need too much memory.
  static std::unique_ptr<StuckCore> make(const model::RobotSpec& spec, const ElementSet& modules,
                                         solver::Precision precision);

  struct Answer {
    Vecs displacement;
    double error = 0;  ///< In the energy norm, at most.
  };

  /// Displacements by module of the part; their error is estimated from `tolerance`, and is 0 if
  /// the system is exact. None if it cannot be solved so.
  std::optional<Answer> answer(const Vecs& loads, double tolerance);

  const model::Robot& robot() const { return robot_; }

  solver::LinearSystem& system() { return *system_; }

 private:
  explicit StuckCore(model::Robot robot) : robot_(std::move(robot)) {}

  model::Robot robot_;
  std::unique_ptr<solver::LinearSystem> system_;
};

/// The work of loads.
double work_of(const StuckCore::Vecs& loads, const StuckCore::Vecs& displacement);

}  // namespace holdfast::plan
