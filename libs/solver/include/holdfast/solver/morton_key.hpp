// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "holdfast/base/cell.hpp"
#include "holdfast/base/lattice.hpp"

namespace holdfast::solver {

/// The bricks of modules' cells: the coordinates that Morton keys are made of (docs/solver.md). In
/// a cubic lattice the cells themselves.
class Bricks {
 public:
  /// Keeps a reference.
  explicit Bricks(const base::Lattice& lattice)
      : lattice_(lattice), is_cubic_(base::unstretched(lattice) == base::kCubic) {}

  base::Cell of(const base::Cell& cell) const { return is_cubic_ ? cell : of_leaning(cell); }

 private:
  base::Cell of_leaning(const base::Cell& cell) const;

  const base::Lattice& lattice_;
  bool is_cubic_;  ///< Asked once: lattices are long to compare.
};

/// The bits of a brick's x, y and z in turns, from the lowest, counted from the lowest corner of
/// the robot. Clusters of the n-th level lie in cells of keys that agree but for the last 3 n bits.
std::uint64_t morton_key(const base::Cell& brick, const base::Cell& low);

}  // namespace holdfast::solver
