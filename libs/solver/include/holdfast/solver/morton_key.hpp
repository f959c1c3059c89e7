// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "holdfast/base/cell.hpp"
#include "holdfast/base/lattice.hpp"

namespace holdfast::solver {

/// The brick of a module's cell: the coordinates that Morton keys are made of (docs/solver.md). In
/// a cubic lattice the cell itself.
base::Cell brick_of_cell(const base::Lattice& lattice, const base::Cell& cell);

/// The bits of a brick's x, y and z in turns, from the lowest, counted from the lowest corner of
/// the robot. Clusters of the n-th level lie in cells of keys that agree but for the last 3 n bits.
std::uint64_t morton_key(const base::Cell& brick, const base::Cell& low);

}  // namespace holdfast::solver
