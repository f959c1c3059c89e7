// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "situation.hpp"

/// What to say where the paper's contact law has several solutions (theory.md).
namespace holdfast::verdict {

/// What load ratios may be off by rounding alone, as a share of the largest or of 1.
inline constexpr double kRounding = 1e-12;

/// What weak springs that are not taken back from the unilateral contact of a stable robot may
/// move, in the same terms: so many times their share of the contact's stiffness, besides what
/// their energy may do. In a robot of 4,327 modules with long thin limbs springs of 1e-9 moved the
/// largest load ratio by 1.4e-4, and of 1e-6 by 4 %, so this alone is no bound.
inline constexpr double kWeakSprings = 1e3;

/// What multigrid may be off by, as it promises (docs/solver.md).
inline constexpr double kMultigridError = 1e-4;

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
