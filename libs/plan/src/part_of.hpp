// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "holdfast/model/robot.hpp"
#include "holdfast/plan/element_set.hpp"

namespace holdfast::plan {

/// Takes away what a spec says of modules that it does not have.
void forget_absent(model::RobotSpec& spec);

/// What remains of a spec if only these of its modules are there.
model::RobotSpec part_of(const model::RobotSpec& spec, const ElementSet& modules);

}  // namespace holdfast::plan
