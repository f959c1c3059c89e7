// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "holdfast/base/cell.hpp"

/// The cells of the robot's box that are occupied: one bit each, in parts that fit into a message.
namespace holdfast::agent {

class OccupiedCells {
 public:
  static constexpr std::int64_t kCellsMax = 8192;
  static constexpr int kPartBytes = 24;
  static constexpr int kPartsMax = (kCellsMax / 8 + kPartBytes - 1) / kPartBytes;

  /// Is the box from `first` to `last`, both of them in it, small enough?
  static bool fits(const base::Cell& first, const base::Cell& last);

  /// An empty box, which fits.
  void begin(const base::Cell& first, const base::Cell& last);

  /// Adds a cell in the box.
  void add(const base::Cell& cell);

  /// Is the cell occupied? One outside of the box is not.
  bool has(const base::Cell& cell) const;

  bool is_in_box(const base::Cell& cell) const;

  int part_count() const { return part_count_; }

  std::span<std::uint8_t, kPartBytes> part(int index) {
    return std::span<std::uint8_t, kPartBytes>(bits_.data() + index * kPartBytes, kPartBytes);
  }

  /// Hands every occupied cell to visit(cell), by z, then y, then x.
  template <class Visit>
  void visit(Visit&& visit) const {
    for (std::int32_t z = 0; z < size_.z; ++z) {
      visit_layer(first_.z + z, visit);
    }
  }

  /// Hands every occupied cell at this height to visit(cell).
  template <class Visit>
  void visit_layer(std::int32_t z, Visit&& visit) const {
    for (std::int32_t y = 0; y < size_.y; ++y) {
      for (std::int32_t x = 0; x < size_.x; ++x) {
        const base::Cell cell = {first_.x + x, first_.y + y, z};
        if (has(cell)) {
          visit(cell);
        }
      }
    }
  }

 private:
  std::size_t index_of(const base::Cell& cell) const;

  base::Cell first_ = {};
  base::Cell size_ = {};
  int part_count_ = 0;
  std::array<std::uint8_t, std::size_t{kPartsMax} * kPartBytes> bits_{};
};

}  // namespace holdfast::agent
