// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "holdfast/agent/methods/polynomial_iteration.hpp"

#include "holdfast/agent/features.hpp"
#include "methods/minimal_residuals.hpp"

namespace holdfast::agent {

namespace {

/// Another state of facets, and nothing moves.
bool is_about_facets(const Order& order) {
  return order.operation == wire::Operation::kHold ||
         (kHasAllMethods && order.operation == wire::Operation::kSeek);
}

}  // namespace

PlannedPart PolynomialIteration::planned_part(const Workspace& ws, const Order& order) {
  return part_in_iteration(ws, order);
}

bool PolynomialIteration::begin(Workspace& ws, const Order& order, int piece) {
  if (is_about_facets(order)) {
    return false;  // Work is left to the report.
  }
  MinimalResiduals iteration(ws, order, memory(ws), rho_);
  return is_iterate(order.operation) ? iteration.move(piece) : iteration.begin(piece);
}

bool PolynomialIteration::take_exchange(Workspace& ws, const Order& order, int piece) {
  MinimalResiduals iteration(ws, order, memory(ws), rho_);
  return ws.exchange.left_before_report() > 0 ? iteration.take_displacements(piece)
                                              : iteration.take_term(piece);
}

bool PolynomialIteration::report(Workspace& ws, const Order& order, int piece, Report& sum) {
  MinimalResiduals iteration(ws, order, memory(ws), rho_);
  return is_about_facets(order) ? iteration.hold(piece, sum)
                                : is_iterate(order.operation) && iteration.report(piece, sum);
}

}  // namespace holdfast::agent
