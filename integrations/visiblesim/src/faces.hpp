// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "holdfast/base/cell.hpp"

namespace holdfast::visiblesim {

/// The face that looks towards the cell one `step` away; none if that is no neighbour. VisibleSim
/// numbers a block's connectors as they lie in the block, which may be turned, and says for each
/// where it leads.
constexpr std::optional<base::Direction> face_towards(const base::Cell& step) {
  for (const base::Direction direction : base::kDirections) {
    if (base::neighbour({}, direction) == step) {
      return direction;
    }
  }
  return std::nullopt;
}

}  // namespace holdfast::visiblesim
