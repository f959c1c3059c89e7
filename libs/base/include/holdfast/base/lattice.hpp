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

constexpr std::array<ConnectorClass, 12> all_lateral() {
  std::array<ConnectorClass, 12> classes{};
  classes.fill(ConnectorClass::kLateral);
  return classes;
}

/// A lattice, as data; another one is another value of this type. Cells are the triples that
/// VisibleSim and our files use, (x, y, z). Their axial coordinates
///   (i, j, k) = (x - shear_x (z // 2), y - shear_y (z // 2), z),   // rounds down,
/// make the steps to the neighbours the same for every cell; the node of a cell, its module's
/// centre, is at pitch (i b1 + j b2 + k b3). Directions come in pairs: that of index d ^ 1 is the
/// opposite of that of index d, so the first of a pair has an even index. All neighbours are one
/// pitch apart, unless the lattice is stretched().
struct Lattice {
  static constexpr int kDirectionCountMax = 12;  ///< Of a face-centred lattice.

  using Squares = std::array<double, 3>;

  int direction_count = 0;
  std::array<Cell, kDirectionCountMax> steps{};  ///< To the neighbours, axial, by direction.
  std::array<ConnectorClass, kDirectionCountMax> connector_class{};  ///< By direction.
  /// The squares of the coordinates of b1, b2, b3, none of which is negative: global frame, unit:
  /// one pitch. Unlike the coordinates themselves they are exact.
  std::array<Squares, 3> basis_squares{};
  std::int32_t shear_x = 0;
  std::int32_t shear_y = 0;
  /// Index of the direction straight down, (0, 0, -1) in the global frame: that of a neighbour, or
  /// direction_count where no neighbour lies there, and a floor only is touched.
  int down = 0;

  friend constexpr bool operator==(const Lattice&, const Lattice&) = default;
};

/// Cubes: Blinky Blocks, sliding cubes, Smart Blocks. Directions as in Direction.
inline constexpr Lattice kCubic = {
    .direction_count = kDirectionCount,
    .steps = {{{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}}},
    .connector_class = {ConnectorClass::kLateral, ConnectorClass::kLateral,
                        ConnectorClass::kLateral, ConnectorClass::kLateral,
                        ConnectorClass::kVertical, ConnectorClass::kVertical},
    .basis_squares = {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}},
    .down = 5};

/// Spheres in a face-centred cubic packing, 3D catoms: four neighbours in the same layer, four
/// above, four below. None is straight above, so all connections are lateral.
inline constexpr Lattice kFaceCentred = {
    .direction_count = 12,
    .steps = {{{1, 0, 0},
               {-1, 0, 0},
               {0, 1, 0},
               {0, -1, 0},
               {0, 0, 1},
               {0, 0, -1},
               {-1, 0, 1},
               {1, 0, -1},
               {0, -1, 1},
               {0, 1, -1},
               {-1, -1, 1},
               {1, 1, -1}}},
    .connector_class = all_lateral(),
    .basis_squares = {{{1, 0, 0}, {0, 1, 0}, {0.25, 0.25, 0.5}}},
    .shear_x = 1,
    .shear_y = 1,
    .down = 12};

/// Standing discs, 2D catoms: the plane is x-z; discs of different y are no neighbours.
inline constexpr Lattice kHexagonal = {
    .direction_count = 6,
    .steps = {{{1, 0, 0}, {-1, 0, 0}, {0, 0, 1}, {0, 0, -1}, {-1, 0, 1}, {1, 0, -1}}},
    .connector_class = all_lateral(),
    .basis_squares = {{{1, 0, 0}, {0, 1, 0}, {0.25, 0, 0.75}}},
    .shear_x = 1,
    .down = 6};

/// Upright hexagonal prisms: Hexanodes, and stacks of them.
inline constexpr Lattice kHexagonalPrism = {
    .direction_count = 8,
    .steps = {{{1, 0, 0},
               {-1, 0, 0},
               {0, 1, 0},
               {0, -1, 0},
               {-1, 1, 0},
               {1, -1, 0},
               {0, 0, 1},
               {0, 0, -1}}},
    .connector_class = {ConnectorClass::kLateral, ConnectorClass::kLateral,
                        ConnectorClass::kLateral, ConnectorClass::kLateral,
                        ConnectorClass::kLateral, ConnectorClass::kLateral,
                        ConnectorClass::kVertical, ConnectorClass::kVertical},
    .basis_squares = {{{1, 0, 0}, {0.25, 0.75, 0}, {0, 0, 1}}},
    .down = 7};

/// Directions of a lattice to neighbours, by ascending index; or of its facets, that is with the
/// direction straight down where it is none of those.
class DirectionRange {
 public:
  class Iterator {
   public:
    constexpr explicit Iterator(int index) : index_(index) {}

    constexpr Direction operator*() const { return static_cast<Direction>(index_); }

    constexpr Iterator& operator++() {
      ++index_;
      return *this;
    }

    friend constexpr bool operator==(Iterator, Iterator) = default;

   private:
    int index_;
  };

  constexpr explicit DirectionRange(int count) : count_(count) {}

  constexpr Iterator begin() const { return Iterator(0); }

  constexpr Iterator end() const { return Iterator(count_); }

  constexpr std::size_t size() const { return static_cast<std::size_t>(count_); }

 private:
  int count_;
};

constexpr DirectionRange directions(const Lattice& lattice) {
  return DirectionRange(lattice.direction_count);
}

constexpr DirectionRange facet_directions(const Lattice& lattice) {
  return DirectionRange(lattice.down < lattice.direction_count ? lattice.direction_count
                                                               : lattice.direction_count + 1);
}

/// The direction straight down: of a facet, and of a neighbour if the lattice has one there.
constexpr Direction down(const Lattice& lattice) { return static_cast<Direction>(lattice.down); }

/// Half of a number, rounded down.
constexpr std::int32_t half_below(std::int32_t value) { return value >> 1; }

constexpr Cell axial_of(const Lattice& lattice, const Cell& cell) {
  const std::int32_t half = half_below(cell.z);
  return {cell.x - lattice.shear_x * half, cell.y - lattice.shear_y * half, cell.z};
}

constexpr Cell cell_of(const Lattice& lattice, const Cell& axial) {
  const std::int32_t half = half_below(axial.z);
  return {axial.x + lattice.shear_x * half, axial.y + lattice.shear_y * half, axial.z};
}

/// The cell next to `cell` in `direction`, one of the lattice.
constexpr Cell neighbour(const Lattice& lattice, const Cell& cell, Direction direction) {
  const Cell& step = lattice.steps[static_cast<std::size_t>(index(direction))];
  const std::int32_t half = half_below(cell.z + step.z) - half_below(cell.z);
  return {cell.x + step.x + lattice.shear_x * half, cell.y + step.y + lattice.shear_y * half,
          cell.z + step.z};
}

constexpr ConnectorClass connector_class(const Lattice& lattice, Direction direction) {
  return lattice.connector_class[static_cast<std::size_t>(index(direction))];
}

/// The square root of a number from 1/16 to 16, or of 0, to the last digit of Real but for
/// rounding: Newton's iteration.
template <class Real>
constexpr Real root(Real square) {
  if (square == Real(0) || square == Real(1)) {
    return square;
  }
  constexpr int kStepCount = 9;  // Within 1/8 after three, then twice the digits in each.
  Real value = 1;
  for (int step = 0; step < kStepCount; ++step) {
    value = (value + square / value) / Real(2);
  }
  return value;
}

/// The node of axial coordinates (i, j, k), in the global frame, in pitches.
template <class Real = double>
constexpr std::array<Real, 3> place_of(const Lattice& lattice, const Cell& axial) {
  std::array<Real, 3> place{};
  for (std::size_t i = 0; i < 3; ++i) {
    place[i] = Real(axial.x) * root(Real(lattice.basis_squares[0][i])) +
               Real(axial.y) * root(Real(lattice.basis_squares[1][i])) +
               Real(axial.z) * root(Real(lattice.basis_squares[2][i]));
  }
  return place;
}

/// The place of a cell's node in the global frame, in pitches; that of cell (0, 0, 0) is the
/// origin.
constexpr std::array<double, 3> node_place(const Lattice& lattice, const Cell& cell) {
  return place_of(lattice, axial_of(lattice, cell));
}

/// node_place() for very many cells, with the roots taken once, in another unit of length.
class NodePlaces {
 public:
  constexpr NodePlaces(const Lattice& lattice, double pitch)
      : shear_{.shear_x = lattice.shear_x, .shear_y = lattice.shear_y} {
    for (std::size_t i = 0; i < 3; ++i) {
      for (std::size_t k = 0; k < 3; ++k) {
        basis_[i][k] = pitch * root(lattice.basis_squares[i][k]);
      }
    }
  }

  constexpr std::array<double, 3> operator()(const Cell& cell) const {
    const Cell axial = axial_of(shear_, cell);
    std::array<double, 3> place{};
    for (std::size_t k = 0; k < 3; ++k) {
      place[k] = axial.x * basis_[0][k] + axial.y * basis_[1][k] + axial.z * basis_[2][k];
    }
    return place;
  }

 private:
  Lattice shear_;  ///< Nothing but its shear.
  std::array<std::array<double, 3>, 3> basis_{};
};

/// The vector of length one from a node to its neighbour in `direction`, or through its facet
/// there, in the global frame. The lattice is not stretched(); heading() knows those too.
template <class Real = double>
constexpr std::array<Real, 3> unit_vector(const Lattice& lattice, Direction direction) {
  if (direction == down(lattice)) {
    return {Real(0), Real(0), Real(-1)};
  }
  return place_of<Real>(lattice, lattice.steps[static_cast<std::size_t>(index(direction))]);
}

/// No length of a stretched lattice is longer than so many pitches: what root() can take.
inline constexpr double kStretchMax = 16;

/// The square of the length of b1, b2 or b3: exactly 1, but where a lattice is stretched.
constexpr double basis_square(const Lattice& lattice, std::size_t basis) {
  const Lattice::Squares& squares = lattice.basis_squares[basis];
  return squares[0] + squares[1] + squares[2];
}

/// Whether neighbours are not all one pitch apart: modules that are no cubes, or flat prisms.
constexpr bool is_stretched(const Lattice& lattice) {
  return basis_square(lattice, 0) != 1 || basis_square(lattice, 1) != 1 ||
         basis_square(lattice, 2) != 1;
}

/// Whether a lattice can be stretched along a global axis: if what leads along it leads nowhere
/// else, so that all frames of connections stay as they are.
constexpr bool can_stretch(const Lattice& lattice, std::size_t axis) {
  for (std::size_t basis = 0; basis < 3; ++basis) {
    const double square = lattice.basis_squares[basis][axis];
    if (square != 0 && square != basis_square(lattice, basis)) {
      return false;
    }
  }
  for (const Cell& step : lattice.steps) {
    const std::array<std::int32_t, 3> parts = {step.x, step.y, step.z};
    const int count = (parts[0] != 0 ? 1 : 0) + (parts[1] != 0 ? 1 : 0) + (parts[2] != 0 ? 1 : 0);
    if (count > 1 && parts[axis] != 0) {
      return false;
    }
  }
  return true;
}

/// The lattice with all lengths along the global axes multiplied by these factors, from 1 to
/// kStretchMax, 1 along those that it cannot be stretched along. With factors of 1 it is the same.
constexpr Lattice stretched(Lattice lattice, const std::array<double, 3>& factors) {
  for (Lattice::Squares& squares : lattice.basis_squares) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      squares[axis] *= factors[axis] * factors[axis];
    }
  }
  return lattice;
}

/// The lattice of which stretched() made this one: the same cells, neighbours and directions.
constexpr Lattice unstretched(Lattice lattice) {
  for (std::size_t basis = 0; basis < 3; ++basis) {
    const double square = basis_square(lattice, basis);
    for (double& part : lattice.basis_squares[basis]) {
      part = square == 1 ? part : part / square;
    }
  }
  return lattice;
}

/// The distance of a node from its neighbour in `direction`, or twice that from its facet there, in
/// pitches: the one place that says how long a connection is. Exactly 1 where nothing is stretched.
constexpr double step_length(const Lattice& lattice, Direction direction) {
  if (index(direction) >= lattice.direction_count) {
    return 1;
  }
  const Cell& step = lattice.steps[static_cast<std::size_t>(index(direction))];
  const std::array<std::int32_t, 3> parts = {step.x, step.y, step.z};
  double square = 1;
  for (std::size_t basis = 0; basis < 3; ++basis) {
    square = parts[basis] != 0 && basis_square(lattice, basis) != 1 ? basis_square(lattice, basis)
                                                                    : square;
  }
  return root(square);
}

/// unit_vector(), of a stretched lattice too.
template <class Real = double>
constexpr std::array<Real, 3> heading(const Lattice& lattice, Direction direction) {
  return is_stretched(lattice) ? unit_vector<Real>(unstretched(lattice), direction)
                               : unit_vector<Real>(lattice, direction);
}

/// The vector from a node to its neighbour in `direction`, or twice that to its facet there, in the
/// global frame, in pitches.
constexpr std::array<double, 3> way_to_neighbour(const Lattice& lattice, Direction direction) {
  std::array<double, 3> way = heading(lattice, direction);
  const double length = step_length(lattice, direction);
  for (double& part : way) {
    part *= length;
  }
  return way;
}

}  // namespace holdfast::base
