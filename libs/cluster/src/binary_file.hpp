// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "shared_text.hpp"
#include "structure.hpp"

/// Binary structures, docs/formats.md: a head, a holdfast JSON text without modules, and the
/// modules along the Morton curve, each 16 bytes.
namespace holdfast::cluster {

/// FNV-1a, 64 bits.
std::uint64_t text_sum(std::string_view text);

/// A sum that ranks can make in parts: of a hash of each record and its number in the whole
/// structure, which of the first one here is `first`.
std::uint64_t record_sum(std::span<const Record> records, std::uint64_t first);

/// All ranks' sums together, modulo 2^64.
std::uint64_t sum_of_ranks(PetscRanks& ranks, std::uint64_t mine);

/// What stands before the records.
std::string binary_beginning(const base::Cell& low, const std::string& text,
                             std::uint64_t module_count, std::uint64_t record_sum);

/// Whether a file begins as a binary structure does. One that cannot be read does not.
bool is_binary_file(PetscRanks& ranks, const std::string& file);

/// Reads this rank's modules by MPI-IO. All ranks return the same error: what is wrong, and at
/// which byte or module.
base::Result<std::pair<SharedText, std::vector<Record>>> read_binary_file(PetscRanks& ranks,
                                                                          const std::string& file);

/// Writes a whole file or nothing; records along the curve. Called by one rank.
std::optional<base::Error> write_binary_file(const std::string& file, const base::Cell& low,
                                             const std::string& text,
                                             std::span<const Record> records);

}  // namespace holdfast::cluster
