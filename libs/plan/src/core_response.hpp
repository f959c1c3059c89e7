// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <unordered_map>
#include <vector>

#include "holdfast/model/robot.hpp"
#include "holdfast/solver/equilibrium.hpp"
#include "holdfast/solver/linear_system.hpp"

namespace holdfast::plan {

/// The equilibria of many robots that have the same core and little besides: other loads on some of
/// its modules, or a few modules more. The core's equations are solved once for its own loads, and
/// once for each of six forces at every module that is ever loaded or touched; then every such
/// robot is a small dense system in the displacements of these modules, of the new ones and of feet
/// whose contact state has changed.
///
///   u = u_0 + sum over modules i of U_i r_i,   r_i = p_i - (S u)_i,   0 = f_m - (S u)_m,
///
/// where u_0 and U_i are the core's displacements, p_i are loads beyond the core's own, f_m those
/// of new modules, and S is the stiffness that is new: beams to new modules, their feet, and the
/// change of tangent of feet in other states than the core's. States are sought by Newton's
/// method from all stuck, as a check does, or another solution may be found than the check's. The
/// core never changes, so nothing depends on what was asked before.
class CoreResponse {
 public:
  using Vec = base::Vec6<double>;
  using Vecs = std::vector<Vec>;

  /// None if the core has no equilibrium that serves: it is unstable, too large for the direct
  /// solver, or not settled by the regularised law.
  static std::unique_ptr<CoreResponse> make(model::Robot core,
                                            const solver::EquilibriumOptions& options);

  const model::Robot& core() const { return core_; }

  /// The equilibrium by the regularised law of a robot that has the core's modules, in their order,
  /// and at most kNewMax others, connected to it or to each other. None if it cannot be had this
  /// way, or if the law may have other solutions: a check has to find out.
  std::optional<solver::Equilibrium> solve(const model::Robot& robot);

 private:
  /// The core's displacements under a load, and before they were refined.
  struct Answer {
    Vecs refined;
    Vecs rough;
  };

  /// Those of six unit forces and torques on one module.
  using Column = std::array<Answer, 6>;

  class Grown;

  explicit CoreResponse(model::Robot core);
  bool prepare(const solver::EquilibriumOptions& options);
  std::optional<std::vector<Answer>> answers(const std::vector<model::Loads>& loads);
  Vecs residual(const model::Loads& load, const Vecs& displacement) const;
  const Column* column(std::size_t module);

  model::Robot core_;
  std::unique_ptr<solver::LinearSystem> system_;
  Answer own_;                                       ///< Under the core's loads.
  std::unordered_map<std::size_t, Column> columns_;  ///< Only ever asked, never walked through.
};

/// A robot may have so many modules more than the core.
inline constexpr std::size_t kNewMax = 4;

}  // namespace holdfast::plan
