// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "methods/minimal_residuals.hpp"

#include "equilibrium/beams.hpp"
#include "equilibrium/displacements.hpp"
#include "equilibrium/kept_changes.hpp"
#include "equilibrium/stage_load.hpp"
#include "equilibrium/survey.hpp"
#include "holdfast/agent/features.hpp"
#include "methods/condensed.hpp"
#include "world/facets.hpp"

namespace holdfast::agent {
namespace {

/// The preconditioner of degree m is Chebyshev's iteration [Saad 2003, Alg. 12.1] with the diagonal
/// blocks D, from zero, on the interval [a, 2]. 2 bounds the spectrum of D^-1 A for certain, on any
/// lattice: 2 D - A is a sum of J A_e J >= 0 over the beams (docs/theory.md). What lies below a is
/// left to the iterations. With a = c / (m + 1)^2 all above it comes within 1 +- 1 / cosh(sqrt(2
/// c)) of 1.
struct Interval {
  Interval(int degree, double spread)
      : least(degree == 0 ? 2 : spread / ((degree + 1.0) * (degree + 1.0))),
        centre((2 + least) / 2),
        half((2 - least) / 2) {}

  double least;
  double centre;
  double half;
};

/// The lower end of the interval in which the polynomial is good is this over (m + 1)^2.
constexpr double kIterationSpread = 3;

/// How many parts a node's diagonal is formed and factored in.
constexpr int kDiagonalParts = 4;

void subtract(base::Vec6<double>& from, const base::Vec6<double>& force, double share = 1) {
  for (std::size_t k = 0; k < 6; ++k) {
    from[k] -= share * force[k];
  }
}

/// How many of the changes that are kept are left to be exchanged before displacements are.
int changes_left(const Workspace& ws, const Order& order) {
  constexpr int kDisplacements = 2;
  const bool weighs = kKeepsAnswers && order.operation == wire::Operation::kResumeDeflated;
  const int left = ws.exchange.left_before_report() - kDisplacements;
  return weighs && left > 0 ? left : 0;
}

PlannedPart part_of_displacements(const Workspace& ws, const Order& order) {
  if (!ws.planned.is_any_remote()) {
    return PlannedPart::kTogether;
  }
  const bool is_second =
      moves_between_others(order.operation) && ws.exchange.left_before_report() == 1;
  return is_second ? PlannedPart::kCondensed : PlannedPart::kApart;
}

}  // namespace

PlannedPart part_in_iteration(const Workspace& ws, const Order& order) {
  return changes_left(ws, order) > 0 ? PlannedPart::kApart : part_of_displacements(ws, order);
}

int MinimalResiduals::node_count() const {
  return joined_count(ws_, part_of_displacements(ws_, order_));
}

bool MinimalResiduals::begin(int piece) {
  const int count = node_count();
  // By nothing, from what is kept.
  const bool moves = is_resume(order_.operation) && ws_.exchange.left() > 0;
  const bool starts = order_.operation == wire::Operation::kBegin && order_.count > 0;
  if (piece == 0) {
    begin_equilibrium(ws_, order_);
    return true;
  }
  const int index = (piece - 1) % count;
  const int part = (piece - 1) / count;
  if (part < kDiagonalParts) {
    renew_diagonal(index, part);
  } else if (moves) {
    return move(index);
  } else {
    start_term(index);
  }
  return piece < (kDiagonalParts + (moves || starts ? 1 : 0)) * count;
}

void MinimalResiduals::renew_diagonal(int index, int part) {
  Node& node = ws_.node(index);
  part < 2 ? form_diagonal(node, ws_.setup, ws_.contact, ws_.faces_of(index), part)
           : factor_diagonal(node, part - 2);
}

bool MinimalResiduals::hold(int piece, Report& report) {
  if (piece == 0) {
    if (kHasAllMethods && order_.operation == wire::Operation::kSeek) {
      seek_facets(ws_, order_, report);
    } else {
      hold_facets(ws_, order_, report);
    }
    return true;
  }
  renew_diagonal((piece - 1) / kDiagonalParts, (piece - 1) % kDiagonalParts);
  return piece < kDiagonalParts * ws_.node_count();
}

bool MinimalResiduals::move(int piece) {
  move_node(piece);
  if (piece + 1 < node_count()) {
    return true;
  }
  ws_.clear_middle();
  if (ws_.planned.is_any_remote()) {
    begin_condensing(ws_);
  }
  if (const int left = changes_left(ws_, order_); left > 0) {
    share_change(ws_, wire::kKeptMax - left);
  }
  return false;
}

void MinimalResiduals::move_node(int index) {
  const auto c = static_cast<double>(order_.c());
  const auto a = static_cast<double>(order_.a());
  const auto b = static_cast<double>(order_.b());
  const bool restarts = (order_.flags & kRestart) != 0;
  ws_.contact.stands_in =
      order_.operation == wire::Operation::kIterate && (order_.flags & kStandIn) != 0;
  Node& node = ws_.node(index);
  SearchDirection& newer = vectors_of(index).newer;
  SearchDirection& older = vectors_of(index).older;
  base::Vec6<double> rest = residual(ws_, index);
  base::Vec6<double> correction = newer.p;
  subtract(correction, newer.z);
  base::Vec6<double> move = correction;
  if (!restarts) {
    subtract(newer.p, older.p, c);
    subtract(newer.q, older.q, c);
    subtract(newer.z, older.z, c);
    subtract(correction, base::combination(a, newer.z, b, older.z));
    subtract(rest, base::combination(a, newer.q, b, older.q));
    move = base::combination(a, newer.p, b, older.p);
    base::add_to(move, correction);
  }
  move_along(ws_, order_, index, move);
  base::add_to(node.u, move);
  older = restarts ? SearchDirection{} : newer;
  newer = {.p = correction, .q = rest, .z = correction};
  share_high_part(node);
}

bool MinimalResiduals::take_displacements(int piece) {
  if (const int left = changes_left(ws_, order_); left > 0) {
    return take_change(left);
  }
  const PlannedPart part = part_in_iteration(ws_, order_);
  if (piece == 0) {
    add_forces(ws_, part);
    if (ws_.exchange.left_before_report() == 2) {
      share_low_part(ws_);
      return false;
    }
    if (part != PlannedPart::kTogether) {
      add_condensed_beams(ws_);
    }
    return true;
  }
  // The forces at the new place are complete: contact states, then what the move has done.
  const int index = (piece - 1) % node_count();
  const int stage = (piece - 1) / node_count();
  Node& node = ws_.node(index);
  if (stage == 0) {
    node.has_changed = false;
    follow_state(node, ws_.contact, keeps_states(order_));
  } else if (stage == 5) {
    find_residual(index);
  } else if (node.has_changed) {
    renew_diagonal(index, stage - 1);
  }
  return piece < 6 * node_count();
}

/// The next change goes out, or, after the last one, displacements.
bool MinimalResiduals::take_change(int left) {
  weigh_change(ws_, wire::kKeptMax - left);
  if (left > 1) {
    share_change(ws_, wire::kKeptMax - left + 1);
  } else {
    for (int i = 0; i < ws_.node_count(); ++i) {
      share_high_part(ws_.node(i));
    }
  }
  return false;
}

void MinimalResiduals::find_residual(int index) {
  IterationVectors& vectors = vectors_of(index);
  vectors.w = residual(ws_, index);
  first_term(index);
  subtract(vectors.newer.q, vectors.w);  // Still the residual.
}

void MinimalResiduals::start_terms() {
  for (int i = 0; i < node_count(); ++i) {
    start_term(i);
  }
}

void MinimalResiduals::start_term(int index) {
  vectors_of(index).w = residual(ws_, index);
  first_term(index);
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

bool MinimalResiduals::take_term(int piece) {
  if (piece == 0) {
    subtract_beams();
    return true;
  }
  next_term(piece - 1);
  return piece < node_count();
}

void MinimalResiduals::subtract_beams() {
  const PlannedPart part = part_in_iteration(ws_, order_);
  Beams<double> beams = ws_.setup.beams();
  const auto mine = base::converted<double>(ws_.node(0).vector.sent);
  // Planned modules that stand apart stand still in the polynomial; their beams are weaker.
  const bool holds_planned = (is_iterate(order_.operation) && (order_.flags & kHoldPlanned) != 0) ||
                             is_resume(order_.operation);
  visit_beams(ws_, part, [&](Direction face, const base::Vec6<float>* other, int k) {
    if (other == nullptr) {
      if (holds_planned) {
        subtract(vectors_of(0).w, end_force(beams, face, mine, base::Vec6<double>{}), kHeldShare);
      }
      return;
    }
    const auto theirs = base::converted<double>(*other);
    subtract(vectors_of(0).w, end_force(beams, face, mine, theirs));
    if (k >= 0) {
      ws_.planned_exchange.add_force(ws_.planned, k,
                                     end_force(beams, base::opposite(face), theirs, mine));
    }
  });
  if (part == PlannedPart::kTogether) {
    add_planned_beams(ws_);
    for (int i = 1; i < ws_.node_count(); ++i) {
      subtract(vectors_of(i).w, ws_.planned_exchange.force(ws_.planned, ws_.planned.hosted(i - 1)));
    }
  }
}

void MinimalResiduals::subtract_facets() {
  for (int i = 0; i < node_count(); ++i) {
    subtract_facet(i);
  }
}

void MinimalResiduals::subtract_facet(int index) {
  const Node& node = ws_.node(index);
  if (node.is_ground) {
    subtract(vectors_of(index).w,
             facet_product(node, ws_.contact, base::converted<double>(node.vector.sent)));
  }
}

void MinimalResiduals::next_term(int index) {
  const Interval interval(order_.count, kIterationSpread);
  const double rho = 1 / (2 * interval.centre / interval.half - static_cast<double>(rho_));
  const double keep = rho * static_cast<double>(rho_);
  const double gain = 2 * rho / interval.half;
  subtract_facet(index);
  const Node& node = ws_.node(index);
  if (!node.is_fixed) {
    const base::Vec6<float> step =
        solve_diagonal(node, base::converted<float>(vectors_of(index).w));
    const base::Vec6<double> term = base::combination(
        keep, base::converted<double>(node.vector.sent), gain, base::converted<double>(step));
    share_term(index, base::converted<float>(term));
  }
  if (index + 1 == node_count()) {
    rho_ = static_cast<float>(rho);
  }
}

bool MinimalResiduals::report(int piece, Report& report) const {
  constexpr int kLoadPieces = 2;
  if (piece < kLoadPieces) {
    iteration_report(ws_, piece, report);
    if (piece == 0 && is_deflated(order_.operation)) {
      report_along(ws_, report);
    }
    if (piece > 0 && kKeepsAnswers && order_.operation == wire::Operation::kIterateLast) {
      report_last(ws_, report);
    }
    return true;
  }
  const int index = piece - kLoadPieces;
  const Node& node = ws_.node(index);
  if (!node.is_fixed) {
    const IterationVectors& vectors = vectors_of(index);
    base::Vec6<double> test = vectors.newer.p;
    if ((order_.flags & kLeastResidual) != 0) {
      test = base::converted<double>(solve_diagonal(node, base::converted<float>(vectors.newer.q)));
    }
    report.products[0] += base::dot(residual(ws_, index), test);
    report.products[1] += base::dot(vectors.newer.q, test);
    report.products[2] += base::dot(vectors.older.q, test);
  }
  return index + 1 < node_count();
}

}  // namespace holdfast::agent
