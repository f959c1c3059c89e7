// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "conjugate_gradients.hpp"

namespace holdfast::solver {
namespace {

/// Gauss-Seidel sweeps before and after the coarse correction. One needs twice the iterations; a
/// third saves few.
constexpr int kSweepCount = 2;

/// An error so far below the one sought, both squared, may be rounding, which no step improves.
constexpr double kRounding = 0.01;

}  // namespace

ConjugateGradients::ConjugateGradients(Hierarchy& hierarchy, Team& team, std::size_t node_count)
    : hierarchy_(hierarchy),
      team_(team),
      cycle_(hierarchy, team, kSweepCount),
      node_count_(node_count),
      x_(6 * node_count),
      r_(6 * node_count),
      q_(6 * node_count),
      p_(node_count + 1) {}

/// x is taken apart into two directions in single precision, 48 bits together.
void ConjugateGradients::subtract_product() {
  for (const bool is_rest : {false, true}) {
    team_.share(0, node_count_, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = 6 * begin; i < 6 * end; ++i) {
        const auto upper = static_cast<float>(x_[i]);
        p_[i / 6].v[i % 6] =
            is_rest ? static_cast<float>(x_[i] - static_cast<double>(upper)) : upper;
      }
    });
    team_.share(0, node_count_, [&](std::size_t begin, std::size_t end) {
      kernels().apply(hierarchy_.lattice(), p_.data(), q_.data(), {begin, end});
      for (std::size_t i = 6 * begin; i < 6 * end; ++i) {
        r_[i] -= q_[i];
      }
    });
  }
}

void ConjugateGradients::round_residual() {
  Level& finest = hierarchy_.levels().front();
  team_.share(0, node_count_, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = 6 * begin; i < 6 * end; ++i) {
      finest.r[i / 6].v[i % 6] = static_cast<float>(r_[i]);
    }
  });
}

double ConjugateGradients::dot_with_z(const std::vector<double>& a) {
  const std::vector<Six>& z = hierarchy_.levels().front().z;
  return team_.sum(node_count_, [&](std::size_t begin, std::size_t end) {
    return kernels().dot(a.data(), z.data(), {begin, end});
  });
}

/// z = M^-1 r; returns r . z.
double ConjugateGradients::precondition() {
  cycle_.run();
  return dot_with_z(r_);
}

double ConjugateGradients::begin() {
  older_ = {};
  round_residual();
  error_ = precondition();
  p_ = hierarchy_.levels().front().z;
  return error_;
}

/// q = K p; returns p . q.
double ConjugateGradients::multiply() {
  return team_.sum(node_count_, [&](std::size_t begin, std::size_t end) {
    return kernels().apply(hierarchy_.lattice(), p_.data(), q_.data(), {begin, end});
  });
}

/// x += step p, r -= step q
void ConjugateGradients::advance(double step) {
  Level& finest = hierarchy_.levels().front();
  team_.share(0, node_count_, [&](std::size_t begin, std::size_t end) {
    kernels().advance(step, p_.data(), q_.data(), x_.data(), r_.data(), finest.r.data(),
                      {begin, end});
  });
  ++iteration_count_;
}

bool ConjugateGradients::is_reached(const Goal& goal, int iteration) const {
  const bool may_stop = iteration >= goal.iteration_count_min || error_ <= kRounding * goal.error;
  return error_ <= goal.error && may_stop;
}

void ConjugateGradients::tell() const {
  if (progress) {
    progress(iteration_count_, error_);
  }
}

// x, r, q: displacement, residual, K p;  p, z: direction, preconditioned residual (single
// precision)
ConjugateGradients::End ConjugateGradients::run(const Goal& goal) {
  const std::vector<Six>& z = hierarchy_.levels().front().z;
  for (int iteration = 0; !is_reached(goal, iteration); ++iteration) {
    if (iteration == goal.iteration_count_max) {
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
      kernels().combine(1, z.data(), static_cast<float>(turn), p_.data(), {begin, end});
    });
    tell();
  }
  return error_ >= 0 ? End::kConverged : End::kBroken;
}

}  // namespace holdfast::solver
