// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

#include "holdfast/model/families.hpp"
#include "holdfast/model/robot.hpp"

namespace holdfast::test {

/// A robot of a family, on its floor.
inline model::RobotSpec family_spec(const char* name, std::size_t size) {
  const model::Family family = model::find_family(name).value();
  return {.existing = model::family_cells(family, size), .lattice = model::family_lattice(family)};
}

}  // namespace holdfast::test
