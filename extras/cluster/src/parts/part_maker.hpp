// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include "holdfast/model/robot.hpp"
#include "parts/structure.hpp"

namespace holdfast::cluster {

/// The number of modules of the whole robot, of all and of some sorts.
struct ModuleCounts {
  std::size_t all = 0;
  std::size_t planned = 0;
  std::size_t fixed = 0;
  std::size_t facets = 0;
};

/// A rank's part of a robot, ready to be assessed.
struct Part {
  model::Robot robot;
  ModuleCounts counts;
};

/// Makes this rank's robot: its modules, and copies of their neighbours. All ranks return the same
/// error, such as that the whole robot is not connected or nothing holds it.
base::Result<Part> make_part(PetscRanks& ranks, const Structure& structure);

}  // namespace holdfast::cluster
