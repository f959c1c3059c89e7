// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <bitset>
#include <span>
#include <vector>

#include "holdfast/model/cell_index.hpp"
#include "shapes/view_axes.hpp"

namespace holdfast::io {

/// Finds balls of a lattice that nobody can see, because other balls nearer to the eye cover their
/// whole disc. The disc is cut into squares; a square counts as covered if all of it lies behind
/// one ball. So a ball that is called hidden is hidden, but one that is almost hidden may not be
/// found.
class BallCover {
 public:
  BallCover(const base::Lattice& lattice, const ViewAxes& axes);

  /// Whether balls of `cells` hide the ball in `cell`.
  bool hides(const model::CellIndex& cells, const base::Cell& cell) const;

 private:
  static constexpr std::size_t kSquaresAcross = 32;

  using Squares = std::bitset<kSquaresAcross * kSquaresAcross>;

  struct Blocker {
    base::Cell step;  ///< From the hidden ball, axial.
    Squares squares;  ///< What it covers.
  };

  base::Lattice lattice_;
  Squares disc_;  ///< All squares that the disc meets.
  std::vector<Blocker> blockers_;
};

}  // namespace holdfast::io
