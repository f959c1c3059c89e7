// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <span>
#include <vector>

#include "cycle.hpp"

/// Flexible preconditioned conjugate gradients [Notay 2000]. Displacements and residuals are kept
/// in double precision; search directions in single precision, but what they do to x and r is
/// computed from the same rounded direction in double precision, so x and r never part.
namespace holdfast::solver {

/// What a matrix A has at a node that K has not.
struct NodeTerm {
  std::int32_t node = 0;
  Mat difference;
};

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

  /// Until when to iterate.
  struct Goal {
    double error = 0;             ///< Of the estimate r . M^-1 r.
    int iteration_count_min = 0;  ///< Unless the error is far below that already.
    int iteration_count_max = 0;
  };

  /// After begin(), or to go on with another goal: improves x.
  End run(const Goal& goal);

  /// The same for a matrix A = K + terms that is not symmetric, by full orthogonalization
  /// [Saad 1981]: r is kept orthogonal to all directions so far, as conjugate gradients do by
  /// themselves. (To make r smallest instead, as GMRES does, would need directions in double
  /// precision: r counts every rounding error of a stiff lattice.)
  End run_unsymmetric(const Goal& goal, std::span<const NodeTerm> terms);

  int iteration_count() const { return iteration_count_; }

  /// Called once per iteration with the estimated error; may be empty.
  std::function<void(int, double)> progress;

 private:
  /// One that A made unsymmetric runs remember.
  struct Direction {
    std::vector<Six> p;
    std::vector<double> image;  ///< A^T p
    double curvature = 0;       ///< p . A p
  };

  bool is_reached(const Goal& goal, int iteration) const;
  double precondition();
  double multiply();
  void advance(double step);
  void tell() const;
  double dot_with_z(const std::vector<double>& a);
  void round_residual();
  void turn_away_from_older();
  double remember_direction(std::span<const NodeTerm> terms);

  Hierarchy& hierarchy_;
  Team& team_;
  Cycle cycle_;
  std::size_t node_count_;
  std::vector<double> x_;
  std::vector<double> r_;
  std::vector<double> q_;
  std::vector<Six> p_;
  std::vector<Direction> older_;
  double error_ = 0;
  int iteration_count_ = 0;
};

}  // namespace holdfast::solver
