// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

#include "holdfast/base/result.hpp"
#include "ranks/petsc_ranks.hpp"

namespace holdfast::cluster {

/// Writes a structure of a family (model/families.hpp) as a binary one, all ranks a part each, with
/// a fixed amount of memory. Returns how many modules it has. Errors, the same at all ranks: a
/// family that cannot be made in parts, a size that is not allowed, a file that cannot be written,
/// which is then not there.
base::Result<std::uint64_t> generate_in_parts(PetscRanks& ranks, const std::string& family,
                                              std::size_t size, const std::string& file);

}  // namespace holdfast::cluster
