// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "holdfast/plan/move_plan.hpp"

namespace holdfast::plan {

/// What bars ways in the plans for a task.
MoveRule rule_of(const MoveTask& task);

/// The robot of one of the ends, its kept modules marked as far as it has them.
RobotState kept_state(const MoveTask& task, const model::RobotSpec& spec);

/// What is wrong with where the modules of one of the ends are: one is in a cell to be avoided, or
/// outside the box and does not stay. `which` names the end.
std::optional<base::Error> find_cell_fault(const MoveTask& task, const model::RobotSpec& spec,
                                           const std::string& which);

}  // namespace holdfast::plan
