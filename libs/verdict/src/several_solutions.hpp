// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "situation.hpp"

/// Reports where the paper's contact law has several solutions (theory.md).
namespace holdfast::verdict {

/// The largest load ratio of all ranks' parts; NaN if one is. `low` is that of a Solution.
double load_ratio_max(const model::Robot& robot, const std::vector<base::Vec6<double>>& u,
                      const std::vector<base::Vec6<double>>& low);

/// Sets `assessment.several` from `assessment.equilibrium`, whose `others` are known, from what
/// lies between its two `answers`, and from the exact law's answer, with weak springs of `gamma`,
/// if multigrid's tolerance is so many times the usual; and in `assessment.model` whether by any of
/// them it falls or slips.
void compare_solutions(const Situation& here, solver::EquilibriumSolver& solver, double gamma,
                       const solver::EquilibriumOptions& options, const LoadRange& answers,
                       Assessment& assessment);

/// Whether all of them, the exact law's among them, break something if `is_broken`, and nothing if
/// not. False if the exact law has no answer.
bool do_agree(const SeveralSolutions& several, bool is_broken);

/// A reason that tells of them: how many were found, the range of the regularised law's, and of the
/// exact law's, from infinity down to minus infinity if it has no answer.
Reason reason_of(ReasonCode code, const SeveralSolutions& several);

}  // namespace holdfast::verdict
