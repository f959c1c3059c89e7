// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "equilibria/solved_core.hpp"
#include "holdfast/model/robot.hpp"
#include "holdfast/solver/equilibrium.hpp"
#include "holdfast/solver/linear_system.hpp"

namespace holdfast::plan {

/// The equilibria of many robots that have the same core and little besides: other loads on some of
/// its modules, or a few modules more. The core's equations are solved once for its own loads, in
/// the contact states that these lead to, and once for each of six forces at every module that is
/// ever loaded or touched; then every such robot is a ChangedRobot. The core never changes, so
/// nothing depends on what was asked before. Not for several threads.
class CoreResponse final : public SolvedCore {
 public:
  using Vecs = std::vector<Vec>;

  /// None if the core has no equilibrium that serves: it is unstable, too large for the direct
  /// solver, or not settled by the regularised law.
  static std::unique_ptr<CoreResponse> make(model::Robot core,
                                            const solver::EquilibriumOptions& options);

  /// The equilibrium by the regularised law of a robot that has the core's modules, in their order,
  /// and at most kNewMax others, connected to it or to each other. None if it cannot be had this
  /// way, or if the law may have other solutions: a check has to find out.
  std::optional<solver::Equilibrium> solve(const model::Robot& robot);

  std::span<const solver::FacetState> facets() const override { return system_->facets(); }

  const solver::FacetLaw<double>& law() const override { return system_->law(); }

  const model::LatticeBeam<double>& beam() const override { return system_->beam(); }

  const Vec& displacement(std::size_t module) const override { return own_.refined[module]; }

  bool knows(std::span<const std::size_t> modules) const override;
  Vec answer(std::size_t module, const PointLoad& load) const override;

 private:
  /// The core's displacements under a load, and before they were refined.
  struct Answer {
    Vecs refined;
    Vecs rough;
  };

  /// Those of six unit forces and torques on one module.
  using Column = std::array<Answer, 6>;

  class Member;

  explicit CoreResponse(model::Robot core);
  bool prepare(const solver::EquilibriumOptions& options);
  std::optional<std::vector<Answer>> answers(const std::vector<model::Loads>& loads) const;
  Vecs residual(const model::Loads& load, const Vecs& displacement) const;
  const Column* column(std::size_t module) const;

  model::Robot core_;
  std::unique_ptr<solver::LinearSystem> system_;
  Answer own_;                                                  ///< Under the core's loads.
  mutable std::vector<std::unique_ptr<const Column>> columns_;  ///< By module, where asked for;
  mutable std::size_t column_count_ = 0;                        ///< so many.
};

/// A robot may have so many modules more than the core.
inline constexpr std::size_t kNewMax = 4;

}  // namespace holdfast::plan
