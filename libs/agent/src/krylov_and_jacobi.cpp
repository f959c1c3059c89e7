// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "holdfast/agent/krylov_and_jacobi.hpp"

#include "beams.hpp"
#include "chebyshev.hpp"
#include "condensed.hpp"
#include "displacements.hpp"

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

void KrylovAndJacobi::begin(Workspace& ws, const Order& order) {
  switch (order.operation) {
    case Operation::kBegin:
      begin_equilibrium(ws, order);
      for (int i = 0; i < ws.node_count(); ++i) {
        vectors(i) = gradients_at_rest(ws.node(i), ws.setup);
      }
      break;
    case Operation::kHigh:
      return move(ws, order);
    case Operation::kLow:
      return share_low_part(ws);
    case Operation::kStart:
      return start_solve(ws, order);
    case Operation::kGradient:
      return iterate_gradient(ws, order);
    case Operation::kJacobi:
    case Operation::kSlope:
      return share_correction(ws);
    default:
      break;
  }
}

void KrylovAndJacobi::take_exchange(Workspace& ws, const Order& order) {
  if (order.operation == Operation::kHigh || order.operation == Operation::kLow) {
    add_forces(ws, PlannedPart::kTogether);
    return;
  }
  find_images(ws, order);
  if (order.operation == Operation::kJacobi) {
    iterate_jacobi(ws);
  } else if (is_preconditioned(order.operation)) {
    next_terms(ws, order);
  }
}

Report KrylovAndJacobi::report(Workspace& ws, const Order& order) {
  switch (order.operation) {
    case Operation::kLow:
      return residual_report(ws, order);
    case Operation::kStart:
    case Operation::kGradient:
      return product_report(ws);
    case Operation::kJacobi: {
      Report report;
      report.reals[0] = jacobi_error_;
      return report;
    }
    case Operation::kSlope:
      return (order.flags & kMixProducts) != 0 ? mix_report(ws) : slope_report(ws, order);
    case Operation::kHold:
      return hold_report(ws, order);
    default:
      return {};
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
  ws.middle = {};
}

void KrylovAndJacobi::start_solve(Workspace& ws, const Order& order) {
  is_scalar_ = (order.flags & kWithScalars) != 0;
  is_first_iteration_ = true;
  const int joined = joined_count(ws, planned_part(ws, order));
  for (int i = 0; i < ws.node_count(); ++i) {
    Node& node = ws.node(i);
    Gradients& cg = vectors(i);
    if ((order.flags & kAdoptStates) != 0) {
      node.state = node.wanted;
      cg.r = base::converted<float>(residual(node, ws.setup, ws.contact));
    }
    cg.r_before = cg.r_start;
    cg.r_start = cg.r;
    cg.g_before = cg.g;
    cg.g = {};
    cg.p = {};
    cg.s = {};
    factor_diagonal(node, ws.setup, ws.contact, ws.faces_of(i));
    precondition(ws, i, order.count, i < joined);
    if (is_scalar_) {
      cg.p = scalar_diagonal(node, ws.setup, ws.contact, ws.faces_of(i));
    }
  }
}

/// p := z + beta p, s := w + beta s, g := g + alpha p, r := r - alpha s, z := M^-1 r.
void KrylovAndJacobi::iterate_gradient(Workspace& ws, const Order& order) {
  const float alpha = order.alpha();
  const float beta = order.beta();
  const int joined = joined_count(ws, planned_part(ws, order));
  for (int i = 0; i < ws.node_count(); ++i) {
    Gradients& cg = vectors(i);
    for (std::size_t k = 0; k < 6; ++k) {
      cg.p[k] = cg.z[k] + beta * cg.p[k];
      cg.s[k] = cg.w[k] + beta * cg.s[k];
      cg.g[k] += alpha * cg.p[k];
      cg.r[k] -= alpha * cg.s[k];
    }
    precondition(ws, i, order.count, i < joined);
  }
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
  const mechanics::BeamStiffness<float>& beam = ws.setup.beam_float;
  const base::Vec6<float>& mine = ws.node(0).vector.sent;
  // A planned module that has stood apart has all terms to catch up with.
  const base::Vec6<float>& whole =
      ws.planned.is_any_remote() && is_preconditioned(order.operation) ? vectors(0).z : mine;
  visit_beams(ws, part, [&](Direction face, const base::Vec6<float>* other, int k) {
    // A planned module that stands apart stands still.
    const base::Vec6<float> theirs = other == nullptr ? base::Vec6<float>{} : *other;
    base::add_to(vectors(0).image, mechanics::end_force(beam, face, mine, theirs));
    if (k >= 0 && other != nullptr) {
      ws.planned_exchange.add_force(k, base::converted<double>(mechanics::end_force(
                                           beam, base::opposite(face), theirs, whole)));
    }
  });
  if (part == PlannedPart::kTogether) {
    add_planned_beams(ws);
    for (int i = 1; i < ws.node_count(); ++i) {
      vectors(i).image =
          base::converted<float>(ws.planned_exchange.force(ws.planned.hosted(i - 1)));
    }
  }
}

/// The next term of the preconditioner, and after the last one w = A z.
void KrylovAndJacobi::next_terms(Workspace& ws, const Order& order) {
  const Interval interval(order.count);
  const double sigma = interval.half > 0 ? interval.centre / interval.half : 1;
  const double rho = 1 / (2 * sigma - static_cast<double>(rho_));
  const auto keep = static_cast<float>(rho * static_cast<double>(rho_));
  const auto gain = static_cast<float>(interval.half > 0 ? 2 * rho / interval.half : 0);
  const bool is_last = ws.exchange.left() == 1;
  const int joined = joined_count(ws, planned_part(ws, order));
  for (int i = 0; i < joined; ++i) {
    Node& node = ws.node(i);
    Gradients& cg = vectors(i);
    if (node.is_fixed) {
      cg.w = {};
      continue;
    }
    if (node.is_ground) {
      base::add_to(cg.image, base::converted<float>(mechanics::symmetric_product(
                                 ws.contact.facet, node.state, node.is_held,
                                 base::converted<double>(node.vector.sent))));
    }
    for (std::size_t k = 0; k < 6; ++k) {
      cg.w[k] -= cg.image[k];
    }
    if (is_last) {
      for (std::size_t k = 0; k < 6; ++k) {
        cg.w[k] = cg.r[k] - cg.w[k];
      }
      continue;
    }
    base::Vec6<float> term = solve_diagonal(node, cg.w);
    for (std::size_t k = 0; k < 6; ++k) {
      term[k] = keep * node.vector.sent[k] + gain * term[k];
    }
    node.vector.sent = term;
    base::add_to(cg.z, term);
  }
  rho_ = static_cast<float>(rho);
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
  const mechanics::ContactState state = state_along(node, ws.contact, cg.g, 1);
  if (node.is_ground && !is_first_iteration_ && !(state == node.state)) {
    node.state = state;
    if (is_scalar_) {
      cg.p = scalar_diagonal(node, ws.setup, ws.contact, ws.faces_of(index));
    } else {
      factor_diagonal(node, ws.setup, ws.contact, ws.faces_of(index));
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

/// Error bound, largest load ratio, facets that want another state, their hash.
Report KrylovAndJacobi::residual_report(Workspace& ws, const Order& order) {
  Report report;
  for (int i = 0; i < ws.node_count(); ++i) {
    Node& node = ws.node(i);
    node.wanted = state_along(node, ws.contact, vectors(i).g, 0);
    if (node.is_ground && !(node.wanted == node.state)) {
      ++report.extent;
      if ((order.flags & kFollowStates) != 0) {
        node.state = node.wanted;
      }
    }
    report_facet(report, ws.cell_of(i), node);
    const base::Vec6<double> rest = residual(node, ws.setup, ws.contact);
    report.reals[0] += static_cast<float>(ratio_error(rest, ws.setup, ws.contact));
    vectors(i).r = base::converted<float>(rest);
  }
  report.reals[1] = largest_load_ratio(ws);
  return report;
}

/// (r, z), (z, w), and the bound on the error that r means.
Report KrylovAndJacobi::product_report(const Workspace& ws) const {
  float residual_product = 0;
  float image_product = 0;
  double error = 0;
  for (int i = 0; i < ws.node_count(); ++i) {
    const Gradients& cg = vectors(i);
    residual_product += base::dot(cg.r, cg.z);
    image_product += base::dot(cg.z, cg.w);
    error +=
        ws.node(i).is_fixed ? 0 : ratio_error(base::converted<double>(cg.r), ws.setup, ws.contact);
  }
  Report report;
  report.reals[0] = residual_product;
  report.reals[1] = image_product;
  report.reals[2] = static_cast<float>(error);
  return report;
}

/// The slope of the energy along g, at t = 0 and at four places in (low, high].
Report KrylovAndJacobi::slope_report(const Workspace& ws, const Order& order) const {
  const auto low = static_cast<double>(order.low());
  const auto high = static_cast<double>(order.high());
  std::array<double, 5> sums{};
  for (int i = 0; i < ws.node_count(); ++i) {
    const Node& node = ws.node(i);
    const Gradients& cg = vectors(i);
    if (node.is_fixed) {
      continue;
    }
    // Node by node the sum is small near the equilibrium, so its digits are good.
    for (int place = 0; place <= 4; ++place) {
      const double t = place == 0 ? 0 : low + (high - low) * place / 4;
      base::Vec6<double> rest = facet_force_along(node, ws.contact, cg.g, t);
      rest[2] += ws.setup.weight_n;
      double slope = 0;
      for (std::size_t k = 0; k < 6; ++k) {
        rest[k] += node.force[k] + t * static_cast<double>(cg.image[k]);
        slope += rest[k] * static_cast<double>(cg.g[k]);
      }
      sums[static_cast<std::size_t>(place)] += slope;
    }
  }
  Report report;
  for (std::size_t i = 0; i < sums.size(); ++i) {
    report.reals[i] = static_cast<float>(sums[i]);
  }
  return report;
}

/// (dg, r) and (dg, dr), d: the change since the solve before.
Report KrylovAndJacobi::mix_report(const Workspace& ws) const {
  Report report;
  for (int i = 0; i < ws.node_count(); ++i) {
    const Gradients& cg = vectors(i);
    for (std::size_t k = 0; k < 6; ++k) {
      const float change = cg.g[k] - cg.g_before[k];
      report.reals[0] += change * cg.r_start[k];
      report.reals[1] += change * (cg.r_start[k] - cg.r_before[k]);
    }
  }
  return report;
}

/// Releases open facets and holds pressed ones (count: how many changed); number: open but held.
Report KrylovAndJacobi::hold_report(Workspace& ws, const Order& order) {
  Report report;
  for (int i = 0; i < ws.node_count(); ++i) {
    Node& node = ws.node(i);
    if (!node.is_ground) {
      continue;
    }
    const bool frees = (order.flags & kFreeOpen) != 0;
    if (!node.state.pressed && node.is_held && (frees || !node.was_released)) {
      node.is_held = false;
      node.was_released = true;
      ++report.count;
    } else if (node.state.pressed && !node.is_held && !frees) {
      node.is_held = true;
      ++report.count;
    }
    report.number += !node.state.pressed && node.is_held ? 1U : 0U;
  }
  return report;
}

}  // namespace holdfast::agent
