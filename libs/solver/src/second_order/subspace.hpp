// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "holdfast/base/algebra.hpp"

namespace holdfast::solver {

/// The largest eigenvalue of a symmetric matrix, given by its lower rows, and its eigenvector, by
/// Jacobi's rotations.
struct Eigenpair {
  double value = 0;
  std::vector<double> vector;
};

Eigenpair largest_eigenpair(const std::vector<std::vector<double>>& lower_rows);

/// Motions of a robot, orthonormal by K, and the largest value of x . S x / x . K x among their
/// combinations x (Rayleigh and Ritz), S = -K_G. That is never above the largest of all motions.
class Subspace {
 public:
  using Vecs = std::vector<base::Vec6<double>>;

  /// A motion x of unit energy with K x and S x.
  struct Motion {
    Vecs x;
    Vecs forces;     ///< K x
    Vecs softening;  ///< S x
  };

  std::size_t size() const { return motions_.size(); }

  const Motion& last() const { return motions_.back(); }

  /// Takes the part of a motion that is orthogonal to all others, and of unit energy; `soften`
  /// makes S x of it. Returns false if nothing but rounding is left of it.
  template <class Soften>
  bool add(Vecs x, Vecs forces, const Soften& soften) {
    if (!reduce(x, forces)) {
      return false;
    }
    Vecs softening = soften(x);
    take({std::move(x), std::move(forces), std::move(softening)});
    return true;
  }

  /// The largest value, and the shares of the motions in the combination that has it; of one motion
  /// at least.
  Eigenpair best() const;

  /// Combines a part of the motions in these shares.
  Vecs combination(const Eigenpair& shares, Vecs Motion::*part) const;

  /// Keeps the best motion alone.
  void restart();

 private:
  bool reduce(Vecs& x, Vecs& forces) const;
  void take(Motion motion);

  std::vector<Motion> motions_;
  std::vector<std::vector<double>> products_;  ///< x_i . S x_k for k <= i.
};

}  // namespace holdfast::solver
