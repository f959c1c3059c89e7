// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

/// `holdfast-mpi --ranks N ...`: one process that starts mpirun and stands for all ranks, so that
/// whoever calls it gets one exit code and one line of what failed, whatever MPI does.
namespace holdfast::cluster {

/// Runs the command under mpirun on as many ranks as --ranks says, and returns the exit code: the
/// program's own, or 70 if something else has ended the ranks. Returns none if there is no --ranks.
std::optional<int> launch(const std::vector<std::string>& arguments);

/// The exit code of a rank: that of the program, or, started by launch(), one that mpirun does not
/// have itself.
int rank_exit_code(int code);

}  // namespace holdfast::cluster
