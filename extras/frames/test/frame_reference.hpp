// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Dense>
#include <Eigen/SparseCholesky>
#include <Eigen/SparseCore>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

/// A second way to a frame of bars under its weight: the 12x12 matrix of a beam as textbooks have
/// it [Przemieniecki 1968], turned by the bar's axes, assembled scalar by scalar and
/// factorized from nothing by Eigen for every set of bars. Shares no code with holdfast.
namespace holdfast::test {

struct Frame {
  std::vector<Eigen::Vector3d> places_mm = {};  ///< by node
  std::vector<bool> is_grounded = {};           ///< by node
  std::vector<std::array<std::int32_t, 2>> bars = {};
  double elastic_modulus_mpa = 0;
  double shear_modulus_mpa = 0;
  double radius_mm = 0;  ///< of the round section
  double weight_n_per_mm3 = 0;
};

using Matrix12 = Eigen::Matrix<double, 12, 12>;
using Vector12 = Eigen::Matrix<double, 12, 1>;

/// The stiffness of a bar in its own axes, x along it.
inline Matrix12 local_beam(const Frame& frame, double l) {
  const double pi = 3.14159265358979323846;
  const double r = frame.radius_mm;
  const double e = frame.elastic_modulus_mpa;
  const double ea = e * pi * r * r / l;
  const double gj = frame.shear_modulus_mpa * pi * r * r * r * r / 2 / l;
  const double ei = e * pi * r * r * r * r / 4;
  const double a = 12 * ei / (l * l * l);
  const double b = 6 * ei / (l * l);
  const double c = 4 * ei / l;
  const double d = 2 * ei / l;
  Matrix12 k;
  k << ea, 0, 0, 0, 0, 0, -ea, 0, 0, 0, 0, 0,  //
      0, a, 0, 0, 0, b, 0, -a, 0, 0, 0, b,     //
      0, 0, a, 0, -b, 0, 0, 0, -a, 0, -b, 0,   //
      0, 0, 0, gj, 0, 0, 0, 0, 0, -gj, 0, 0,   //
      0, 0, -b, 0, c, 0, 0, 0, b, 0, d, 0,     //
      0, b, 0, 0, 0, c, 0, -b, 0, 0, 0, d,     //
      -ea, 0, 0, 0, 0, 0, ea, 0, 0, 0, 0, 0,   //
      0, -a, 0, 0, 0, -b, 0, a, 0, 0, 0, -b,   //
      0, 0, -a, 0, b, 0, 0, 0, a, 0, b, 0,     //
      0, 0, 0, -gj, 0, 0, 0, 0, 0, gj, 0, 0,   //
      0, 0, -b, 0, d, 0, 0, 0, b, 0, c, 0,     //
      0, b, 0, 0, 0, d, 0, -b, 0, 0, 0, c;
  return k;
}

/// Rows are the bar's axes, in all four triples.
inline Matrix12 bar_axes(const Eigen::Vector3d& along) {
  const Eigen::Vector3d other =
      std::abs(along.z()) < 0.9 ? Eigen::Vector3d::UnitZ() : Eigen::Vector3d::UnitX();
  Eigen::Matrix3d axes;
  axes.row(0) = along;
  axes.row(1) = other.cross(along).normalized();
  axes.row(2) = along.cross(Eigen::Vector3d(axes.row(1)));
  Matrix12 turn = Matrix12::Zero();
  for (int i = 0; i < 12; i += 3) {
    turn.block<3, 3>(i, i) = axes;
  }
  return turn;
}

/// Displacements by node, six each (zero where nothing touches it), of the frame with these bars
/// only, all of them connected to the ground.
inline Eigen::VectorXd frame_displacements(const Frame& frame, std::span<const std::int32_t> bars) {
  const auto n = static_cast<int>(frame.places_mm.size());
  std::vector<bool> is_free(frame.places_mm.size(), false);
  std::vector<Eigen::Triplet<double>> entries;
  Eigen::VectorXd load = Eigen::VectorXd::Zero(6 * n);
  for (const std::int32_t bar : bars) {
    const auto [p, q] = frame.bars[static_cast<std::size_t>(bar)];
    const Eigen::Vector3d arm =
        frame.places_mm[static_cast<std::size_t>(q)] - frame.places_mm[static_cast<std::size_t>(p)];
    const double l = arm.norm();
    const Matrix12 turn = bar_axes(arm / l);
    const Matrix12 k = turn.transpose() * local_beam(frame, l) * turn;
    const double pi = 3.14159265358979323846;
    const double weight = frame.weight_n_per_mm3 * pi * frame.radius_mm * frame.radius_mm;
    // Weight per length in the bar's axes, and the forces that hold its ends, turned round.
    const Eigen::Vector3d w = turn.topLeftCorner<3, 3>() * Eigen::Vector3d(0, 0, -weight);
    Vector12 f;
    f << w * l / 2, 0, -w.z() * l * l / 12, w.y() * l * l / 12,  //
        w * l / 2, 0, w.z() * l * l / 12, -w.y() * l * l / 12;
    f = turn.transpose() * f;
    const std::array<std::int32_t, 2> ends = {p, q};
    for (int i = 0; i < 12; ++i) {
      const std::int32_t node = ends[static_cast<std::size_t>(i / 6)];
      is_free[static_cast<std::size_t>(node)] = !frame.is_grounded[static_cast<std::size_t>(node)];
      load[6 * node + i % 6] += f[i];
      for (int j = 0; j < 12; ++j) {
        const std::int32_t other = ends[static_cast<std::size_t>(j / 6)];
        if (!frame.is_grounded[static_cast<std::size_t>(node)] &&
            !frame.is_grounded[static_cast<std::size_t>(other)]) {
          entries.emplace_back(6 * node + i % 6, 6 * other + j % 6, k(i, j));
        }
      }
    }
  }
  for (int i = 0; i < 6 * n; ++i) {
    if (!is_free[static_cast<std::size_t>(i / 6)]) {
      entries.emplace_back(i, i, 1.0);
      load[i] = 0;
    }
  }
  Eigen::SparseMatrix<double> matrix(6 * n, 6 * n);
  matrix.setFromTriplets(entries.begin(), entries.end());
  const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> ldlt(matrix);
  Eigen::VectorXd u = ldlt.solve(load);
  u += ldlt.solve(load - matrix * u);
  return u;
}

/// The largest translation of a node, in mm.
inline double translation_max(const Eigen::VectorXd& displacements) {
  double largest = 0;
  for (Eigen::Index i = 0; i < displacements.size(); i += 6) {
    largest = std::max(largest, displacements.segment<3>(i).norm());
  }
  return largest;
}

/// Whether every one of these bars is connected to the ground by others of them.
inline bool is_connected(const Frame& frame, std::span<const std::int32_t> bars) {
  std::vector<bool> is_held = frame.is_grounded;
  const auto node = [](std::int32_t index) { return static_cast<std::size_t>(index); };
  for (bool has_grown = true; has_grown;) {
    has_grown = false;
    for (const std::int32_t bar : bars) {
      const auto [p, q] = frame.bars[node(bar)];
      if (is_held[node(p)] != is_held[node(q)]) {
        is_held[node(p)] = is_held[node(q)] = has_grown = true;
      }
    }
  }
  return std::all_of(bars.begin(), bars.end(),
                     [&](std::int32_t bar) { return is_held[node(frame.bars[node(bar)][0])]; });
}

/// Whether each bar, as it comes, is connected to the ground by itself and those before it, and
/// all bars come once.
inline bool is_connected_order(const Frame& frame, std::span<const std::int32_t> order) {
  std::vector<bool> is_held = frame.is_grounded;
  std::vector<bool> has_come(frame.bars.size(), false);
  for (const std::int32_t bar : order) {
    const auto [p, q] = frame.bars[static_cast<std::size_t>(bar)];
    if (has_come[static_cast<std::size_t>(bar)] ||
        !(is_held[static_cast<std::size_t>(p)] || is_held[static_cast<std::size_t>(q)])) {
      return false;
    }
    has_come[static_cast<std::size_t>(bar)] = true;
    is_held[static_cast<std::size_t>(p)] = is_held[static_cast<std::size_t>(q)] = true;
  }
  return order.size() == frame.bars.size();
}

}  // namespace holdfast::test
