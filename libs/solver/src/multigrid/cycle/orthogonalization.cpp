// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <utility>

#include "factorization/block_kernels.hpp"
#include "multigrid/cycle/conjugate_gradients.hpp"

namespace holdfast::solver {
namespace {

/// All directions are remembered where these bytes are enough for kEnough of them.
constexpr std::size_t kMemoryBytes = std::size_t{4} << 20U;
constexpr std::size_t kEnough = 64;

/// An estimate of the error that falls by more than this in one step fell by chance.
constexpr double kFallMax = 1e4;

/// A curvature that is so small a share of what it is the difference of is computed anew.
constexpr double kCancelled = 1e-3;

bool is_curvature(double number) { return number != 0 && std::isfinite(number); }

template <class Real>
base::Vec6<double> at_node(const Six<Real>* vector, const NodeTerm& term) {
  base::Vec6<double> value{};
  for (std::size_t k = 0; k < 6; ++k) {
    value[k] = static_cast<double>(vector[static_cast<std::size_t>(term.node)].v[k]);
  }
  return value;
}

/// q += (A - K) p; returns p . (A - K) p.
template <class Real>
double add_terms(std::span<const NodeTerm> terms, const Six<Real>* p, std::vector<double>& q) {
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

/// p . (A - K) z
template <class Real>
double sum_of_products(std::span<const NodeTerm> terms, const Six<Real>* p, const Six<Real>* z) {
  double sum = 0;
  for (const NodeTerm& term : terms) {
    sum += base::dot(at_node(p, term), base::multiply(term.difference, at_node(z, term)));
  }
  return sum;
}

/// p . A z - z . A p
template <class Real>
double asymmetry(std::span<const NodeTerm> terms, const Six<Real>* p, const Six<Real>* z) {
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

template <class Real>
Iteration::End ConjugateGradients<Real>::run_unsymmetric(const Goal& goal,
                                                         std::span<const NodeTerm> terms) {
  has_last_direction_ = false;
  const double node_count = host::max(hierarchy_.ranks(0), static_cast<double>(node_count_));
  const double direction_bytes = 2 * sizeof(Six<Real>) * node_count;
  const auto direction_count = static_cast<std::size_t>(kMemoryBytes / direction_bytes);
  return direction_count < kEnough ? run_by_last_direction(goal, terms)
                                   : run_by_all_directions(goal, terms, direction_count);
}

/// Whether the goal is reached, and not by an estimate of the error that fell by chance.
template <class Real>
bool ConjugateGradients<Real>::is_still_reached(const Goal& goal, int iteration, double before) {
  return is_reached(goal, iteration) && std::abs(before) <= kFallMax * goal.error;
}

template <class Real>
Iteration::End ConjugateGradients<Real>::run_by_last_direction(const Goal& goal,
                                                               std::span<const NodeTerm> terms) {
  double before = error_;
  for (int iteration = 0; !is_still_reached(goal, iteration, before); ++iteration) {
    if (is_stuck(goal, iteration)) {
      return End::kTooSlow;
    }
    before = error_;
    if (!(is_product_kept() ? go_on_with_product(terms) : go_on_without_product(terms))) {
      return End::kBroken;
    }
    tell();
  }
  return error_ >= 0 ? End::kConverged : End::kBroken;
}

// As for a symmetric matrix, but for q = A p.
template <class Real>
bool ConjugateGradients<Real>::go_on_with_product(std::span<const NodeTerm> terms) {
  if (curvature_) {
    turn_to_curvature(terms);  // The last iteration kept no product.
  }
  turn();
  const double symmetric_part = multiply();
  const double curvature = symmetric_part + sum(add_terms(terms, p_.data(), q_));
  if (!is_curvature(curvature)) {
    return false;
  }
  // r . z but for rounding, which must not add up.
  const double force = sum(own_residual_dot(p_));
  advance(force / curvature);
  const auto [error, change] = precondition_and_compare();
  error_ = error;
  turn_ = -(change + sum(asymmetry(terms, p_.data(), preconditioned().data()))) / curvature;
  return true;
}

// As for a symmetric matrix; curvature_ is that of K.
template <class Real>
bool ConjugateGradients<Real>::go_on_without_product(std::span<const NodeTerm> terms) {
  q_ = std::vector<double>();
  hierarchy_.take_vectors();
  const double symmetric_part = turn_to_curvature(terms);
  const double curvature = symmetric_part + sum_of_products(terms, p_.data(), p_.data());
  if (!is_curvature(curvature)) {
    return false;
  }
  const double step = own_residual_dot(p_) / curvature;
  curvature_ = advance_by_product(step);
  for (const NodeTerm& term : terms) {
    const auto node = static_cast<std::size_t>(term.node);
    const base::Vec6<double> part = base::multiply(term.difference, at_node(p_.data(), term));
    base::Vec6<double> left = residual(node);
    for (std::size_t k = 0; k < 6; ++k) {
      left[k] -= step * part[k];
    }
    set_residual(node, left);
  }
  error_ = precondition();
  return true;
}

/// p := z + turn p, by which p_old . A p = 0; returns p . K p,
///   z . K z + 2 turn p . K z + turn^2 p . K p
///     = z . K z - (p . K z)^2 / p . K p + p . K p (turn + p . K z / p . K p)^2,
/// whose last term is zero where A = K; but for the rounding of p, which x and r take into account
/// both.
template <class Real>
double ConjugateGradients<Real>::turn_to_curvature(std::span<const NodeTerm> terms) {
  if (!curvature_) {
    turn();
    return compare(p_)[0];
  }
  const double last = *std::exchange(curvature_, std::nullopt);
  const auto [own, change] = compare(preconditioned());
  const double turn_by = -(change + sum_of_products(terms, p_.data(), preconditioned().data())) /
                         (last + sum_of_products(terms, p_.data(), p_.data()));
  turn_ = turn_by;
  turn();
  const double beside = turn_by + change / last;
  const double curvature = own - change * change / last + last * beside * beside;
  return curvature > kCancelled * own ? curvature : compare(p_)[0];
}

/// p := z, less what older directions answer for: p_old . A p = 0.
template <class Real>
void ConjugateGradients<Real>::turn_away_from(const std::vector<Direction>& older) {
  write_gain();
  turn_.reset();
  curvature_.reset();
  p_.assign(preconditioned().begin(), preconditioned().end());
  for (const Direction& old : older) {
    const double product = sum(team_.sum(node_count_, [&](std::size_t begin, std::size_t end) {
      return kernels<Real>().dot_same(old.image.data(), p_.data(), {begin, end});
    }));
    const auto turn = static_cast<Real>(-product / old.curvature);
    team_.share(0, node_count_, [&](std::size_t begin, std::size_t end) {
      kernels<Real>().combine(turn, old.p.data(), 1, p_.data(), {begin, end});
    });
  }
}

/// q := A p. Returns p with what later directions have to know of it.
template <class Real>
auto ConjugateGradients<Real>::multiply_direction(std::span<const NodeTerm> terms) -> Direction {
  Direction direction;
  direction.curvature = multiply();
  direction.p = p_;
  direction.image.resize(node_count_);
  const auto round = [&](std::size_t node, const base::Vec6<double>& more) {
    for (std::size_t k = 0; k < 6; ++k) {
      direction.image[node].v[k] = static_cast<Real>(q_[6 * node + k] + more[k]);
    }
  };
  team_.share(0, node_count_, [&](std::size_t begin, std::size_t end) {
    for (std::size_t node = begin; node < end; ++node) {
      round(node, {});
    }
  });
  for (const NodeTerm& term : terms) {
    round(static_cast<std::size_t>(term.node),
          base::multiply(transpose(term.difference), at_node(p_.data(), term)));
  }
  direction.curvature += sum(add_terms(terms, p_.data(), q_));
  return direction;
}

template <class Real>
Iteration::End ConjugateGradients<Real>::run_by_all_directions(const Goal& goal,
                                                               std::span<const NodeTerm> terms,
                                                               std::size_t direction_count) {
  // The last run's directions would count on, if r were free of them to the last digit: it is not.
  std::vector<Direction> older;
  double before = error_;
  for (int iteration = 0; !is_still_reached(goal, iteration, before); ++iteration) {
    if (is_stuck(goal, iteration)) {
      return End::kTooSlow;
    }
    turn_away_from(older);
    if (older.size() == direction_count) {
      older.erase(older.begin());
    }
    older.push_back(multiply_direction(terms));
    const double curvature = older.back().curvature;
    if (!is_curvature(curvature)) {
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
template double ConjugateGradients<float>::turn_to_curvature(std::span<const NodeTerm>);
template double ConjugateGradients<double>::turn_to_curvature(std::span<const NodeTerm>);

}  // namespace holdfast::solver
