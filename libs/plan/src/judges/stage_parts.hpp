// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <optional>

#include "holdfast/plan/sequence.hpp"

namespace holdfast::plan {

/// Steps in any order of so many modules at most have every part checked, 254 for 8, where no bound
/// covers all of them.
inline constexpr std::size_t kCheckedPartsMax = 8;

/// The stage in which parts of a step in any order count: connect if it attaches, else shift.
Stage stage_of_parts(const model::Step& step);

/// Judges a step, of which the step in any order is `part` of the modules, at that stage.
using JudgePart = std::function<base::Result<StageJudgement>(const model::Step& part)>;

/// What the parts of a step in any order come to, but for all of its modules and none: certified by
/// a BatchBound, else the worst of all parts, else `undecided`, unless one of the parts with a
/// single module, or all but one, is worse. Errors: those of `judge_part`.
base::Result<StageJudgement> judge_parts(const RobotState& before, const model::Step& step,
                                         const solver::EquilibriumOptions& options,
                                         const JudgePart& judge_part);

}  // namespace holdfast::plan
