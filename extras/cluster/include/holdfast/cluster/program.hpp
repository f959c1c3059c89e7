// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace holdfast::cluster {

/// The program holdfast-mpi, from its arguments to its exit code: one rank of as many as MPI has
/// started. Begins and ends MPI and PETSc.
int run(int argc, char** argv);

}  // namespace holdfast::cluster
