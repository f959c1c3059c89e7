// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>

#include "holdfast/base/algebra.hpp"
#include "holdfast/solver/lanes.hpp"

/// Forward and backward substitution for several right-hand sides at once, compiled twice: for the
/// machine that the compiler aims at and for AVX2.
namespace holdfast::solver {

/// The factors of BlockLu as they lie.
struct FactorView {
  std::size_t place_count = 0;
  const std::size_t* column_start = nullptr;
  const std::int32_t* rows = nullptr;
  const base::Mat6<double>* lower = nullptr;
  const base::Mat6<double>* upper = nullptr;
  const base::Mat6<double>* inverse = nullptr;  ///< Of the pivots.
};

/// Solves in place; y by place in the order of elimination.
using LaneSubstitution = void (*)(const FactorView& factors, LaneBlock* y);

/// The one for this machine.
LaneSubstitution lane_substitution();

}  // namespace holdfast::solver
