// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace holdfast::solver {

/// The numbers that multigrid's preconditioner computes with. Single precision suffices but for
/// slender robots; double takes about twice as long.
enum class Precision : std::uint8_t { kSingle, kDouble };

}  // namespace holdfast::solver
