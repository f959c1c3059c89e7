// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "holdfast/agent/equilibrium/workspace.hpp"
#include "holdfast/agent/messages/order.hpp"
#include "holdfast/agent/methods/condensing.hpp"
#include "holdfast/agent/methods/tree_elimination.hpp"

namespace holdfast::agent {

/// Minimal residuals with a polynomial as preconditioner: every iteration costs one sweep, residual
/// and contact states included (minimal_residuals.hpp).
class PolynomialIteration {
 public:
  // It knows nothing but exchanges: no messages of its own, and no work beside them.
  static bool expects(const Workspace&, const Order&, Direction, std::span<const std::uint8_t>) {
    return false;
  }

  static void take(Workspace&, const Order&, Direction, std::span<const std::uint8_t>) {}

  static bool do_piece(Workspace&, const Order&) { return false; }

  static Pending pending() { return Pending::kNothing; }

  bool begin(Workspace& ws, const Order& order, int piece);

  bool take_exchange(Workspace& ws, const Order& order, int piece);

  bool condense(Workspace& ws, const Order& order, int piece) {
    return condensing_.do_piece(ws, order, memory(ws), piece);
  }

  static PlannedPart planned_part(const Workspace& ws, const Order& order);

  bool report(Workspace& ws, const Order& order, int piece, Report& sum);

 private:
  std::span<IterationMemory> memory(const Workspace& ws) {
    MorePlanned* more = ws.planned.more_planned();
    return more != nullptr ? std::span<IterationMemory>(more->iterations) : memory_;
  }

  std::array<IterationMemory, 1 + kPlannedMax> memory_{};
  Condensing condensing_;
  float rho_ = 0;  ///< Coefficient of the polynomial.
};

}  // namespace holdfast::agent
