// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

#include "holdfast/base/double_double.hpp"
#include "holdfast/mechanics/beam.hpp"
#include "holdfast/mechanics/connector.hpp"
#include "holdfast/model/lattice_beam.hpp"
#include "holdfast/model/material.hpp"
#include "holdfast/model/robot.hpp"
#include "holdfast/verdict/assessment.hpp"

/// Computes the loads of very many connections, Eqs. (16)-(17).
namespace holdfast::verdict {

/// Computes what mechanics::middle_force() and load_ratio() compute for one direction, to the last
/// bit, with the beam's frame and constants worked out beforehand. That leaves three differences
/// for a load ratio: of the displacements along the beam, and of the rotations across.
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

  /// The larger bending moment of the two axes, a NaN if one is. Nobody can foresee which one is
  /// larger, so no branch asks.
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

/// The loads of a robot's connections, each by its own law. Keeps a reference to the robot.
class ConnectionLaws {
 public:
  using Vec = base::Vec6<double>;
  using Vecs = std::vector<Vec>;

  explicit ConnectionLaws(const model::Robot& robot);

  double load_ratio(const model::Connection& pair, const Vec& p, const Vec& q) const {
    return is_plain_ ? plain(pair).load_ratio(p, q) : result(pair, p, q).load_ratio;
  }

  ConnectionResult result(const model::Connection& pair, const Vec& p, const Vec& q) const {
    return is_plain_ ? plain(pair).result(p, q) : general_result(pair, p, q);
  }

  /// The load ratio from all modules' displacements, with what is to be added to them for 106 bits,
  /// or nothing.
  double load_ratio(const model::Connection& pair, const Vecs& high, const Vecs& low) const {
    return low.empty() ? load_ratio(pair, high[base::at(pair.a)], high[base::at(pair.b)])
                       : load_ratio(pair, relative_motion(pair, high, low), Vec{});
  }

  ConnectionResult result(const model::Connection& pair, const Vecs& high, const Vecs& low) const {
    return low.empty() ? result(pair, high[base::at(pair.a)], high[base::at(pair.b)])
                       : result(pair, relative_motion(pair, high, low), Vec{});
  }

  /// The limit that a connection's load ratio is of, and the ratios of all its limits.
  model::Limit limit(const model::Connection& pair, const ConnectionResult& result) const {
    return model::load_ratio(robot_.connector(pair), force_of(result)).limit;
  }

  std::array<double, model::kLimitCount> limit_ratios(const model::Connection& pair,
                                                      const ConnectionResult& result) const {
    return model::limit_ratios(robot_.connector(pair), force_of(result));
  }

  /// The gap at the edge of the facet, mm; not below 0. The modules are rigid beside their
  /// connection, whose compliance is that of the beam: N / axial stiffness, and the angles by which
  /// the beam bends times the lever. At a corner both angles add up if the law is square.
  double gap_mm(const model::Connection& pair, const Vecs& high, const Vecs& low) const;

 private:
  const ConnectionLaw& plain(const model::Connection& pair) const {
    return plain_[static_cast<std::size_t>(base::index(pair.direction)) / 2];
  }

  static model::ConnectionForce force_of(const ConnectionResult& result) {
    return {.axial_n = result.axial_n,
            .bending_nmm = result.bending_nmm,
            .shear_n = result.shear_n,
            .torsion_nmm = result.torsion_nmm};
  }

  ConnectionResult general_result(const model::Connection& pair, const Vec& p, const Vec& q) const;

  /// The motion of the first module as seen by the second, where both move far more than their beam
  /// bends: in 106 bits until what is common to both is gone.
  Vec relative_motion(const model::Connection& pair, const Vecs& high, const Vecs& low) const;

  const model::Robot& robot_;
  bool is_plain_ = true;              ///< Cubes with the connectors of Eq. (17).
  std::vector<ConnectionLaw> plain_;  ///< Along x, y, z.
  model::LatticeBeam<double> beam_;
  std::vector<std::array<base::DoubleDouble, 3>> steps_;  ///< By direction, pitches.
};

}  // namespace holdfast::verdict
