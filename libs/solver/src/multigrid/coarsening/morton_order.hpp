// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "holdfast/host/team.hpp"
#include "holdfast/model/robot.hpp"

namespace holdfast::solver {

/// The rows, columns and layers of a lattice as bricks are laid: every other row or layer of an
/// oblique basis vector lies half a brick aside. So a box of bricks is a box in space, but for its
/// rough sides, while one of axial cells is oblique. In a cubic lattice both are the same.
base::Cell brick_of(const base::Lattice& lattice, const base::Cell& axial);
base::Cell axial_of_brick(const base::Lattice& lattice, const base::Cell& brick);

/// A colour, below 4, that no neighbour has: bricks of one row alternate, and so do rows or layers
/// of oblique basis vectors. In a cubic lattice, where there are none, there are two.
std::uint8_t colour_of_brick(const base::Lattice& lattice, const base::Cell& brick);

/// A module, and the Morton key of its brick from the robot's lowest corner on: the bits of x, y
/// and z in turns, from the lowest.
struct KeyedModule {
  std::uint64_t key = 0;
  std::int32_t module = 0;
};

/// Modules along the Morton curve, which keeps neighbours near each other.
struct MortonOrder {
  std::vector<KeyedModule> modules;
  base::Cell low;           ///< The robot's lowest corner, in bricks.
  std::int32_t extent = 0;  ///< Longest side of the box around them, bricks.
};

/// Sorts the modules that are not `is_gone`. Of a part of a robot its own modules come first, then
/// the copies; keys count from the whole robot's corner, and the extent is the whole's.
MortonOrder morton_order(const model::Robot& robot, const std::vector<std::uint8_t>& is_gone,
                         host::Team& team);

}  // namespace holdfast::solver
