// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include "conjugate_gradients.hpp"

namespace holdfast::solver {
namespace {

/// An estimate of the error that falls by more than this in one step fell by chance.
constexpr double kFallMax = 1e4;

template <class Real>
base::Vec6<double> at_node(const std::vector<Six<Real>>& vector, const NodeTerm& term) {
  base::Vec6<double> value{};
  for (std::size_t k = 0; k < 6; ++k) {
    value[k] = static_cast<double>(vector[static_cast<std::size_t>(term.node)].v[k]);
  }
  return value;
}

/// q += (A - K) p; returns p . (A - K) p.
template <class Real>
double add_terms(std::span<const NodeTerm> terms, const std::vector<Six<Real>>& p,
                 std::vector<double>& q) {
  double sum = 0;
  for (const NodeTerm& term : terms) {
    const base::Vec6<double> own = at_node(p, term);
    const base::Vec6<double> part = base::multiply(term.difference, own);
    for (std::size_t k = 0; k < 6; ++k) {
      q[6 * static_cast<std::size_t>(term.node) + k] += part[k];
    }
    sum += base::dot(own, part);
  }
  return sum;
}

/// p . A z - z . A p
template <class Real>
double asymmetry(std::span<const NodeTerm> terms, const std::vector<Six<Real>>& p,
                 const std::vector<Six<Real>>& z) {
  double sum = 0;
  for (const NodeTerm& term : terms) {
    const base::Vec6<double> from = at_node(p, term);
    const base::Vec6<double> to = at_node(z, term);
    sum += base::dot(from, base::multiply(term.difference, to)) -
           base::dot(to, base::multiply(term.difference, from));
  }
  return sum;
}

}  // namespace

// As in iterate(), but for q = A p.
template <class Real>
Iteration::End ConjugateGradients<Real>::run_unsymmetric(const Goal& goal,
                                                         std::span<const NodeTerm> terms) {
  has_last_direction_ = false;
  double before = error_;
  for (int iteration = 0; !is_reached(goal, iteration) || std::abs(before) > kFallMax * goal.error;
       ++iteration) {
    if (is_stuck(goal, iteration)) {
      return End::kTooSlow;
    }
    turn();
    const double symmetric_part = multiply();
    const double curvature = symmetric_part + sum(add_terms(terms, p_, q_));
    if (curvature == 0 || !std::isfinite(curvature)) {
      return End::kBroken;
    }
    before = error_;
    // r . z but for rounding, which must not add up.
    const double force = sum(own_residual_dot(p_));
    advance(force / curvature);
    const auto [error, change] = precondition_and_compare();
    error_ = error;
    turn_ = -(change + sum(asymmetry(terms, p_, hierarchy_.levels().front().z))) / curvature;
    tell();
  }
  return error_ >= 0 ? End::kConverged : End::kBroken;
}

template Iteration::End ConjugateGradients<float>::run_unsymmetric(const Goal&,
                                                                   std::span<const NodeTerm>);
template Iteration::End ConjugateGradients<double>::run_unsymmetric(const Goal&,
                                                                    std::span<const NodeTerm>);

}  // namespace holdfast::solver
