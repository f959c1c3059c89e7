// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "holdfast/base/cell.hpp"

/// Lattices as tables: which cells are neighbours, where they are, and what connects them.
namespace holdfast::base {

/// The connectors of a module: those that join modules one above the other, and all others.
enum class ConnectorClass : std::uint8_t { kVertical, kLateral };

/// A lattice. The node of a cell (i, j, k), its module's centre, is at pitch (i b1 + j b2 + k b3);
/// the steps to the neighbours are the same for every cell. Directions come in pairs: that of index
/// d ^ 1 is the opposite of that of index d, so the first of a pair has an even index. All
/// neighbours are one pitch apart.
struct Lattice {
  static constexpr int kDirectionCountMax = 12;  ///< Of a face-centred lattice.

  int direction_count = 0;
  std::array<Cell, kDirectionCountMax> steps{};  ///< To the neighbours, by direction.
  std::array<ConnectorClass, kDirectionCountMax> connector_class{};  ///< By direction.
  std::array<std::array<double, 3>, 3> basis{};  ///< b1, b2, b3: global frame, unit: one pitch.
};

/// Cubes: Blinky Blocks, sliding cubes, Smart Blocks. Directions as in Direction.
inline constexpr Lattice kCubic = {
    .direction_count = kDirectionCount,
    .steps = {{{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}}},
    .connector_class = {ConnectorClass::kLateral, ConnectorClass::kLateral,
                        ConnectorClass::kLateral, ConnectorClass::kLateral,
                        ConnectorClass::kVertical, ConnectorClass::kVertical},
    .basis = {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}}};

/// The cell next to `cell` in `direction`, one of the lattice.
constexpr Cell neighbour(const Lattice& lattice, const Cell& cell, Direction direction) {
  const Cell& step = lattice.steps[static_cast<std::size_t>(index(direction))];
  return {cell.x + step.x, cell.y + step.y, cell.z + step.z};
}

constexpr ConnectorClass connector_class(const Lattice& lattice, Direction direction) {
  return lattice.connector_class[static_cast<std::size_t>(index(direction))];
}

/// From a node to its neighbour in `direction`, in the global frame: a vector of length one.
constexpr std::array<double, 3> unit_vector(const Lattice& lattice, Direction direction) {
  const Cell step = neighbour(lattice, Cell{}, direction);
  std::array<double, 3> vector{};
  for (std::size_t i = 0; i < 3; ++i) {
    vector[i] =
        step.x * lattice.basis[0][i] + step.y * lattice.basis[1][i] + step.z * lattice.basis[2][i];
  }
  return vector;
}

}  // namespace holdfast::base
