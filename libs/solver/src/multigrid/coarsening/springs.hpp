// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "factorization/block_kernels.hpp"
#include "holdfast/base/algebra.hpp"
#include "holdfast/base/lattice.hpp"
#include "holdfast/model/material.hpp"
#include "multigrid/kernels/vectors.hpp"

/// Springs between rigid bodies: how they look from elsewhere, and when they are longer.
///
/// A spring S of a body p acts on the difference of the motion of p and that of its partner q
/// carried over to p; T(a) [u, t] = [u + t x a, t] carries a motion by a. S is symmetric; with it
///   K_pp = sum of S_pq,   K_pq = -S_pq T(x_p - x_q).
namespace holdfast::solver {

using Mat = base::Mat6<double>;
using Point = std::array<double, 3>;

inline Point difference(const Point& a, const Point& b) {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}

inline double dot(const Point& a, const Point& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/// A spring as its node sees it.
struct Spring {
  Point direction = {};  ///< Unit vector, to its partner.
  double length = 0;     ///< mm, in that direction.
  Point middle = {};     ///< From the node.
  Point partner = {};    ///< From the node.
  Mat stiffness = {};    ///< At the node.
};

/// A spring in less memory: of the stiffness, which is symmetric, one half.
struct PackedSpring {
  PackedSpring() = default;

  explicit PackedSpring(const Spring& spring);

  Spring unpacked() const;
  Mat stiffness() const;

  /// The sum of the stiffness against displacements, in all directions.
  double strength() const { return half[0] + half[6] + half[11]; }

  Point direction = {};
  double length = 0;
  Point middle = {};
  Point partner = {};
  std::array<double, 21> half = {};  ///< Row by row, from the diagonal on.
};

/// The spring of a beam `length` pitches long.
Spring beam_spring(const base::Lattice& lattice, const model::Material& material,
                   std::size_t direction, std::size_t length);

/// The vector from the centre of its cluster to a node, mm.
template <class Real>
Point offset(const Seat<Real>& seat) {
  return {static_cast<double>(seat.offset[0]), static_cast<double>(seat.offset[1]),
          static_cast<double>(seat.offset[2])};
}

/// Distance from a node back to the centre of its cluster, against a direction.
double behind(const Point& offset, const Point& direction);

Point scaled(const Point& point, double factor);

/// S T(a).
Mat times_carry(Mat s, const Point& a);

/// T(a)^T S T(a): a spring at x, seen from the point x - a.
Mat carried(const Mat& s, const Point& a);

/// Chosen on solids, plates, frames and random robots: with 0 plates need twice the iterations,
/// with 1 solids need half as many again.
inline constexpr double kBendShare = 0.6;

/// The clusters' corrections may be a little too small rather than too large; 1 to 1.3 differ
/// little.
inline constexpr double kCorrection = 1.2;

/// Lengthens a spring along a unit vector, whose middle lies at `arm` from its body, from `length`
/// to `reach`, as if its compliance were spread evenly along it: each part bends, and what bends
/// away from the middle shifts it. So the compliance is multiplied by reach/length, after its shear
/// part gained (reach^2 - length^2)/12 times the rotational one: that makes a beam of one length a
/// beam of the other exactly. In a solid the neighbours hinder the bending, so only kBendShare of
/// that is taken, and the stiffness is kCorrection times that.
Mat stretched(const Mat& stiffness, const Point& arm, const Point& direction, double length,
              double reach);

}  // namespace holdfast::solver
