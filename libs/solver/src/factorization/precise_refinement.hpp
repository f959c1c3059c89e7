// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <functional>
#include <vector>

#include "holdfast/base/double_double.hpp"
#include "holdfast/mechanics/ground_contact.hpp"
#include "holdfast/model/robot.hpp"
#include "holdfast/solver/linear_system.hpp"

/// Iterative refinement with residuals and displacements in 106 bits [Wilkinson 1963].
///
/// A solver M of A u = f that is right to a relative error c < 1 makes the error c times smaller in
/// every step u := u + M (f - A u), whatever c is, as long as the residual f - A u is known to more
/// digits than u itself. In double it is not for a robot whose soft motions are 1e10 times as large
/// as the stiff ones that make its load ratios: it is rounding by then. In 106 bits it is.
///
/// A factorization in double of such robots may have c > 1 in a few directions. So steps are not
/// taken in full: they are made conjugate to all steps before, and leave a residual that is
/// orthogonal to these, as in full orthogonalization [Saad 1981], which ends after as many steps
/// more as there are such directions.
namespace holdfast::solver {

class PreciseRefinement {
 public:
  using Vec = base::Vec6<double>;
  using PreciseVec = base::Vec6<base::DoubleDouble>;

  /// Turns loads, one per module in the robot's order, into the displacements that a solver of
  /// limited accuracy finds for them, in place. Fixed modules' loads mean nothing.
  using Solve = std::function<void(std::vector<Vec>& load)>;

  /// Refines solutions of a system, whose present facets and loads it takes. Keeps a reference to
  /// it, which is to stay as it is; the numbers of its section count as exact.
  explicit PreciseRefinement(const LinearSystem& system);
  PreciseRefinement(const PreciseRefinement&) = delete;
  PreciseRefinement& operator=(const PreciseRefinement&) = delete;
  ~PreciseRefinement() = default;

  /// Improves the displacements until the corrections are rounding. Returns false if they do not
  /// become so: the solver's error is as large as the displacements, or larger.
  bool run(const std::vector<Vec>& displacement, const Solve& solve);

  /// The displacement, by module, is high + low.
  std::vector<Vec> high() const;
  std::vector<Vec> low() const;

  /// The states that the displacements prescribe, by facet.
  std::vector<mechanics::ContactState> states() const;

 private:
  using PreciseVecs = std::vector<PreciseVec>;

  /// A step that was taken, and its image.
  struct Direction {
    PreciseVecs p;
    PreciseVecs image;             ///< A p
    base::DoubleDouble curvature;  ///< p . A p
  };

  PreciseVecs product(const PreciseVecs& u) const;
  PreciseVecs residual() const;
  Direction conjugate(PreciseVecs step) const;
  double size_of(const PreciseVecs& motion) const;
  bool is_fixed(std::size_t module) const;

  const LinearSystem& system_;
  const model::Robot& robot_;
  model::LatticeBeam<base::DoubleDouble> beam_;
  FacetLaw<base::DoubleDouble> law_;
  PreciseVecs displacement_;
  std::vector<Direction> older_;
};

}  // namespace holdfast::solver
