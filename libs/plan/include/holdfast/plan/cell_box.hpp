// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "holdfast/base/cell.hpp"
#include "holdfast/base/result.hpp"

namespace holdfast::plan {

/// All cells between two corners, which belong to it.
struct CellBox {
  base::Cell low;
  base::Cell high;

  bool contains(const base::Cell& cell) const {
    return low.x <= cell.x && cell.x <= high.x && low.y <= cell.y && cell.y <= high.y &&
           low.z <= cell.z && cell.z <= high.z;
  }
};

/// The box with two cells as corners, whichever.
CellBox box_between(const base::Cell& a, const base::Cell& b);

/// The modules that no step of a plan may touch: those of `modules` that are in one of the boxes,
/// each once, ascending. Error: a box has no module.
base::Result<std::vector<base::Cell>> kept_modules(std::span<const CellBox> boxes,
                                                   std::span<const base::Cell> modules);

}  // namespace holdfast::plan
