// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "holdfast/holdfast.hpp"

namespace holdfast::instrument {

/// What all modules of the structure's robot have in common, as its bytes lie in their pages.
/// Errors: a robot that modules do not know.
base::Result<std::vector<std::uint8_t>> setup_of(const Structure& structure);

}  // namespace holdfast::instrument
