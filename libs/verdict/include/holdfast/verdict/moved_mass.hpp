// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>

namespace holdfast::verdict {

/// The displacement of the centre of mass, in plan: sums over masses.
struct MovedMass {
  double mass_kg = 0;
  double x_kg_mm = 0;  ///< Of mass times displacement along x,
  double y_kg_mm = 0;  ///< and along y.

  /// A mass more, which moves so far.
  void add(double mass, double x_mm, double y_mm) {
    mass_kg += mass;
    x_kg_mm += mass * x_mm;
    y_kg_mm += mass * y_mm;
  }

  /// The distance by which the centre of mass moves if both sums may be off by `error_kg_mm`, at
  /// most.
  double shift_mm(double error_kg_mm = 0) const {
    return std::hypot(std::abs(x_kg_mm) + error_kg_mm, std::abs(y_kg_mm) + error_kg_mm) / mass_kg;
  }
};

}  // namespace holdfast::verdict
