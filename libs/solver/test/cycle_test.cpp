// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
// The preconditioner as a map from forces to displacements: symmetric and positive, as conjugate
// gradients ask for. Two levels make a linear map, more a nearly linear one (the inner iteration's
// steps depend on the forces), so symmetry is asked of two and positivity of all.
#include "../src/multigrid/cycle/cycle.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "holdfast/model/families.hpp"
#include "random_numbers.hpp"

namespace holdfast::solver {
namespace {

/// A robot of a family and its preconditioner.
template <class Real>
class Preconditioner {
 public:
  Preconditioner(model::Family family, std::size_t size)
      : robot_(model::Robot::create({.existing = model::family_cells(family, size)}).value()),
        team_(1),
        network_(make_reduced_network(robot_, team_)),
        hierarchy_(network_, robot_.material(), team_, ground_, {}),
        cycle_(hierarchy_, team_, 1) {}

  std::size_t level_count() { return hierarchy_.levels().size(); }

  std::vector<Six<Real>> random_forces(base::Rng& rng) {
    std::vector<Six<Real>> r(network_.node_count + 1);
    for (std::size_t node = 0; node < network_.node_count; ++node) {
      const base::Vec6<double> six = random_six(rng);
      for (std::size_t i = 0; i < 6; ++i) {
        // Torques count by the length of a module.
        r[node].v[i] = static_cast<Real>(six[i] * (i < 3 ? 1 : 40));
      }
    }
    return r;
  }

  /// M^-1 r.
  std::vector<Six<Real>> operator()(const std::vector<Six<Real>>& r) {
    hierarchy_.take_vectors();
    std::ranges::copy(r, hierarchy_.levels()[0].r.begin());
    std::vector<std::int16_t> low(6 * r.size());
    cycle_.run({.rounded = hierarchy_.levels()[0].r.data(), .low = low.data()});
    const auto z = hierarchy_.levels()[0].z;
    return {z.begin(), z.end()};
  }

 private:
  model::Robot robot_;
  host::Team team_;
  ReducedNetwork network_;
  GroundTable ground_{};
  Hierarchy<Real> hierarchy_;
  Cycle<Real> cycle_;
};

template <class Real>
double dot(const std::vector<Six<Real>>& a, const std::vector<Six<Real>>& b) {
  double sum = 0;
  for (std::size_t node = 0; node < a.size(); ++node) {
    for (std::size_t i = 0; i < 6; ++i) {
      sum += static_cast<double>(a[node].v[i]) * static_cast<double>(b[node].v[i]);
    }
  }
  return sum;
}

template <class Real>
void expect_symmetric(model::Family family, std::size_t size, double tolerance) {
  Preconditioner<Real> apply(family, size);
  ASSERT_EQ(apply.level_count(), 2U);
  base::Rng rng(8);
  for (int turn = 0; turn < 10; ++turn) {
    const auto a = apply.random_forces(rng);
    const auto b = apply.random_forces(rng);
    const auto za = apply(a);
    const auto zb = apply(b);
    const double scale = std::sqrt(dot(a, za) * dot(b, zb));
    EXPECT_NEAR(dot(a, zb) / scale, dot(b, za) / scale, tolerance);
    EXPECT_GT(std::abs(dot(a, zb)) / scale, 10 * tolerance);
  }
}

TEST(Cycle, of_two_levels_is_symmetric) {
  expect_symmetric<float>(model::Family::kCube, 6, 1e-5);
  expect_symmetric<float>(model::Family::kScaffold, 4, 1e-5);
}

TEST(Cycle, of_two_levels_in_double_precision_is_symmetric) {
  // Its sweeps stay in single precision.
  expect_symmetric<double>(model::Family::kCube, 6, 1e-5);
  expect_symmetric<double>(model::Family::kScaffold, 4, 1e-5);
}

template <class Real>
void expect_positive(model::Family family, std::size_t size) {
  Preconditioner<Real> apply(family, size);
  EXPECT_GT(apply.level_count(), 2U);
  base::Rng rng(9);
  for (int turn = 0; turn < 10; ++turn) {
    const auto r = apply.random_forces(rng);
    EXPECT_GT(dot(r, apply(r)), 0);
  }
}

TEST(Cycle, of_any_depth_is_positive) {
  for (const auto& [family, size] : {std::pair{model::Family::kCube, 20},
                                     {model::Family::kShell, 20},
                                     {model::Family::kGrowth, 3000},
                                     {model::Family::kScaffold, 40}}) {
    expect_positive<float>(family, static_cast<std::size_t>(size));
    expect_positive<double>(family, static_cast<std::size_t>(size));
  }
}

}  // namespace
}  // namespace holdfast::solver
