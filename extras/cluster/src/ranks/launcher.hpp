// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

/// `holdfast-mpi --ranks N ...`: one process that starts mpirun and stands for all ranks, so that
/// whoever calls it gets one exit code and one line of what failed, whatever MPI does.
namespace holdfast::cluster {

/// If the arguments say --ranks: runs the others under mpirun, on so many ranks, and returns the
/// exit code: the program's own, or 70 where the ranks were ended by something else. None if they
/// do not say it.
std::optional<int> launch(const std::vector<std::string>& arguments);

/// The exit code of a rank: that of the program, or, started by launch(), one that mpirun does not
/// have itself.
int rank_exit_code(int code);

}  // namespace holdfast::cluster
