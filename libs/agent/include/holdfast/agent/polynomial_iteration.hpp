// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "holdfast/agent/exchange_method.hpp"
#include "holdfast/agent/order.hpp"
#include "holdfast/agent/workspace.hpp"

namespace holdfast::agent {

/// Minimal residuals with a polynomial as preconditioner: every iteration costs one sweep, residual
/// and contact states included (src/minimal_residuals.hpp).
class PolynomialIteration : public ExchangeMethod {
 public:
  void begin(Workspace& ws, const Order& order);

  void take_exchange(Workspace& ws, const Order& order);

  static PlannedPart planned_part(const Workspace& ws, const Order& order);

  Report report(Workspace& ws, const Order& order);

 private:
  std::array<IterationVectors, 1 + kPlannedMax> vectors_{};
  float rho_ = 0;  ///< Coefficient of the polynomial.
};

}  // namespace holdfast::agent
