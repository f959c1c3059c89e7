// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "holdfast/agent/krylov_and_jacobi.hpp"

#include "beams.hpp"
#include "chebyshev.hpp"
#include "condensed.hpp"
#include "displacements.hpp"
#include "facets.hpp"
#include "stage_load.hpp"

namespace holdfast::agent {
namespace {

using wire::Operation;

/// beta of Eq. (14).
constexpr double kJacobiWeight = 2.0 / 3.0;

/// A linear solve's exchanges: the preconditioner's terms, then w = A z.
bool is_preconditioned(Operation operation) {
  return operation == Operation::kStart || operation == Operation::kGradient;
}

}  // namespace

PlannedPart KrylovAndJacobi::planned_part(const Workspace& ws, const Order& order) {
  return ws.planned.is_any_remote() && is_preconditioned(order.operation) && ws.exchange.left() > 1
             ? PlannedPart::kApart
             : PlannedPart::kTogether;
}

bool KrylovAndJacobi::begin(Workspace& ws, const Order& order, int piece) {
  switch (order.operation) {
    case Operation::kBegin:
      more_ = ws.planned.more_planned();
      begin_equilibrium(ws, order);
      for (int i = 0; i < ws.node_count(); ++i) {
        vectors(i) = gradients_at_rest(ws.node(i), ws.setup);
        if (const base::Vec6<double>* hung = hung_on(ws, i); hung != nullptr) {
          base::add_to(vectors(i).r, base::converted<float>(*hung));
          vectors(i).r_start = vectors(i).r;
        }
      }
      return false;
    case Operation::kHigh:
      move(ws, order);
      return false;
    case Operation::kLow:
      share_low_part(ws);
      return false;
    case Operation::kStart:
      start_solve(ws, order, piece % 4, piece / 4);
      return piece + 1 < 4 * ws.node_count();
    case Operation::kGradient:
      iterate_gradient(ws, order, piece);
      return piece + 1 < ws.node_count();
    case Operation::kJacobi:
    case Operation::kSlope:
      share_correction(ws);
      return false;
    default:
      return false;
  }
}

bool KrylovAndJacobi::take_exchange(Workspace& ws, const Order& order, int piece) {
  if (order.operation == Operation::kHigh || order.operation == Operation::kLow) {
    add_forces(ws, PlannedPart::kTogether);
    return false;
  }
  if (piece == 0) {
    find_images(ws, order);
    return is_preconditioned(order.operation) || order.operation == Operation::kJacobi;
  }
  if (order.operation == Operation::kJacobi) {
    iterate_jacobi(ws);
    return false;
  }
  next_term(ws, order, piece - 1);
  return piece < joined_count(ws, planned_part(ws, order));
}

bool KrylovAndJacobi::report(Workspace& ws, const Order& order, int piece, Report& sum) {
  switch (order.operation) {
    case Operation::kLow:
      return report_residual(ws, order, piece, sum);
    case Operation::kStart:
    case Operation::kGradient:
      report_products(ws, sum);
      return false;
    case Operation::kJacobi:
      sum.reals[0] = jacobi_error_;
      return false;
    case Operation::kSlope:
      if ((order.flags & kMixProducts) == 0) {
        return report_slopes(ws, order, piece, sum);
      }
      report_mix(ws, sum);
      return false;
    case Operation::kHold:
      hold_facets(ws, order, sum);
      return false;
    case Operation::kSeek:
      seek_facets(ws, order, sum);
      return false;
    default:
      return false;
  }
}

/// u := u + t g - theta (last move + change of g), and its leading part goes out.
void KrylovAndJacobi::move(Workspace& ws, const Order& order) {
  const float length = order.length();
  const float mix = order.mix();
  for (int i = 0; i < ws.node_count(); ++i) {
    Node& node = ws.node(i);
    Gradients& cg = vectors(i);
    for (std::size_t k = 0; k < 6; ++k) {
      cg.move[k] = length * cg.g[k] - mix * (cg.move[k] + cg.g[k] - cg.g_before[k]);
      node.u[k] += static_cast<double>(cg.move[k]);
    }
    share_high_part(node);
  }
  ws.clear_middle();
}

/// In four parts for each node.
void KrylovAndJacobi::start_solve(Workspace& ws, const Order& order, int part, int index) {
  is_scalar_ = (order.flags & kWithScalars) != 0;
  is_first_iteration_ = true;
  Node& node = ws.node(index);
  Gradients& cg = vectors(index);
  if (part == 2) {
    factor_diagonal(node, 0);
    return;
  }
  if (part == 3) {
    factor_diagonal(node, 1);
    precondition(ws, index, order.count, index < joined_count(ws, planned_part(ws, order)));
    if (is_scalar_) {
      cg.p = scalar_diagonal(node, ws.setup, ws.contact, ws.faces_of(index));
    }
    return;
  }
  if (part == 0) {
    if ((order.flags & kAdoptStates) != 0) {
      take_states(node);
      cg.r = base::converted<float>(residual(ws, index));
    }
    cg.r_before = cg.r_start;
    cg.r_start = cg.r;
    cg.g_before = cg.g;
    cg.g = {};
    cg.p = {};
    cg.s = {};
  }
  form_diagonal(node, ws.setup, ws.contact, ws.faces_of(index), part);
}

/// p := z + beta p, s := w + beta s, g := g + alpha p, r := r - alpha s, z := M^-1 r.
void KrylovAndJacobi::iterate_gradient(Workspace& ws, const Order& order, int index) {
  const float alpha = order.alpha();
  const float beta = order.beta();
  Gradients& cg = vectors(index);
  cg.p = base::sum_of(cg.z, beta, cg.p);
  cg.s = base::sum_of(cg.w, beta, cg.s);
  cg.g = base::sum_of(cg.g, alpha, cg.p);
  cg.r = base::sum_of(cg.r, -alpha, cg.s);
  precondition(ws, index, order.count, index < joined_count(ws, planned_part(ws, order)));
}

/// The first term of the preconditioner: z = M^-1 r, scaled; w holds what is left of r.
void KrylovAndJacobi::precondition(Workspace& ws, int index, int degree, bool is_joined) {
  Node& node = ws.node(index);
  Gradients& cg = vectors(index);
  const Interval interval(degree);
  const auto scale = static_cast<float>(degree == 0 || !is_joined ? 1 : 1 / interval.centre);
  base::Vec6<float> first = solve_diagonal(node, cg.r);
  for (float& value : first) {
    value *= scale;
  }
  node.vector.sent = first;
  cg.z = first;
  cg.w = cg.r;
  rho_ = static_cast<float>(degree == 0 ? 0 : interval.half / interval.centre);
}

void KrylovAndJacobi::share_correction(Workspace& ws) const {
  for (int i = 0; i < ws.node_count(); ++i) {
    ws.node(i).vector.sent = vectors(i).g;
  }
}

/// What the beams make of the vectors that have been exchanged.
void KrylovAndJacobi::find_images(Workspace& ws, const Order& order) {
  for (int i = 0; i < ws.node_count(); ++i) {
    vectors(i).image = {};
  }
  const PlannedPart part = planned_part(ws, order);
  Beams<float> beams = ws.setup.beams_float();
  const base::Vec6<float>& mine = ws.node(0).vector.sent;
  // A planned module that has stood apart has all terms to catch up with.
  const base::Vec6<float>& whole =
      ws.planned.is_any_remote() && is_preconditioned(order.operation) ? vectors(0).z : mine;
  visit_beams(ws, part, [&](Direction face, const base::Vec6<float>* other, int k) {
    // A planned module that stands apart stands still.
    const base::Vec6<float> theirs = other == nullptr ? base::Vec6<float>{} : *other;
    base::add_to(vectors(0).image, end_force(beams, face, mine, theirs));
    if (k >= 0 && other != nullptr) {
      ws.planned_exchange.add_force(
          ws.planned, k,
          base::converted<double>(end_force(beams, base::opposite(face), theirs, whole)));
    }
  });
  if (part == PlannedPart::kTogether) {
    add_planned_beams(ws);
    for (int i = 1; i < ws.node_count(); ++i) {
      vectors(i).image =
          base::converted<float>(ws.planned_exchange.force(ws.planned, ws.planned.hosted(i - 1)));
    }
  }
}

/// The next term of the preconditioner, and after the last one w = A z.
void KrylovAndJacobi::next_term(Workspace& ws, const Order& order, int index) {
  const Interval interval(order.count);
  const double sigma = interval.half > 0 ? interval.centre / interval.half : 1;
  const double rho = 1 / (2 * sigma - static_cast<double>(rho_));
  const auto keep = static_cast<float>(rho * static_cast<double>(rho_));
  const auto gain = static_cast<float>(interval.half > 0 ? 2 * rho / interval.half : 0);
  const bool is_last = ws.exchange.left() == 1;
  Node& node = ws.node(index);
  Gradients& cg = vectors(index);
  if (index + 1 == joined_count(ws, planned_part(ws, order))) {
    rho_ = static_cast<float>(rho);
  }
  if (node.is_fixed) {
    cg.w = {};
    return;
  }
  if (node.is_ground) {
    base::add_to(cg.image, base::converted<float>(symmetric_facet_product(
                               node, ws.contact, base::converted<double>(node.vector.sent))));
  }
  cg.w = base::sum_of(cg.w, -1.0F, cg.image);
  if (is_last) {
    cg.w = base::sum_of(cg.r, -1.0F, cg.w);
    return;
  }
  node.vector.sent = base::combination(keep, node.vector.sent, gain, solve_diagonal(node, cg.w));
  base::add_to(cg.z, node.vector.sent);
}

/// One iteration of Eq. (14), written for the correction g: g := g + beta D^-1 r(u + g), with the
/// facet in the state that the law prescribes at u + g. With u = 0 it is Eq. (14) as printed.
void KrylovAndJacobi::iterate_jacobi(Workspace& ws) {
  double error = 0;
  for (int i = 0; i < ws.node_count(); ++i) {
    if (!ws.node(i).is_fixed) {
      iterate_jacobi(ws, i, error);
    }
  }
  is_first_iteration_ = false;
  jacobi_error_ = static_cast<float>(error);
}

void KrylovAndJacobi::iterate_jacobi(Workspace& ws, int index, double& error) {
  Node& node = ws.node(index);
  Gradients& cg = vectors(index);
  base::Vec6<float> rest{};
  const base::Vec6<double> here = facet_force_along(node, ws.contact, cg.g, 1);
  const base::Vec6<double> start = facet_force_along(node, ws.contact, cg.g, 0);
  for (std::size_t k = 0; k < 6; ++k) {
    rest[k] = cg.r_start[k] - cg.image[k] - static_cast<float>(here[k] - start[k]);
  }
  if (look_up_states(node, ws.contact, cg.g, 1) && !is_first_iteration_) {
    take_states(node);
    if (is_scalar_) {
      cg.p = scalar_diagonal(node, ws.setup, ws.contact, ws.faces_of(index));
    } else {
      form_diagonal(node, ws.setup, ws.contact, ws.faces_of(index), 0);
      form_diagonal(node, ws.setup, ws.contact, ws.faces_of(index), 1);
      factor_diagonal(node, 0);
      factor_diagonal(node, 1);
    }
  }
  error += ratio_error(base::converted<double>(rest), ws.setup, ws.contact);
  const base::Vec6<float> correction = is_scalar_ ? rest : solve_diagonal(node, rest);
  for (std::size_t k = 0; k < 6; ++k) {
    cg.g[k] +=
        static_cast<float>(kJacobiWeight) * (is_scalar_ ? correction[k] / cg.p[k] : correction[k]);
  }
  node.vector.sent = cg.g;
}

/// Error bound, facets that want another state, their hash, node by node; largest load ratio.
bool KrylovAndJacobi::report_residual(Workspace& ws, const Order& order, int piece,
                                      Report& report) {
  if (piece == ws.node_count()) {
    report.reals[1] = largest_load_ratio(ws);
    return false;
  }
  Node& node = ws.node(piece);
  if (look_up_states(node, ws.contact, vectors(piece).g, 0)) {
    ++report.extent;
    if ((order.flags & kFollowStates) != 0) {
      take_states(node);
    }
  }
  report_facet(report, ws, piece);
  const base::Vec6<double> rest = residual(ws, piece);
  report.reals[0] += static_cast<float>(ratio_error(rest, ws.setup, ws.contact));
  vectors(piece).r = base::converted<float>(rest);
  return true;
}

/// (r, z), (z, w), and the bound on the error that r means.
void KrylovAndJacobi::report_products(const Workspace& ws, Report& report) const {
  double error = 0;
  for (int i = 0; i < ws.node_count(); ++i) {
    const Gradients& cg = vectors(i);
    report.reals[0] += base::dot(cg.r, cg.z);
    report.reals[1] += base::dot(cg.z, cg.w);
    error +=
        ws.node(i).is_fixed ? 0 : ratio_error(base::converted<double>(cg.r), ws.setup, ws.contact);
  }
  report.reals[2] = static_cast<float>(error);
}

/// The slope of the energy along g, at t = 0 and at four places in (low, high].
bool KrylovAndJacobi::report_slopes(const Workspace& ws, const Order& order, int piece,
                                    Report& report) {
  const int index = piece / kSlopePlaces;
  const int place = piece % kSlopePlaces;
  double& sum = slopes_[static_cast<std::size_t>(place)];
  sum = index == 0 ? 0 : sum;
  const Node& node = ws.node(index);
  const Gradients& cg = vectors(index);
  if (!node.is_fixed) {
    // Node by node the sum is small near the equilibrium, so its digits are good.
    const auto low = static_cast<double>(order.low());
    const auto high = static_cast<double>(order.high());
    const double t = place == 0 ? 0 : low + (high - low) * place / (kSlopePlaces - 1);
    base::Vec6<double> rest = facet_force_along(node, ws.contact, cg.g, t);
    base::Vec6<double> load = load_of(node, ws.setup);
    if (const base::Vec6<double>* hung = hung_on(ws, index); hung != nullptr) {
      base::add_to(load, *hung);
    }
    double slope = 0;
    for (std::size_t k = 0; k < 6; ++k) {
      rest[k] -= load[k];
      rest[k] += node.force[k] + t * static_cast<double>(cg.image[k]);
      slope += rest[k] * static_cast<double>(cg.g[k]);
    }
    sum += slope;
  }
  report.reals[static_cast<std::size_t>(place)] = static_cast<float>(sum);
  return piece + 1 < kSlopePlaces * ws.node_count();
}

/// (dg, r) and (dg, dr), d: the change since the solve before.
void KrylovAndJacobi::report_mix(const Workspace& ws, Report& report) const {
  for (int i = 0; i < ws.node_count(); ++i) {
    const Gradients& cg = vectors(i);
    for (std::size_t k = 0; k < 6; ++k) {
      const float change = cg.g[k] - cg.g_before[k];
      report.reals[0] += change * cg.r_start[k];
      report.reals[1] += change * (cg.r_start[k] - cg.r_before[k]);
    }
  }
}

}  // namespace holdfast::agent
