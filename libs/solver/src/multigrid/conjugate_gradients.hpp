// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <vector>

#include "cycle.hpp"

/// Flexible preconditioned conjugate gradients [Notay 2000]. Displacements and residuals are kept
/// in double precision; search directions in single precision, but what they do to x and r is
/// computed from the same rounded direction in double precision, so x and r never part.
namespace holdfast::solver {

class ConjugateGradients {
 public:
  ConjugateGradients(Hierarchy& hierarchy, Team& team, std::size_t node_count);

  /// Six numbers per node.
  std::vector<double>& x() { return x_; }

  const std::vector<double>& x() const { return x_; }

  std::vector<double>& r() { return r_; }

  /// r -= K x, for an x that did not come out of run().
  void subtract_product();

  enum class End : std::uint8_t { kConverged, kTooSlow, kBroken };

  /// Takes up x and its residual r. Returns r . M^-1 r, which estimates the square of the error of
  /// x in the energy norm.
  double begin();

  /// After begin(): improves x until that estimate is at most `target`.
  End run(double target, int iteration_count_max);

  int iteration_count() const { return iteration_count_; }

  /// Called once per iteration with the estimated error; may be empty.
  std::function<void(int, double)> progress;

 private:
  double precondition();
  double dot_with_z(const std::vector<double>& a);
  void round_residual();

  Hierarchy& hierarchy_;
  Team& team_;
  Cycle cycle_;
  std::size_t node_count_;
  std::vector<double> x_;
  std::vector<double> r_;
  std::vector<double> q_;
  std::vector<Six> p_;
  double error_ = 0;
  int iteration_count_ = 0;
};

}  // namespace holdfast::solver
