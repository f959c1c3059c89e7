// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace holdfast::solver {

/// How the search for an equilibrium ended.
enum class Outcome : std::uint8_t {
  kSettled,     ///< States and displacements are consistent.
  kNotSettled,  ///< The contact iteration cycles or takes too many steps.
  kSingular,    ///< A pivot vanished.
  kTooLarge,    ///< The solver does not fit into memory_bytes_max.
  kNotSought,   ///< The robot topples, and finding out how would take long.
  kTooSlow,     ///< No solver gets there: a robot too slender for double precision.
};

}  // namespace holdfast::solver
