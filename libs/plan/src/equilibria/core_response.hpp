// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <memory>
#include <optional>

#include "equilibria/solved_core.hpp"
#include "holdfast/model/robot.hpp"
#include "holdfast/solver/equilibrium.hpp"

namespace holdfast::plan {

/// The equilibria of many robots that have the same core and little besides: other loads on some of
/// its modules, a few modules more, or one, with a few connections and facets, less. The core is
/// factorized once, all its facets stuck, and solved once for each of six forces at every module
/// that is ever loaded or touched, or whose facet yields; then every such robot is a ChangedRobot.
/// The core never changes, so nothing depends on what was asked before. Not for several threads.
class CoreResponse {
 public:
  /// Solves the core; none if that is too large for the direct solver, or for double precision.
  static std::unique_ptr<CoreResponse> make(model::Robot core,
                                            const solver::EquilibriumOptions& options);

  /// The equilibrium by the regularised law of a robot that has the core's modules, in their order,
  /// and at most kNewMax others, connected to it or to each other; or that lacks one module, some
  /// connections or some facets of the core. None if it cannot be had this
  /// way, or if the law may have other solutions: a check has to find out.
  std::optional<solver::Equilibrium> solve(const model::Robot& robot);

 private:
  class Member;

  explicit CoreResponse(model::Robot core) : robot_(std::move(core)) {}

  model::Robot robot_;
  std::unique_ptr<solver::Influence> influence_;
  std::optional<SolvedCore> core_;
};

/// A robot may have so many modules more than the core.
inline constexpr std::size_t kNewMax = 4;

}  // namespace holdfast::plan
