// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "holdfast/base/lattice.hpp"
#include "holdfast/model/robot.hpp"

namespace holdfast::plan {

/// Whether each robot takes a solution by itself, as no faster way judges it: for what bending
/// does, and where beams differ in length, which the bounds do not know.
inline bool needs_own_solution(const model::Robot& robot) {
  return robot.is_modulus_stated() || base::is_stretched(robot.lattice());
}

}  // namespace holdfast::plan
