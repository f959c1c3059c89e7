// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "holdfast/base/lattice.hpp"
#include "holdfast/base/result.hpp"

/// The kinematics of a module as data: how it can go to another cell, and what that needs.
namespace holdfast::plan {

/// A way to another cell, as if the module were in the cell (0, 0, 0). All cells are axial.
struct Motion {
  std::string name = {};
  base::Cell to = {};
  std::vector<base::Cell> modules = {};  ///< Modules must be there: those that it goes along.
  std::vector<base::Cell> free = {};     ///< No module, obstacle or floor is there: it sweeps them.
};

/// All ways of a module.
struct Motions {
  std::string name = {};
  base::Lattice lattice = base::kCubic;
  /// The ways, in no order; where there are none, those of the lattice's own body
  /// (module_moves.hpp).
  std::vector<Motion> motions = {};
  /// Whether a module enters and leaves cells between two modules on opposite sides of them. 3D
  /// catoms do not, by the rule of their makers: two such neighbours leave their bodies no way.
  bool goes_between = true;
};

/// The images of a motion that are motions as well.
enum class MotionImages : std::uint8_t {
  kNone,      ///< It alone.
  kTurned,    ///< Turned as the lattice can be.
  kMirrored,  ///< And mirrored.
};

/// A motion and its images, each once, under the maps of the lattice onto itself that keep a cell:
/// 24 rotations of cubes and balls, 12 of prisms and discs.
std::vector<Motion> images_of(const base::Lattice& lattice, const Motion& motion,
                              MotionImages images);

/// What no module does, if so: a motion to a cell that is neither a neighbour (a slide) nor the
/// neighbour of one over a free cell between (a turn around a corner); a cell that has to be both
/// taken and free; a motion along no module.
base::Result<Motion> valid_motion(const base::Lattice& lattice, Motion motion);

/// What is wrong if they are asked of a robot with another lattice.
std::string motions_of_other_lattice(const Motions& motions);

/// Cubes that turn about an edge of a neighbour, and so need the cells that they sweep: by a
/// quarter to the next cell beside two modules in a row, by a half around the corner of one
/// ([Feshbach 2021]).
std::shared_ptr<const Motions> pivoting_cubes();

}  // namespace holdfast::plan
