// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "slides/slide_grid.hpp"

namespace holdfast::plan {

/// The potential of cells that are no cube's way.
inline constexpr int kNoPotential = 1 << 20;

/// How far each cell of a grid is from where a cube is wanted, in moves, by cell: the least of
/// distance - price over all goals, with the prices of a cheapest assignment of modules to goals.
/// A walk is worth as many moves as it lowers the potential by, and one of the assignment's lowers
/// it by one in every move. `goals`: free cells, as many as there are `modules` that are to leave.
///
/// Distances are those of moves along the surfaces of both shapes, each cell of which is empty or
/// filled as it suits the walker; to enter a cell that both shapes fill counts double.
std::vector<int> slide_potential(const SlideGrid& grid, std::span<const GridCell> modules,
                                 std::span<const GridCell> goals);

}  // namespace holdfast::plan
