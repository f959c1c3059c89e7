// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <vector>

#include "holdfast/plan/sequence.hpp"

namespace holdfast::plan::test {

/// The lattices that there are, and cubes that are not as long as wide.
inline const std::array<base::Lattice, 5> kLatticesAndBricks = {
    base::kCubic, base::kFaceCentred, base::kHexagonal, base::kHexagonalPrism,
    base::stretched(base::kCubic, {1.5, 2, 1})};

/// The cells up to two steps away from a cell.
inline std::vector<base::Cell> cells_near(const base::Lattice& lattice, const base::Cell& cell) {
  std::vector<base::Cell> cells;
  for (const base::Direction first : base::directions(lattice)) {
    const base::Cell one = base::neighbour(lattice, cell, first);
    cells.push_back(one);
    for (const base::Direction second : base::directions(lattice)) {
      cells.push_back(base::neighbour(lattice, one, second));
    }
  }
  std::ranges::sort(cells);
  cells.erase(std::unique(cells.begin(), cells.end()), cells.end());
  return cells;
}

inline model::Step move(const base::Cell& from, const base::Cell& to) {
  return {.moves = {{.from = from, .to = to, .carrier = {}}}};
}

/// The moves of one module that can be done, without what they do to the robot.
inline std::vector<model::Step> moves_of(const RobotState& robot, const base::Cell& from) {
  std::vector<model::Step> moves;
  for (const base::Cell& to : cells_near(robot.lattice(), from)) {
    if (find_transition(robot, move(from, to))) {
      moves.push_back(move(from, to));
    }
  }
  return moves;
}

}  // namespace holdfast::plan::test
