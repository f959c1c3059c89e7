// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <petscksp.h>

/// A KSP that leaves the iteration to the task it works on (host::KrylovTask), whose directions are
/// in the preconditioner's own precision and whose vectors are its own: PETSc's options, monitors
/// and logs see it as they see any other method. Its matrix is a MATSHELL whose context points to
/// the task.
namespace holdfast::cluster {

/// The KSPType of the method.
inline constexpr const char* kTaskMethod = "holdfast";

/// Makes it known to PETSc; once is enough, more often does no harm.
void register_task_method();

/// Whether options ask for a monitor in a format that it does not have: PETSc 3.18 takes note of no
/// function then, and calls it.
bool has_absent_monitor(KSP solver);

}  // namespace holdfast::cluster
