// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <compare>
#include <cstdint>

/// Cells of a lattice, and directions; those named are the six of a cubic one. Unit: one cell; z
/// points up.
namespace holdfast::base {

/// Cell coordinates may not leave this range; sums over a whole robot then stay exact integers.
inline constexpr std::int32_t kCoordinateMax = 1'000'000;

struct Cell {
  std::int32_t x = 0;
  std::int32_t y = 0;
  std::int32_t z = 0;

  friend constexpr auto operator<=>(const Cell&, const Cell&) = default;
};

/// Directions to neighbours, by index; a direction and its opposite differ in the lowest bit only.
/// Named are the six of a cube; other lattices have up to twelve (lattice.hpp).
enum class Direction : std::uint8_t { kPlusX, kMinusX, kPlusY, kMinusY, kPlusZ, kMinusZ };

inline constexpr int kDirectionCount = 6;

inline constexpr std::array<Direction, kDirectionCount> kDirections = {
    Direction::kPlusX,  Direction::kMinusX, Direction::kPlusY,
    Direction::kMinusY, Direction::kPlusZ,  Direction::kMinusZ};

constexpr int index(Direction direction) { return static_cast<int>(direction); }

constexpr Direction opposite(Direction direction) {
  return static_cast<Direction>(static_cast<std::uint8_t>(direction) ^ 1U);
}

constexpr bool is_vertical(Direction direction) {
  return direction == Direction::kPlusZ || direction == Direction::kMinusZ;
}

/// The cell that shares the face of `cell` in `direction`.
constexpr Cell neighbour(Cell cell, Direction direction) {
  const std::int32_t step = (index(direction) % 2 == 0) ? 1 : -1;
  switch (index(direction) / 2) {
    case 0:
      cell.x += step;
      break;
    case 1:
      cell.y += step;
      break;
    default:
      cell.z += step;
  }
  return cell;
}

}  // namespace holdfast::base
