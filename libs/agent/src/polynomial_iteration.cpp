// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "holdfast/agent/polynomial_iteration.hpp"

#include "minimal_residuals.hpp"

namespace holdfast::agent {

PlannedPart PolynomialIteration::planned_part(const Workspace& ws, const Order& order) {
  return part_in_iteration(ws, order);
}

void PolynomialIteration::begin(Workspace& ws, const Order& order) {
  MinimalResiduals iteration(ws, order, vectors_, rho_);
  if (order.operation == wire::Operation::kIterate) {
    iteration.move();
    return;
  }
  iteration.begin();
  if (order.count > 0) {
    iteration.start_terms();
  }
}

void PolynomialIteration::take_exchange(Workspace& ws, const Order& order) {
  MinimalResiduals iteration(ws, order, vectors_, rho_);
  if (ws.exchange.left_before_report() > 0) {
    iteration.take_displacements();
  } else {
    iteration.take_term();
    iteration.next_terms();
  }
}

Report PolynomialIteration::report(Workspace& ws, const Order& order) {
  return order.operation == wire::Operation::kIterate
             ? MinimalResiduals(ws, order, vectors_, rho_).report()
             : Report{};
}

}  // namespace holdfast::agent
