// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <span>

#include "holdfast/agent/order.hpp"
#include "holdfast/agent/tree_elimination.hpp"
#include "holdfast/agent/workspace.hpp"

namespace holdfast::agent {

/// Minimal residuals with a polynomial as preconditioner: every iteration costs one sweep, residual
/// and contact states included (src/minimal_residuals.hpp).
class PolynomialIteration {
 public:
  void begin(Workspace& ws, const Order& order);

  /// It has no messages of its own.
  static bool expects(const Workspace&, const Order&, Direction, std::span<const std::uint8_t>) {
    return false;
  }

  static void take(Workspace&, const Order&, Direction, std::span<const std::uint8_t>) {}

  void take_exchange(Workspace& ws, const Order& order);

  static bool do_piece(Workspace&, const Order&) { return false; }

  static Pending pending() { return Pending::kNothing; }

  static PlannedPart planned_part(const Workspace& ws, const Order& order);

  Report report(Workspace& ws, const Order& order);

 private:
  std::array<IterationVectors, 1 + kPlannedMax> vectors_{};
  float rho_ = 0;  ///< Coefficient of the polynomial.
};

}  // namespace holdfast::agent
