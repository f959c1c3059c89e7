// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "holdfast/agent/conductor/energy_bound.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstddef>

namespace holdfast::agent {
namespace {

constexpr std::size_t kSize = 40;
using Vector = std::array<double, kSize>;

double dot(const Vector& a, const Vector& b) {
  double sum = 0;
  for (std::size_t i = 0; i < kSize; ++i) {
    sum += a[i] * b[i];
  }
  return sum;
}

/// Conjugate gradients for a diagonal matrix, so that error and eigenvalues are known.
struct Process {
  explicit Process(const Vector& diagonal) : a(diagonal) {
    r.fill(1);
    p = r;
  }

  /// One iteration; the bound on the energy of the error before it.
  double iterate() {
    Vector q;
    for (std::size_t i = 0; i < kSize; ++i) {
      q[i] = a[i] * p[i];
    }
    const double rho = dot(r, r);
    const double alpha = rho / dot(p, q);
    for (std::size_t i = 0; i < kSize; ++i) {
      x[i] += alpha * p[i];
      r[i] -= alpha * q[i];
    }
    const double beta = dot(r, r) / rho;
    for (std::size_t i = 0; i < kSize; ++i) {
      p[i] = r[i] + beta * p[i];
    }
    return bound.add(rho, alpha);
  }

  double energy_of_error() const {
    double energy = 0;
    for (std::size_t i = 0; i < kSize; ++i) {
      energy += a[i] * (x[i] - 1 / a[i]) * (x[i] - 1 / a[i]);
    }
    return energy;
  }

  double energy_at_zero() const {
    double energy = 0;
    for (const double value : a) {
      energy += 1 / value;
    }
    return energy;
  }

  Vector a;
  Vector x{};
  Vector r{};
  Vector p{};
  EnergyBound bound;
};

/// Well preconditioned but for three slow modes, as a long thick robot.
Vector slow_modes() {
  Vector a;
  for (std::size_t i = 0; i < kSize; ++i) {
    a[i] = 0.3 + static_cast<double>(i) / kSize;
  }
  a[0] = 1e-4;
  a[1] = 4e-3;
  a[2] = 3e-2;
  return a;
}

TEST(EnergyBound, is_above_the_error_once_the_slowest_mode_has_shown) {
  Process process(slow_modes());
  int checked = 0;
  for (int i = 0; i < 24; ++i) {
    const double error = process.energy_of_error();
    const double bound = process.iterate();
    EXPECT_GE(process.bound.eigenvalue(), 1e-4 * (1 - 1e-9));
    if (process.bound.eigenvalue() < 1.2e-4 && error > 1e-13) {
      EXPECT_GE(bound, 0.8 * error) << i;
      ++checked;
    }
  }
  EXPECT_GT(checked, 3);
  EXPECT_LT(process.bound.eigenvalue(), 1.1e-4);
}

TEST(EnergyBound, starts_anew) {
  Process process(slow_modes());
  const double first = process.iterate();
  process.iterate();
  process = Process(slow_modes());
  process.bound.restart();
  EXPECT_EQ(process.iterate(), first);
}

TEST(EnergyBound, is_exact_for_a_single_eigenvalue) {
  Vector a;
  a.fill(0.25);
  Process process(a);
  EXPECT_NEAR(process.iterate(), process.energy_at_zero(), 1e-12);
  EXPECT_NEAR(process.bound.eigenvalue(), 0.25, 1e-15);
}

}  // namespace
}  // namespace holdfast::agent
