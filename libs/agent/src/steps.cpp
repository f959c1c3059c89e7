// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "bits.hpp"
#include "equilibrium.hpp"
#include "holdfast/agent/agent.hpp"
#include "methods.hpp"

/// The one-sweep methods: every step costs one sweep, residual and contact states included.
///
/// A step moves by a correction of the last residual r, exchanges the new displacements in two
/// parts, computes the new residual precisely and reports sums of it. While they travel to the root
/// and the next order comes back, the modules work on M^-1 r: with a polynomial, exchange after
/// exchange; or with the exact elimination of branch.hpp on the sweep's own way up and down. So
/// neither waits for the other.
///
/// Least energy. K and M^-1 are symmetric, so directions (p, q = K p, z = M^-1 q) need to be made
/// conjugate to the one before only: conjugate gradients. The twist is the delay: when the sums
/// of r are known, M^-1 r is there already, so the step is taken in full and minimised afterwards,
/// as Anderson's method does [Walker, Ni 2011]:
///   newer    p = d, q = r^ - r, z = d - M^-1 r      what the last step d = M^-1 r^ did
///            minus c times older                    c = (p, q_older) / (p_older, q_older)
///   r^ = r - a q - b q_older,  d = M^-1 r^ = M^-1 r - a z - b z_older      the least energy
///   u := u + a p + b p_older + d
/// M^-1 r is not stored: it is newer.p - newer.z until the step.
/// While a facet tilts K is not symmetric and has no energy. Then |r| is minimised in the norm of
/// D^-1 (the diagonal blocks), with D^-1 q in the place of p, as in Orthomin(1) [Vinsome 1976;
/// Greenbaum 1997, ch. 2].
/// Residuals are never recurred but computed, in double precision from displacements shared in two
/// parts. The products are sums of large terms that cancel, as p is large and smooth and r small
/// and rough, so they travel in two parts as well.
namespace holdfast::agent {

/// The lower end of the interval in which the polynomial is good is this over (m + 1)^2.
inline constexpr double kStepSpread = 3;

void Agent::begin_step(const Order& order) {
  middle_ = {};
  const auto c = static_cast<double>(order.reals[0]);
  const auto a = static_cast<double>(order.reals[1]);
  const auto b = static_cast<double>(order.reals[2]);
  const bool restarts = (order.flags & kRestart) != 0;
  for (int i = 0; i < joined_count(); ++i) {
    Node& node = nodes_[static_cast<std::size_t>(i)];
    Steps& steps = steps_of(i);
    SearchDirection& newer = steps.newer;
    SearchDirection& older = steps.older;
    base::Vec6<double> rest = residual(node, setup_, contact_);
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
  if (is_apart()) {
    begin_condensing();
  }
  clear_clusters();
}

void Agent::share_high_part(Node& node) {
  node.force = {};
  for (std::size_t k = 0; k < 6; ++k) {
    node.shared[k] = static_cast<float>(leading_part(node.u[k]));
  }
}

/// The forces at the new place are complete: contact states, then what the step has done.
void Agent::find_residuals() {
  if (is_apart()) {
    add_remote_beams();
  }
  for (int i = 0; i < joined_count(); ++i) {
    find_residual(i);
  }
}

/// The contact state that belongs to u.
void Agent::follow_state(Node& node) {
  const bool is_kept = kHasAllMethods && order_.operation == wire::Operation::kStep &&
                       (order_.flags & kKeepStates) != 0;
  node.wanted = is_kept ? node.state : state_along(node, contact_, {}, 0);
  if (node.is_ground && !(node.wanted == node.state)) {
    node.state = node.wanted;
    node.has_changed = true;
  }
}

void Agent::find_residual(int node_index) {
  Node& node = nodes_[static_cast<std::size_t>(node_index)];
  node.has_changed = false;
  follow_state(node);
  if (!kHasAllMethods || order_.operation == wire::Operation::kTreeStep) {
    return;
  }
  if (node.has_changed) {
    factor_diagonal(node, setup_, contact_, node_faces(node_index));
  }
  start_terms(node_index);
  Steps& steps = steps_of(node_index);
  for (std::size_t k = 0; k < 6; ++k) {
    steps.newer.q[k] -= steps.w[k];  // Still the residual.
  }
}

/// A term goes out as the neighbours will have it, and into M^-1 r.
void Agent::share_term(Node& node, Steps& steps) {
  for (std::size_t k = 0; k < 6; ++k) {
    steps.newer.z[k] -= static_cast<double>(node.shared[k]);
  }
}

/// The polynomial's first term for the present residual, or for what w has.
void Agent::start_terms(int node_index) {
  const Node& node = nodes_[static_cast<std::size_t>(node_index)];
  steps_of(node_index).w = residual(node, setup_, contact_);
  first_term(node_index);
}

void Agent::first_term(int node_index) {
  Node& node = nodes_[static_cast<std::size_t>(node_index)];
  Steps& steps = steps_of(node_index);
  const equilibrium::Interval interval(order_.count, kStepSpread);
  const base::Vec6<float> first = solve_diagonal(node, base::converted<float>(steps.w));
  for (std::size_t k = 0; k < 6; ++k) {
    node.shared[k] = static_cast<float>(static_cast<double>(first[k]) / interval.centre);
  }
  share_term(node, steps);
  rho_ = static_cast<float>(interval.half / interval.centre);
}

/// The facet's force of the last term comes off w; those of the beams are off already.
void Agent::subtract_facet(int node_index) {
  const Node& node = nodes_[static_cast<std::size_t>(node_index)];
  if (!node.is_ground) {
    return;
  }
  const base::Vec6<double> facet = mechanics::contact_force(
      contact_.facet, node.state, node.is_held, base::converted<double>(node.shared));
  for (std::size_t k = 0; k < 6; ++k) {
    steps_of(node_index).w[k] -= facet[k];
  }
}

/// The next term.
void Agent::next_terms() {
  const equilibrium::Interval interval(order_.count, kStepSpread);
  const double rho = 1 / (2 * interval.centre / interval.half - static_cast<double>(rho_));
  const double keep = rho * static_cast<double>(rho_);
  const double gain = 2 * rho / interval.half;
  for (int i = 0; i < joined_count(); ++i) {
    Node& node = nodes_[static_cast<std::size_t>(i)];
    Steps& steps = steps_of(i);
    if (node.is_fixed) {
      continue;
    }
    subtract_facet(i);
    const base::Vec6<float> term = solve_diagonal(node, base::converted<float>(steps.w));
    for (std::size_t k = 0; k < 6; ++k) {
      node.shared[k] = static_cast<float>(keep * static_cast<double>(node.shared[k]) +
                                          gain * static_cast<double>(term[k]));
    }
    share_term(node, steps);
  }
  rho_ = static_cast<float>(rho);
}

/// What every step reports: the bound on the error of load ratios that the residual means, the
/// largest of them, and the facets.
Report Agent::tree_step_report() const {
  Report report;
  double error = 0;
  for (int i = 0; i < node_count(); ++i) {
    const Node& node = nodes_[static_cast<std::size_t>(i)];
    report.extent = static_cast<std::uint16_t>(report.extent + (node.has_changed ? 1 : 0));
    equilibrium::report_facet(report, node);
    error += ratio_error(residual(node, setup_, contact_), setup_, contact_);
  }
  report.reals = {static_cast<float>(error), kNoLoadRatio};
  visit_loads([&](const base::Cell&, base::Direction, double ratio) {
    report.reals[1] = larger(report.reals[1], static_cast<float>(ratio));
  });
  return report;
}

/// And the products with v = p for the least energy, v = D^-1 q for the least residual:
/// (r, v), (q, v), (q_older, v).
Report Agent::step_report() const {
  Report report = tree_step_report();
  const bool is_residual = (order_.flags & kLeastResidual) != 0;
  for (int i = 0; i < joined_count(); ++i) {
    const Node& node = nodes_[static_cast<std::size_t>(i)];
    if (node.is_fixed) {
      continue;
    }
    const Steps& steps = steps_of(i);
    base::Vec6<double> test = steps.newer.p;
    if (is_residual) {
      test = base::converted<double>(solve_diagonal(node, base::converted<float>(steps.newer.q)));
    }
    report.products[0] += base::dot(residual(node, setup_, contact_), test);
    report.products[1] += base::dot(steps.newer.q, test);
    report.products[2] += base::dot(steps.older.q, test);
  }
  return report;
}

}  // namespace holdfast::agent
