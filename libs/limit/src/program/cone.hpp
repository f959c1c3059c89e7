// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

/// The cones of an interior-point method: numbers that are not negative, and second-order cones
/// {(u0, u1, u2): |(u1, u2)| <= u0}. A vector of one row is of the first kind, one of three of the
/// second.
namespace holdfast::limit {

/// Part of a vector that lies in one cone; one or three rows, on the stack.
using ConePart = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, 3, 1>;
/// The rows of a matrix that belong to one cone.
using ConeRows = Eigen::Matrix<double, Eigen::Dynamic, 6, 0, 3, 6>;

/// The centre of a cone, e: u o e = u.
ConePart cone_centre(Eigen::Index size);

/// How far within the cone: u0 - |(u1, u2)|; below 0: outside.
double inside(const ConePart& u);

/// The product of the cone's Jordan algebra, (u'v, u0 v1 + v0 u1, ...), and what times u is v.
ConePart jordan_product(const ConePart& u, const ConePart& v);
ConePart jordan_quotient(const ConePart& v, const ConePart& u);

/// The longest step t, at most `most`, so that u + t d is in the cone, if u is.
double longest_step(const ConePart& u, const ConePart& d, double most);

/// The scaling of Nesterov and Todd of a point s within a cone and its dual z: the symmetric W with
/// W z = W^-1 s [Vandenberghe 2010, sec. 4].
class Scaling {
 public:
  Scaling() = default;
  Scaling(const ConePart& s, const ConePart& z);

  ConePart times(const ConePart& u) const;          ///< W u
  ConePart inverse_times(const ConePart& u) const;  ///< W^-1 u

  /// A matrix R, accurate in each of its rows, with R'R = (W^-1 G)'(W^-1 G).
  ConeRows root_times(const ConeRows& G) const;

 private:
  double eta_ = 1;
  Eigen::Vector3d w_ = {1, 0, 0};  ///< w' J w = 1.
};

}  // namespace holdfast::limit
