// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <span>

#include "holdfast/agent/condensing.hpp"
#include "holdfast/agent/exchange_method.hpp"
#include "holdfast/agent/order.hpp"
#include "holdfast/agent/workspace.hpp"

namespace holdfast::agent {

/// Minimal residuals with a polynomial as preconditioner: every iteration costs one sweep, residual
/// and contact states included (src/minimal_residuals.hpp).
class PolynomialIteration : public ExchangeMethod {
 public:
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
    return kPlansMany && more != nullptr ? std::span<IterationMemory>(more->iterations) : memory_;
  }

  std::array<IterationMemory, 1 + kPlannedMax> memory_{};
  Condensing condensing_;
  float rho_ = 0;  ///< Coefficient of the polynomial.
};

}  // namespace holdfast::agent
