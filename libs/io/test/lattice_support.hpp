// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <ostream>
#include <string>
#include <vector>

#include "picture_support.hpp"

/// Robots of every lattice for the tests of pictures.
namespace holdfast::io::picture_test {

using Place = std::array<double, 3>;

struct NamedLattice {
  const char* name;
  base::Lattice lattice;

  /// Names the lattice in failures.
  friend void PrintTo(const NamedLattice& named, std::ostream* out) { *out << named.name; }
};

inline constexpr std::array<NamedLattice, 4> kLattices = {{{"cubic", base::kCubic},
                                                           {"face-centred", base::kFaceCentred},
                                                           {"hexagonal", base::kHexagonal},
                                                           {"prism", base::kHexagonalPrism}}};

inline constexpr double dot(const Place& a, const Place& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/// Grows from cell (0, 0, 0) upwards, by random neighbours.
inline std::vector<Cell> random_cells(const base::Lattice& lattice, std::uint32_t seed,
                                      std::size_t count) {
  std::vector<Cell> cells = {{0, 0, 0}};
  std::uint32_t random = seed * 2654435761U + 1;
  const auto below = [&](std::uint32_t limit) {
    random = random * 1664525U + 1013904223U;
    return (random >> 8U) % limit;
  };
  while (cells.size() < count) {
    const Cell& host = cells[below(static_cast<std::uint32_t>(cells.size()))];
    const auto direction =
        static_cast<base::Direction>(below(static_cast<std::uint32_t>(lattice.direction_count)));
    const Cell next = base::neighbour(lattice, host, direction);
    if (next.z >= 0 && std::ranges::find(cells, next) == cells.end()) {
      cells.push_back(next);
    }
  }
  return cells;
}

/// A robot on a floor; the last modules are planned.
inline model::RobotSpec random_lattice_robot(const base::Lattice& lattice, std::uint32_t seed,
                                             std::size_t count, std::size_t planned_count = 0) {
  model::RobotSpec spec = {.existing = random_cells(lattice, seed, count)};
  spec.lattice = lattice;
  const auto first = spec.existing.end() - static_cast<std::ptrdiff_t>(planned_count);
  spec.planned.assign(first, spec.existing.end());
  spec.existing.erase(first, spec.existing.end());
  return spec;
}

inline std::string text_of(const Cell& cell) {
  return fmt::format("({},{},{})", cell.x, cell.y, cell.z);
}

}  // namespace holdfast::io::picture_test
