// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "holdfast/base/lattice.hpp"

/// Vectors and blocks of the preconditioner, for 8-lane arithmetic: of a node's eight lanes two are
/// zero, and in memory only where they are constants. Real is float, or double where robots are so
/// slender that bending drowns in single precision's rounding (precise_forces.hpp).
namespace holdfast::solver {

/// A node's vector.
template <class Real>
struct Six {
  Real v[6] = {};
};

/// A node's vector with the lanes that are zero: a constant that many nodes share.
template <class Real>
struct alignas(8 * sizeof(Real)) Eight {
  Real v[8] = {};
};

/// A 6x6 block by columns, and zeros to the end of the last one's eight lanes. In the last two
/// lanes of the others is what comes next; what that yields stays in them, and nobody reads it.
template <class Real>
struct Block {
  Real* column(int index) { return numbers + std::ptrdiff_t{6} * index; }

  const Real* column(int index) const { return numbers + std::ptrdiff_t{6} * index; }

  Real numbers[38] = {};
};

/// K12 of a beam along an axis has ten nonzeros: a diagonal, and one number in four rows at a place
/// that depends on the axis only. So K12 u = direct * u + crossed * swap(u), lane by lane.
template <class Real>
struct BeamRow {
  Eight<Real> direct;
  Eight<Real> crossed;
};

/// K12 of a pair of opposite directions, +d and -d. What couples displacements with displacements
/// and rotations with rotations is the same in both, what couples the two changes its sign. So with
/// the generalised diagonals of the 3x3 quarters of K12
///   K12 u_+ + K12' u_- = sum of direct_k * turn_k(u_+ + u_-) + crossed_k * turn_k(swap(u_+ -
///   u_-)),
/// where turn_k takes number i + k (of each three, cyclically) to place i.
template <class Real>
struct PairRow {
  Eight<Real> direct[3];
  Eight<Real> crossed[3];
};

/// A beam as its middle sees it.
struct MiddleSpring {
  Eight<double> stiffness;
  Eight<double> torque;  ///< Levers by which forces, crossed, are torques at the end.
  double shift[4] = {};  ///< Levers by which rotations, crossed, shift the middle.
};

/// A spring between clusters: S acts on the motion of one body less that of the other, carried
/// over by `arm`.
struct BodySpring {
  Block<double> stiffness;
  double arm[4] = {};  ///< mm, from the other body to the one; then zero.
};

/// Where a node sits in its cluster: u = [u_c + t_c x offset, t_c].
template <class Real>
struct Seat {
  Real offset[3] = {};  ///< mm, from the cluster's centre to the node.
  std::int32_t cluster = 0;
};

/// Direction -> pitches that the beam there is long, 0 for none.
using BeamLengths = std::array<std::uint8_t, base::Lattice::kDirectionCountMax>;

}  // namespace holdfast::solver
