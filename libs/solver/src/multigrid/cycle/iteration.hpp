// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "multigrid/coarsening/springs.hpp"

namespace holdfast::solver {

/// What a matrix A that is not symmetric has at a node beyond the hierarchy's matrix K.
struct NodeTerm {
  std::int32_t node = 0;
  Mat difference;  ///< A - K
};

/// Solves K x = f by iteration, whatever the precision of its preconditioner.
class Iteration {
 public:
  virtual ~Iteration() = default;

  /// Six numbers per node.
  std::vector<double>& x() { return x_; }

  /// What x leaves of f at a node.
  virtual base::Vec6<double> residual(std::size_t node) = 0;
  virtual void set_residual(std::size_t node, const base::Vec6<double>& residual) = 0;

  /// Whether the robot is so slender that single precision is not to be trusted.
  virtual bool is_too_slender() const = 0;

  /// Whether in the facets' present states a part of the robot is held by nothing.
  virtual bool is_singular() const = 0;

  /// Takes over changed contact.
  virtual void update_contact() = 0;

  /// r -= K x, for an x that did not come out of run().
  virtual void subtract_product() = 0;

  enum class End : std::uint8_t { kConverged, kTooSlow, kBroken };

  /// Takes up x and its residual r. Returns r . M^-1 r, which estimates the square of the error of
  /// x in the energy norm.
  virtual double begin() = 0;

  /// Until when to iterate.
  struct Goal {
    double error = 0;             ///< Of the estimate r . M^-1 r.
    int iteration_count_min = 0;  ///< Unless the error is far below that already.
    int iteration_count_max = 0;
  };

  /// Improves x after begin(), or to go on with another goal.
  virtual End run(const Goal& goal) = 0;

  /// Makes one step of run() after begin(), and before the next. Returns false, and leaves x as it
  /// is, if there is none to make.
  virtual bool step() = 0;

  /// Does what run() does for a matrix A that is not symmetric, by orthogonalization [Saad 1981].
  /// In small robots it is full: r is kept orthogonal to all directions p so far, by
  /// p . A p_next = 0, so that it ends however far A is from K. In large ones it is incomplete: to
  /// the last direction, and to older ones as far as K is near to A, as with conjugate gradients.
  /// (To make r smallest instead, as GMRES does, would need directions in double precision: r
  /// counts every rounding error of a stiff lattice.)
  virtual End run_unsymmetric(const Goal& goal, std::span<const NodeTerm> terms) = 0;

  /// M^-1 r at a node: about what x is still off by there. After begin() or run().
  virtual base::Vec6<double> correction(std::size_t node) = 0;

  /// Has marked() say what x is now. That costs memory from the second iteration on.
  virtual void mark() = 0;

  /// What x was when mark() was called, once, after rest() or retire().
  virtual std::vector<double> marked() = 0;

  /// Gives back the memory that run() works in; x, r and marked() stay. Then begin() must be next.
  virtual void rest() = 0;

  /// Gives back all memory but that of x and marked(); then nothing but these may be asked for.
  virtual void retire() = 0;

  int iteration_count() const { return iteration_count_; }

  /// Called once per iteration with the estimated error; may be empty.
  std::function<void(int, double)> progress;

 protected:
  std::vector<double> x_;
  int iteration_count_ = 0;
};

}  // namespace holdfast::solver
