// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "holdfast/agent/polynomial_steps.hpp"

#include "minimal_residuals.hpp"

namespace holdfast::agent {

PlannedPart PolynomialSteps::planned_part(const Workspace& ws, const Order& order) {
  return part_in_iteration(ws, order);
}

void PolynomialSteps::begin(Workspace& ws, const Order& order) {
  MinimalResiduals iteration(ws, order, steps_, rho_);
  if (order.operation == wire::Operation::kStep) {
    iteration.move();
    return;
  }
  iteration.begin();
  if (order.count > 0) {
    iteration.start_terms();
  }
}

void PolynomialSteps::take_exchange(Workspace& ws, const Order& order) {
  MinimalResiduals iteration(ws, order, steps_, rho_);
  if (ws.exchange.left_before_report() > 0) {
    iteration.take_displacements();
  } else {
    iteration.take_term();
    iteration.next_terms();
  }
}

Report PolynomialSteps::report(Workspace& ws, const Order& order) {
  return order.operation == wire::Operation::kStep
             ? MinimalResiduals(ws, order, steps_, rho_).report()
             : Report{};
}

}  // namespace holdfast::agent
