// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "ranks/task_method.hpp"

#include <petsc/private/kspimpl.h>

#include <algorithm>
#include <cmath>
#include <span>

#include "holdfast/base/algebra.hpp"
#include "holdfast/host/ranks.hpp"

namespace holdfast::cluster {
namespace {

const host::KrylovTask& task_of(KSP solver) {
  Mat matrix = nullptr;
  void* context = nullptr;
  KSPGetOperators(solver, &matrix, nullptr);
  MatShellGetContext(matrix, &context);
  return **static_cast<const host::KrylovTask**>(context);
}

PetscErrorCode set_up(KSP) { return 0; }

PetscErrorCode solve(KSP solver) {
  solver->reason = KSP_CONVERGED_ITERATING;
  task_of(solver).iterate([solver](int iteration, double error) {
    solver->its = iteration;
    solver->rnorm = std::sqrt(std::abs(error));
    KSPLogResidualHistory(solver, solver->rnorm);
    KSPMonitor(solver, iteration, solver->rnorm);
    solver->converged(solver, iteration, solver->rnorm, &solver->reason, solver->cnvP);
    if (solver->reason == KSP_CONVERGED_ITERATING && iteration >= solver->max_it) {
      solver->reason = KSP_DIVERGED_ITS;
    }
    return solver->reason != KSP_CONVERGED_ITERATING;
  });
  if (solver->reason == KSP_CONVERGED_ITERATING) {
    solver->reason = KSP_DIVERGED_BREAKDOWN;
  }
  return 0;
}

/// Monitors of true residuals ask for it; the task's own.
PetscErrorCode build_residual(KSP solver, Vec, Vec room, Vec* residual) {
  const host::KrylovTask& task = task_of(solver);
  PetscScalar* numbers = nullptr;
  VecGetArrayWrite(room, &numbers);
  task.residual(numbers);
  VecRestoreArrayWrite(room, &numbers);
  *residual = room;
  return 0;
}

PetscErrorCode create(KSP solver) {
  KSPSetSupportedNorm(solver, KSP_NORM_NATURAL, PC_LEFT, 3);
  solver->ops->setup = set_up;
  solver->ops->solve = solve;
  solver->ops->destroy = KSPDestroyDefault;
  solver->ops->buildsolution = KSPBuildSolutionDefault;
  solver->ops->buildresidual = build_residual;
  return 0;
}

}  // namespace

void register_task_method() { KSPRegister(kTaskMethod, create); }

bool has_absent_monitor(KSP solver) {
  const auto monitors = std::span(solver->monitor).first(base::at(solver->numbermonitors));
  return std::ranges::any_of(monitors, [](auto one) { return one == nullptr; });
}

}  // namespace holdfast::cluster
