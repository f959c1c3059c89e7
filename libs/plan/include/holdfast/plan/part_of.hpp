// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "holdfast/model/robot.hpp"
#include "holdfast/plan/element_set.hpp"

namespace holdfast::plan {

/// What remains of a spec if only these of its modules are there.
model::RobotSpec part_of(const model::RobotSpec& spec, const ElementSet& modules);

/// Some modules of the target as far as they are connected.
std::vector<ElementSet> pieces_of(const model::Robot& target, const ElementSet& modules);

}  // namespace holdfast::plan
