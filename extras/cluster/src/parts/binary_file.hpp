// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "parts/structure.hpp"
#include "ranks/shared_text.hpp"

/// Binary structures (holdfast/io/binary_structure.hpp) that all ranks read at once.
namespace holdfast::cluster {

/// All ranks' sums together, modulo 2^64.
std::uint64_t sum_of_ranks(PetscRanks& ranks, std::uint64_t mine);

/// Whether a file begins as a binary structure does. One that cannot be read does not.
bool is_binary_file(PetscRanks& ranks, const std::string& file);

/// Reads this rank's modules by MPI-IO. All ranks return the same error: what is wrong, and at
/// which byte or module.
base::Result<std::pair<SharedText, std::vector<Record>>> read_binary_file(
    PetscRanks& ranks, const std::string& file, const io::ReadOptions& options);

}  // namespace holdfast::cluster
