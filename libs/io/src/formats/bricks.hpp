// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>

#include "formats/foreign_reading.hpp"

namespace holdfast::io {

/// The studs of a brick of one height.
struct BrickSize {
  std::int32_t along_x = 1;
  std::int32_t along_y = 1;
};

/// The size of a brick of StableLego's library that is not turned; none for other numbers.
std::optional<BrickSize> stable_lego_brick(std::int32_t number);

/// Adds a module for each stud of a brick, from the corner with the lowest coordinates.
void add_brick(ForeignReading& reading, const base::Cell& corner, const BrickSize& size);

}  // namespace holdfast::io
