// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "holdfast/base/lattice.hpp"

/// Shapes the modules of pictures, by lattice. Unit: one pitch; origin: the module's node;
/// global axes.
///
/// The cell of a lattice is what is nearer to its node than to any other, {p : p . n <= 1/2 for the
/// unit vectors n to all neighbours}: cube, hexagonal prism, rhombic dodecahedron, each stretched
/// as the lattice is. Every body lies inside its cell. So the plane halfway between two nodes keeps
/// one body on either side, and the one whose node is nearer to the eye is nowhere behind the
/// other.
namespace holdfast::io {

/// A point or a vector in pitches.
using Place = std::array<double, 3>;

constexpr double dot(const Place& a, const Place& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

constexpr Place sum(const Place& a, const Place& b) {
  return {a[0] + b[0], a[1] + b[1], a[2] + b[2]};
}

constexpr Place scaled(double factor, const Place& a) {
  return {factor * a[0], factor * a[1], factor * a[2]};
}

constexpr Place cross(const Place& a, const Place& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

/// A flat face of a convex body.
struct ShapeFace {
  Place normal{};              ///< Outwards, of length one.
  std::vector<Place> corners;  ///< Counter-clockwise, seen from outside.
  /// The direction of the neighbour that shares the face; none if there is no such direction.
  std::optional<base::Direction> direction;
};

/// The faces of a lattice's cell. One of a single layer is as deep as asked, that is across the
/// layer's plane.
std::vector<ShapeFace> cell_faces(const base::Lattice& lattice, double layer_depth = 1);

enum class Body : std::uint8_t {
  kCell,  ///< Fills its cell: cubes and prisms.
  kBall,  ///< Touches its neighbours in one point each: a sphere of one pitch.
  kDisc,  ///< A standing cylinder along y of one pitch and kDiscDepth.
};

inline constexpr double kDiscDepth = 0.5;

/// The body of a lattice's modules; modules of a lattice without an entry in the table fill cells.
Body body_of(const base::Lattice& lattice);

}  // namespace holdfast::io
