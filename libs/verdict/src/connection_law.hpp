// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <cstddef>
#include <vector>

#include "holdfast/mechanics/beam.hpp"
#include "holdfast/mechanics/connector.hpp"
#include "holdfast/model/material.hpp"
#include "holdfast/model/robot.hpp"
#include "holdfast/verdict/assessment.hpp"

/// What connections carry, Eqs. (16)-(17), for very many of them.
namespace holdfast::verdict {

/// For one direction: what mechanics::middle_force() and load_ratio() compute, to the last bit,
/// with the beam's frame and constants worked out beforehand. For a load ratio that leaves three
/// differences: of the displacements along the beam, and of the rotations across.
class ConnectionLaw {
 public:
  using Vec = base::Vec6<double>;

  ConnectionLaw(const model::Material& material, base::Direction direction);

  double load_ratio(const Vec& p, const Vec& q) const {
    return ratio(difference(axial_, p, q), bending(p, q));
  }

  ConnectionResult result(const Vec& p, const Vec& q) const {
    const double axial = difference(axial_, p, q);
    const double bend = bending(p, q);
    const double x = difference(shear_x_, p, q) + sum(couple_x_, p, q);
    const double y = difference(shear_y_, p, q) + sum(couple_y_, p, q);
    return {.load_ratio = ratio(axial, bend),
            .axial_n = axial,
            .bending_nmm = bend,
            .shear_n = std::sqrt(x * x + y * y),
            .torsion_nmm = difference(torsion_, p, q)};
  }

 private:
  /// A number of the local frame is a multiple of one of the global frame.
  struct Term {
    std::size_t index = 0;
    double factor = 0;
  };

  static double difference(const Term& term, const Vec& p, const Vec& q) {
    return term.factor * (p[term.index] - q[term.index]);
  }

  static double sum(const Term& term, const Vec& p, const Vec& q) {
    return term.factor * (p[term.index] + q[term.index]);
  }

  /// The larger of both, a NaN if one is. Which one it is nobody can foresee, so no branch asks.
  double bending(const Vec& p, const Vec& q) const {
    const double x = std::abs(difference(bend_x_, p, q));
    const double y = std::abs(difference(bend_y_, p, q));
    const double larger = x > y ? x : y;
    return std::isunordered(x, y) ? x + y : larger;
  }

  double ratio(double axial, double bend) const {
    return (2 * bend / connector_.width + axial) / connector_.strength;
  }

  Term axial_;
  Term bend_x_;
  Term bend_y_;
  Term torsion_;
  Term shear_x_;
  Term shear_y_;
  Term couple_x_;
  Term couple_y_;
  mechanics::Connector<double> connector_;
};

/// How the first module of a connection moves as seen by the second, where both move far more than
/// their beam bends: in 106 bits, high + low by module, until what is common to both is gone.
base::Vec6<double> relative_motion(const model::Robot& robot, const model::Connection& pair,
                                   const std::vector<base::Vec6<double>>& high,
                                   const std::vector<base::Vec6<double>>& low);

}  // namespace holdfast::verdict
