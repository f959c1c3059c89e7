// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>

#include "holdfast/base/cell.hpp"

namespace holdfast::plan {

/// The level of a floor that bars the way of what would go below it; none without a floor, or where
/// one of the modules, in several ranges of cells, is below: such a floor is taken to end beside
/// the robot.
template <class... Cells>
std::optional<std::int32_t> barring_floor(std::optional<std::int32_t> support_z,
                                          const Cells&... modules) {
  const auto is_below = [&](const base::Cell& cell) { return cell.z < *support_z; };
  const bool ends = support_z && (std::ranges::any_of(modules, is_below) || ...);
  return ends ? std::nullopt : support_z;
}

}  // namespace holdfast::plan
