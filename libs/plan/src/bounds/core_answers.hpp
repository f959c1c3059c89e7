// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "equilibria/solved_core.hpp"
#include "holdfast/model/robot.hpp"
#include "holdfast/plan/element_set.hpp"
#include "holdfast/solver/influence.hpp"

namespace holdfast::plan {

/// How a part of a robot, the core, moves by more loads as long as its facets stick.
class CoreAnswers {
 public:
  using Vecs = std::vector<base::Vec6<double>>;

  /// Factorizes the core; none if its modules are no robot, or it takes too much memory or time.
  static std::unique_ptr<CoreAnswers> make(const model::RobotSpec& spec, const ElementSet& core);

  /// The core; its modules are those of the set, ascending.
  const model::Robot& robot() const { return robot_; }

  /// Finds K^-1 of these of its modules and between these pairs of them: between() after that.
  void find_inverse(std::span<const std::size_t> modules, std::span<const solver::Edge> pairs);

  /// The displacements of the first module for unit loads on the second, by column.
  base::Mat6<double> between(std::size_t first, std::size_t second) const;

  /// How all modules of the core move by each of these sums of loads, whose modules are the core's.
  std::vector<Vecs> answers(std::span<const std::vector<PointLoad>> loads) const;

 private:
  explicit CoreAnswers(model::Robot robot) : robot_(std::move(robot)) {}

  model::Robot robot_;
  std::unique_ptr<solver::Influence> influence_;
};

}  // namespace holdfast::plan
