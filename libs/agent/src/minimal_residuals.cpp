// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "minimal_residuals.hpp"

#include "beams.hpp"
#include "chebyshev.hpp"
#include "condensed.hpp"
#include "displacements.hpp"

namespace holdfast::agent {
namespace {

/// The lower end of the interval in which the polynomial is good is this over (m + 1)^2.
constexpr double kIterationSpread = 3;

void subtract(base::Vec6<double>& from, const base::Vec6<double>& force, double share = 1) {
  for (std::size_t k = 0; k < 6; ++k) {
    from[k] -= share * force[k];
  }
}

}  // namespace

PlannedPart part_in_iteration(const Workspace& ws, const Order& order) {
  if (!ws.planned.is_any_remote()) {
    return PlannedPart::kTogether;
  }
  const bool is_second =
      order.operation == wire::Operation::kIterate && ws.exchange.left_before_report() == 1;
  return is_second ? PlannedPart::kCondensed : PlannedPart::kApart;
}

int MinimalResiduals::node_count() const {
  return joined_count(ws_, part_in_iteration(ws_, order_));
}

void MinimalResiduals::begin() {
  begin_equilibrium(ws_, order_);
  for (int i = 0; i < node_count(); ++i) {
    factor_diagonal(ws_.node(i), ws_.setup, ws_.contact, ws_.faces_of(i));
  }
}

void MinimalResiduals::move() {
  ws_.middle = {};
  const auto c = static_cast<double>(order_.c());
  const auto a = static_cast<double>(order_.a());
  const auto b = static_cast<double>(order_.b());
  const bool restarts = (order_.flags & kRestart) != 0;
  for (int i = 0; i < node_count(); ++i) {
    Node& node = ws_.node(i);
    SearchDirection& newer = vectors_of(i).newer;
    SearchDirection& older = vectors_of(i).older;
    base::Vec6<double> rest = residual(node, ws_.setup, ws_.contact);
    for (std::size_t k = 0; k < 6; ++k) {
      double correction = newer.p[k] - newer.z[k];
      double known = 0;
      if (!restarts) {
        newer.p[k] -= c * older.p[k];
        newer.q[k] -= c * older.q[k];
        newer.z[k] -= c * older.z[k];
        known = a * newer.p[k] + b * older.p[k];
        correction -= a * newer.z[k] + b * older.z[k];
        rest[k] -= a * newer.q[k] + b * older.q[k];
      }
      node.u[k] += known + correction;
      older.p[k] = restarts ? 0 : newer.p[k];
      older.q[k] = restarts ? 0 : newer.q[k];
      older.z[k] = restarts ? 0 : newer.z[k];
      newer.p[k] = correction;
      newer.q[k] = rest[k];
      newer.z[k] = correction;
    }
    share_high_part(node);
  }
  if (ws_.planned.is_any_remote()) {
    begin_condensing(ws_, order_);
  }
}

void MinimalResiduals::take_displacements() {
  const PlannedPart part = part_in_iteration(ws_, order_);
  add_forces(ws_, part);
  if (ws_.exchange.left_before_report() == 2) {
    share_low_part(ws_);
    return;
  }
  // The forces at the new place are complete: contact states, then what the move has done.
  if (part != PlannedPart::kTogether) {
    add_condensed_beams(ws_);
  }
  for (int i = 0; i < node_count(); ++i) {
    find_residual(i);
  }
}

void MinimalResiduals::find_residual(int index) {
  Node& node = ws_.node(index);
  node.has_changed = false;
  follow_state(node, ws_.contact, keeps_states(order_));
  if (node.has_changed) {
    factor_diagonal(node, ws_.setup, ws_.contact, ws_.faces_of(index));
  }
  IterationVectors& vectors = vectors_of(index);
  vectors.w = residual(node, ws_.setup, ws_.contact);
  first_term(index);
  subtract(vectors.newer.q, vectors.w);  // Still the residual.
}

void MinimalResiduals::start_terms() {
  for (int i = 0; i < node_count(); ++i) {
    vectors_of(i).w = residual(ws_.node(i), ws_.setup, ws_.contact);
    first_term(i);
  }
}

void MinimalResiduals::first_term(int index) {
  const Interval interval(order_.count, kIterationSpread);
  base::Vec6<float> term =
      solve_diagonal(ws_.node(index), base::converted<float>(vectors_of(index).w));
  for (float& value : term) {
    value = static_cast<float>(static_cast<double>(value) / interval.centre);
  }
  share_term(index, term);
  rho_ = static_cast<float>(interval.half / interval.centre);
}

void MinimalResiduals::first_terms() {
  for (int i = 0; i < node_count(); ++i) {
    first_term(i);
  }
}

void MinimalResiduals::share_term(int index, const base::Vec6<float>& term) {
  ws_.node(index).vector.sent = term;
  subtract(vectors_of(index).newer.z, base::converted<double>(term));
}

void MinimalResiduals::take_term() {
  const PlannedPart part = part_in_iteration(ws_, order_);
  const mechanics::BeamStiffness<double>& beam = ws_.setup.beam;
  const auto mine = base::converted<double>(ws_.node(0).vector.sent);
  // Planned modules that stand apart stand still in the polynomial; their beams are weaker.
  const bool holds_planned =
      order_.operation == wire::Operation::kIterate && (order_.flags & kHoldPlanned) != 0;
  visit_beams(ws_, part, [&](Direction face, const base::Vec6<float>* other, int k) {
    if (other == nullptr) {
      if (holds_planned) {
        subtract(vectors_of(0).w, mechanics::end_force(beam, face, mine, {}), kHeldShare);
      }
      return;
    }
    const auto theirs = base::converted<double>(*other);
    subtract(vectors_of(0).w, mechanics::end_force(beam, face, mine, theirs));
    if (k >= 0) {
      ws_.planned_exchange.add_force(
          k, mechanics::end_force(beam, base::opposite(face), theirs, mine));
    }
  });
  if (part == PlannedPart::kTogether) {
    add_planned_beams(ws_);
    for (int i = 1; i < ws_.node_count(); ++i) {
      subtract(vectors_of(i).w, ws_.planned_exchange.force(ws_.planned.hosted(i - 1)));
    }
  }
}

void MinimalResiduals::subtract_facets() {
  for (int i = 0; i < node_count(); ++i) {
    const Node& node = ws_.node(i);
    if (!node.is_ground) {
      continue;
    }
    const base::Vec6<double> facet = mechanics::contact_force(
        ws_.contact.facet, node.state, node.is_held, base::converted<double>(node.vector.sent));
    subtract(vectors_of(i).w, facet);
  }
}

void MinimalResiduals::next_terms() {
  const Interval interval(order_.count, kIterationSpread);
  const double rho = 1 / (2 * interval.centre / interval.half - static_cast<double>(rho_));
  const double keep = rho * static_cast<double>(rho_);
  const double gain = 2 * rho / interval.half;
  subtract_facets();
  for (int i = 0; i < node_count(); ++i) {
    const Node& node = ws_.node(i);
    if (node.is_fixed) {
      continue;
    }
    base::Vec6<float> term = solve_diagonal(node, base::converted<float>(vectors_of(i).w));
    for (std::size_t k = 0; k < 6; ++k) {
      term[k] = static_cast<float>(keep * static_cast<double>(node.vector.sent[k]) +
                                   gain * static_cast<double>(term[k]));
    }
    share_term(i, term);
  }
  rho_ = static_cast<float>(rho);
}

Report MinimalResiduals::report() const {
  Report report = iteration_report(ws_);
  const bool is_residual = (order_.flags & kLeastResidual) != 0;
  for (int i = 0; i < node_count(); ++i) {
    const Node& node = ws_.node(i);
    if (node.is_fixed) {
      continue;
    }
    const IterationVectors& vectors = vectors_of(i);
    base::Vec6<double> test = vectors.newer.p;
    if (is_residual) {
      test = base::converted<double>(solve_diagonal(node, base::converted<float>(vectors.newer.q)));
    }
    report.products[0] += base::dot(residual(node, ws_.setup, ws_.contact), test);
    report.products[1] += base::dot(vectors.newer.q, test);
    report.products[2] += base::dot(vectors.older.q, test);
  }
  return report;
}

}  // namespace holdfast::agent
