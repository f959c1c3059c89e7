// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include "conjugate_gradients.hpp"

namespace holdfast::solver {
namespace {

/// Directions are remembered, for all of them together no more than so many bytes, but two in any
/// case; then the oldest are dropped. What the preconditioner does not know of A is that a tilting
/// facet's torque follows its pressure, and that hardly needs older ones: growth, portals, tunnels
/// and shells take the same iterations with one, two or all.
constexpr std::size_t kMemoryBytes = std::size_t{4} << 20U;
constexpr std::size_t kMemoryMin = 2;
template <class Real>
constexpr std::size_t kNodeBytes = 2 * sizeof(Six<Real>);

/// An estimate of the error that falls by more than this in one step fell by chance.
constexpr double kFallMax = 1e4;

/// Adds a difference times p at the nodes that have one, by add(number, part); returns p times
/// that.
template <class Real, class Add>
double add_terms(std::span<const NodeTerm> terms, Mat NodeTerm::*difference,
                 const std::vector<Six<Real>>& p, const Add& add) {
  double sum = 0;
  for (const NodeTerm& term : terms) {
    const auto node = static_cast<std::size_t>(term.node);
    for (int row = 0; row < 6; ++row) {
      for (int column = 0; column < 6; ++column) {
        const double part =
            (term.*difference).at(row, column) * static_cast<double>(p[node].v[column]);
        add(6 * node + static_cast<std::size_t>(row), part);
        sum += part * static_cast<double>(p[node].v[row]);
      }
    }
  }
  return sum;
}

}  // namespace

/// p := z, less what an older direction answers for: p_old . A p = 0.
template <class Real>
void ConjugateGradients<Real>::turn_away_from_older() {
  write_marked();
  turn_.reset();
  curvature_.reset();
  p_ = hierarchy_.levels().front().z;
  for (const Direction& old : older_) {
    const double product = sum(team_.sum(node_count_, [&](std::size_t begin, std::size_t end) {
      return kernels<Real>().dot_same(old.image.data(), p_.data(), {begin, end});
    }));
    const auto turn = static_cast<Real>(-product / old.curvature);
    team_.share(0, node_count_, [&](std::size_t begin, std::size_t end) {
      kernels<Real>().combine(turn, old.p.data(), 1, p_.data(), {begin, end});
    });
  }
}

/// q := A p; remembers p and A^T p. Returns p . A p.
template <class Real>
double ConjugateGradients<Real>::remember_direction(std::span<const NodeTerm> terms) {
  const double symmetric_part = multiply();
  const auto node_count_max =
      static_cast<std::size_t>(host::max(hierarchy_.ranks(0), static_cast<double>(node_count_)));
  if (older_.size() >= std::max(kMemoryMin, kMemoryBytes / (kNodeBytes<Real> * node_count_max))) {
    std::rotate(older_.begin(), older_.begin() + 1, older_.end());
  } else {
    older_.emplace_back();
  }
  Direction& newest = older_.back();
  newest.p = p_;
  newest.image.resize(node_count_);
  team_.share(0, node_count_, [&](std::size_t begin, std::size_t end) {
    for (std::size_t node = begin; node < end; ++node) {
      for (std::size_t k = 0; k < 6; ++k) {
        newest.image[node].v[k] = static_cast<Real>(q_[6 * node + k]);
      }
    }
  });
  add_terms(terms, &NodeTerm::transposed_difference, p_, [&](std::size_t i, double part) {
    Real& rounded = newest.image[i / 6].v[i % 6];
    rounded = static_cast<Real>(static_cast<double>(rounded) + part);
  });
  const auto add = [&](std::size_t i, double part) { q_[i] += part; };
  newest.curvature = symmetric_part + sum(add_terms(terms, &NodeTerm::difference, p_, add));
  return newest.curvature;
}

template <class Real>
Iteration::End ConjugateGradients<Real>::run_unsymmetric(const Goal& goal,
                                                         std::span<const NodeTerm> terms) {
  // The last run's directions would count on, if r were free of them to the last digit: it is not.
  older_.clear();
  has_last_direction_ = false;
  double before = error_;
  for (int iteration = 0; !is_reached(goal, iteration) || std::abs(before) > kFallMax * goal.error;
       ++iteration) {
    if (is_stuck(goal, iteration)) {
      return End::kTooSlow;
    }
    turn_away_from_older();
    const double curvature = remember_direction(terms);
    if (curvature == 0 || !std::isfinite(curvature)) {
      return End::kBroken;
    }
    before = error_;
    // r . z but for rounding, which must not add up.
    const double force = sum(own_residual_dot(p_));
    advance(force / curvature);
    error_ = precondition();
    tell();
  }
  return error_ >= 0 ? End::kConverged : End::kBroken;
}

template Iteration::End ConjugateGradients<float>::run_unsymmetric(const Goal&,
                                                                   std::span<const NodeTerm>);
template Iteration::End ConjugateGradients<double>::run_unsymmetric(const Goal&,
                                                                    std::span<const NodeTerm>);

}  // namespace holdfast::solver
