// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>

namespace holdfast::solver {

/// Right-hand sides that are solved together.
inline constexpr std::size_t kLaneCount = 16;

/// What a node has in each of kLaneCount right-hand sides or solutions: by component [x y z and
/// about x y z], then by lane.
struct alignas(32) LaneBlock {
  double values[6][kLaneCount] = {};
};

/// A number for each of them.
using LaneNumbers = std::array<double, kLaneCount>;

}  // namespace holdfast::solver
