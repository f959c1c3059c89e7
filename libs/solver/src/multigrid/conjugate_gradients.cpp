// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "conjugate_gradients.hpp"

#include <utility>

namespace holdfast::solver {
namespace {

/// Gauss-Seidel sweeps before and after the coarse correction. One needs twice the iterations; a
/// third saves few.
constexpr int kSweepCount = 2;

/// An error so far below the one sought, both squared, may be rounding, which no step improves.
constexpr double kRounding = 0.01;

/// After so many iterations that gained nothing only rounding is left.
constexpr int kPatience = 50;

}  // namespace

template <class Real>
ConjugateGradients<Real>::ConjugateGradients(const ReducedNetwork& network,
                                             const model::Material& material, Team& team,
                                             const GroundTable& ground,
                                             std::span<const std::int32_t> alone)
    : Iteration(network.node_count),
      team_(team),
      hierarchy_(network, material, team, ground, alone),
      cycle_(hierarchy_, team, kSweepCount),
      node_count_(network.node_count),
      q_(6 * node_count_),
      p_(node_count_ + 1) {}

/// x is taken apart into two directions: 48 bits in single precision, all in double.
template <class Real>
void ConjugateGradients<Real>::subtract_product() {
  for (const bool is_rest : {false, true}) {
    team_.share(0, node_count_, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = 6 * begin; i < 6 * end; ++i) {
        const auto upper = static_cast<Real>(x_[i]);
        p_[i / 6].v[i % 6] =
            is_rest ? static_cast<Real>(x_[i] - static_cast<double>(upper)) : upper;
      }
    });
    team_.share(0, node_count_, [&](std::size_t begin, std::size_t end) {
      hierarchy_.apply(p_.data(), q_.data(), {begin, end});
      for (std::size_t i = 6 * begin; i < 6 * end; ++i) {
        r_[i] -= q_[i];
      }
    });
  }
}

template <class Real>
void ConjugateGradients<Real>::round_residual() {
  Level<Real>& finest = hierarchy_.levels().front();
  team_.share(0, node_count_, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = 6 * begin; i < 6 * end; ++i) {
      finest.r[i / 6].v[i % 6] = static_cast<Real>(r_[i]);
    }
  });
}

template <class Real>
double ConjugateGradients<Real>::dot_with_z(const std::vector<double>& a) {
  const std::vector<Six<Real>>& z = hierarchy_.levels().front().z;
  return team_.sum(node_count_, [&](std::size_t begin, std::size_t end) {
    return kernels<Real>().dot(a.data(), z.data(), {begin, end});
  });
}

/// z = M^-1 r; returns r . z.
template <class Real>
double ConjugateGradients<Real>::precondition() {
  cycle_.run();
  return dot_with_z(r_);
}

template <class Real>
double ConjugateGradients<Real>::begin() {
  older_ = {};
  round_residual();
  error_ = precondition();
  p_ = hierarchy_.levels().front().z;
  return error_;
}

template <class Real>
base::Vec6<double> ConjugateGradients<Real>::correction(std::size_t node) {
  base::Vec6<double> z{};
  for (std::size_t k = 0; k < 6; ++k) {
    z[k] = static_cast<double>(hierarchy_.levels().front().z[node].v[k]);
  }
  return z;
}

/// q = K p; returns p . q.
template <class Real>
double ConjugateGradients<Real>::multiply() {
  return team_.sum(node_count_, [&](std::size_t begin, std::size_t end) {
    return hierarchy_.apply(p_.data(), q_.data(), {begin, end});
  });
}

/// x += step p, r -= step q
template <class Real>
void ConjugateGradients<Real>::advance(double step) {
  Level<Real>& finest = hierarchy_.levels().front();
  team_.share(0, node_count_, [&](std::size_t begin, std::size_t end) {
    kernels<Real>().advance(step, p_.data(), q_.data(), x_.data(), r_.data(), finest.r.data(),
                            {begin, end});
  });
  ++iteration_count_;
}

template <class Real>
bool ConjugateGradients<Real>::is_reached(const Goal& goal, int iteration) const {
  const bool may_stop = iteration >= goal.iteration_count_min || error_ <= kRounding * goal.error;
  return error_ <= goal.error && may_stop;
}

/// Whether all iterations are used up, or many have gained nothing.
template <class Real>
bool ConjugateGradients<Real>::is_stuck(const Goal& goal, int iteration) {
  if (iteration == 0 || error_ < least_error_) {
    least_error_ = error_;
    least_at_ = iteration;
  }
  return iteration == goal.iteration_count_max || iteration - least_at_ > kPatience;
}

template <class Real>
void ConjugateGradients<Real>::tell() const {
  if (progress) {
    progress(iteration_count_, error_);
  }
}

// x, r, q: displacement, residual, K p;  p, z: direction, preconditioned residual
template <class Real>
Iteration::End ConjugateGradients<Real>::run(const Goal& goal) {
  const std::vector<Six<Real>>& z = hierarchy_.levels().front().z;
  for (int iteration = 0; !is_reached(goal, iteration); ++iteration) {
    if (is_stuck(goal, iteration)) {
      return End::kTooSlow;
    }
    const double curvature = multiply();
    if (!(curvature > 0)) {
      return End::kBroken;
    }
    const double step = error_ / curvature;
    advance(step);
    const double error = precondition();
    const double turn = -step * dot_with_z(q_) / error_;  // z (r_new - r_old) / z_old r_old
    error_ = error;
    team_.share(0, node_count_, [&](std::size_t begin, std::size_t end) {
      kernels<Real>().combine(1, z.data(), static_cast<Real>(turn), p_.data(), {begin, end});
    });
    tell();
  }
  return error_ >= 0 ? End::kConverged : End::kBroken;
}

template class ConjugateGradients<float>;
template class ConjugateGradients<double>;

}  // namespace holdfast::solver
