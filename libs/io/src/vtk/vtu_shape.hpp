// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "shapes/module_shape.hpp"

namespace holdfast::io {

/// A module as a cell of VTK: its type, and its points in VTK's order, in pitches from the node.
///
/// What fills its cell is a hexahedron (12) or a hexagonal prism (16). Balls and discs are
/// hexahedra of 27 nodes (29), with the 26 outer ones on the sphere or cylinder: the one kind of
/// cell that ParaView shows round without a filter, the rounder the higher its *Nonlinear
/// Subdivision Level*, with a colour, a volume and a displacement of its own as any other cell.
/// (Points with glyphs would have to be set up by hand and do not turn; a polyhedron of as many
/// faces takes three times the room; rhombic dodecahedra fill space and hide what is between the
/// balls.)
struct VtuShape {
  std::uint8_t type = 0;
  std::vector<Place> points;
};

VtuShape vtu_shape(const base::Lattice& lattice);

}  // namespace holdfast::io
