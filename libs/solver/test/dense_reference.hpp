// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <vector>

#include "holdfast/mechanics/ground_contact.hpp"
#include "holdfast/model/robot.hpp"

/// A second way to the equilibrium of a robot: Eqs. (1)-(5) of [Piranda 2021] assembled densely,
/// with given contact states, and solved by Eigen. Shares no code with the solver.
namespace holdfast::test {

using Matrix6 = Eigen::Matrix<double, 6, 6>;
using Vector6 = Eigen::Matrix<double, 6, 1>;

/// Eq. (1) for sign = 1; Eq. (2) for sign = -1, where the torques of q halve.
inline Matrix6 paper_block(const model::Material& m, double sign) {
  const double l = m.pitch_mm;
  const double jv = m.torsion_mm4 / (2 * (1 + m.poisson_ratio));
  const double x = m.moment_x_mm4;
  const double y = m.moment_y_mm4;
  const double turn = sign > 0 ? 4 : 2;
  Matrix6 k;
  k << 12 * x * sign, 0, 0, 0, -6 * x * l, 0,            //
      0, 12 * y * sign, 0, 6 * y * l, 0, 0,              //
      0, 0, m.section_area_mm2 * l * l * sign, 0, 0, 0,  //
      0, 6 * y * l * sign, 0, turn * y * l * l, 0, 0,    //
      -6 * x * l * sign, 0, 0, 0, turn * x * l * l, 0,   //
      0, 0, 0, 0, 0, jv * l * l * sign;
  return m.elastic_modulus_mpa / (l * l * l) * k;
}

/// R^ of Eq. (4): local z from the neighbour to the module, local x up on lateral beams.
inline Matrix6 rotation(base::Direction direction) {
  const base::Cell q = base::neighbour({}, direction);
  const Eigen::Vector3d z(-q.x, -q.y, -q.z);
  const Eigen::Vector3d x = q.z != 0 ? Eigen::Vector3d::UnitX() : Eigen::Vector3d::UnitZ();
  Eigen::Matrix3d r;
  r << x, z.cross(x), z;
  Matrix6 both = Matrix6::Zero();
  both.topLeftCorner<3, 3>() = r;
  both.bottomRightCorner<3, 3>() = r;
  return both;
}

/// The derivative of Eqs. (10)-(12), row by row.
inline Matrix6 regularised_tangent(const model::Material& m, double gamma,
                                   mechanics::ContactState state) {
  const Matrix6 trial = paper_block(m, 1);
  const double half = m.pitch_mm / 2;
  const double l = m.facet_mm / 2;
  if (!state.pressed) {
    return gamma * trial;
  }
  Matrix6 k = trial;
  if (state.tilt_x != 0) {
    k.row(3) = gamma * trial.row(3) +
               (1 - gamma) * (half * trial.row(1) - l * state.tilt_x * trial.row(2));
  }
  if (state.tilt_y != 0) {
    k.row(4) = gamma * trial.row(4) -
               (1 - gamma) * (half * trial.row(0) + l * state.tilt_y * trial.row(2));
  }
  return k;
}

/// The beam's stiffness after static condensation of the motions that the facet is free to make:
/// rolling over the edges that stay down, lifting off, and sliding unless it is held.
inline Matrix6 unilateral_tangent(const model::Material& m, double gamma,
                                  mechanics::ContactState state, bool is_held) {
  Matrix6 to_facet = Matrix6::Identity();  // From node to facet centre.
  to_facet(0, 4) = -m.pitch_mm / 2;
  to_facet(1, 3) = m.pitch_mm / 2;
  const Matrix6 from_facet = to_facet.inverse();
  const Matrix6 h = from_facet.transpose() * paper_block(m, 1) * from_facet;
  const double l = m.facet_mm / 2;
  std::vector<Vector6> free;
  if (state.tilt_x != 0 || !state.pressed) {
    free.push_back(l * Vector6::Unit(2) + (state.pressed ? state.tilt_x : 1) * Vector6::Unit(3));
  }
  if (state.tilt_y != 0 || !state.pressed) {
    free.push_back(l * Vector6::Unit(2) + (state.pressed ? state.tilt_y : 1) * Vector6::Unit(4));
  }
  if (!state.pressed) {
    free.push_back(Vector6::Unit(2));
  }
  for (const int sideways : {0, 1, 5}) {
    if (!is_held) {
      free.push_back(Vector6::Unit(sideways));
    }
  }
  Eigen::MatrixXd n(6, static_cast<Eigen::Index>(free.size()));
  for (std::size_t i = 0; i < free.size(); ++i) {
    n.col(static_cast<Eigen::Index>(i)) = free[i];
  }
  Matrix6 condensed = h;
  if (!free.empty()) {
    condensed -= h * n * (n.transpose() * h * n).inverse() * n.transpose() * h;
  }
  return to_facet.transpose() * ((1 - gamma) * condensed + gamma * h) * to_facet;
}

/// Displacements of all modules under loads; `contact` gives the tangent of each ground module.
/// Zero where fixed.
template <class Contact>
std::vector<base::Vec6<double>> dense_displacement(const model::Robot& robot,
                                                   const model::Loads& loads, Contact contact) {
  const model::Material& m = robot.material();
  const auto modules = robot.modules();
  const auto size = 6 * static_cast<Eigen::Index>(modules.size());
  Eigen::MatrixXd k = Eigen::MatrixXd::Zero(size, size);
  Eigen::VectorXd f = Eigen::VectorXd::Zero(size);
  for (std::size_t p = 0; p < modules.size(); ++p) {
    const auto row = 6 * static_cast<Eigen::Index>(p);
    if (modules[p].support == model::Support::kFixed) {
      k.block<6, 6>(row, row).setIdentity();
      continue;
    }
    f.segment<6>(row) = Eigen::Map<const Vector6>(loads[p].data());
    if (modules[p].support == model::Support::kGround) {
      k.block<6, 6>(row, row) += contact(p);
    }
    for (const base::Direction direction : base::kDirections) {
      const std::int32_t q = robot.connected()[p][static_cast<std::size_t>(base::index(direction))];
      if (q != model::Robot::kNoNeighbour) {
        const Matrix6 r = rotation(direction);
        k.block<6, 6>(row, row) += r * paper_block(m, 1) * r.transpose();
        k.block<6, 6>(row, 6 * q) += r * paper_block(m, -1) * r.transpose();
      }
    }
  }
  const Eigen::VectorXd u = k.partialPivLu().solve(f);
  std::vector<base::Vec6<double>> displacement(modules.size());
  for (Eigen::Index i = 0; i < size; ++i) {
    displacement[static_cast<std::size_t>(i / 6)][static_cast<std::size_t>(i % 6)] = u(i);
  }
  return displacement;
}

/// Displacements of all modules under their weight.
template <class Contact>
std::vector<base::Vec6<double>> dense_displacement(const model::Robot& robot, Contact contact) {
  const double weight_n = robot.material().mass_kg * robot.material().gravity_m_s2;
  return dense_displacement(robot, model::Loads({0, 0, -weight_n, 0, 0, 0}), contact);
}

inline double largest(const std::vector<base::Vec6<double>>& vectors) {
  double size = 0;
  for (const base::Vec6<double>& vector : vectors) {
    for (const double value : vector) {
      size = std::max(size, std::abs(value));
    }
  }
  return size;
}

inline double largest_difference(std::vector<base::Vec6<double>> a,
                                 const std::vector<base::Vec6<double>>& b) {
  for (std::size_t i = 0; i < a.size(); ++i) {
    for (std::size_t k = 0; k < 6; ++k) {
      a[i][k] -= b[i][k];
    }
  }
  return largest(a);
}

}  // namespace holdfast::test
