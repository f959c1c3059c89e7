// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "holdfast/base/cell.hpp"

namespace holdfast::model {

/// Finds a cell's position in a list in constant time: in a table of all cells of a box where that
/// is not much larger than the list, else by open addressing with linear probing. It is only ever
/// asked, never walked through, so results do not depend on the hash.
class CellIndex {
 public:
  static constexpr std::int32_t kNone = -1;

  explicit CellIndex(std::size_t cell_count_max);

  /// An index that has room for cells from `low` to `high` only.
  CellIndex(std::size_t cell_count_max, const base::Cell& low, const base::Cell& high);

  /// Adds a cell; returns kNone, or the index under which the cell was added before.
  std::int32_t insert(const base::Cell& cell, std::int32_t index);

  /// The index of a cell, or kNone.
  std::int32_t find(const base::Cell& cell) const {
    if (!table_.empty()) {
      return is_inside(cell) ? table_[place_of(cell)] : kNone;
    }
    return slots_[slot_of(cell)].index;
  }

 private:
  struct Slot {
    base::Cell cell;
    std::int32_t index = kNone;
  };

  std::size_t slot_of(const base::Cell& cell) const;

  bool is_inside(const base::Cell& cell) const {
    return static_cast<std::uint32_t>(cell.x - low_.x) < width_[0] &&
           static_cast<std::uint32_t>(cell.y - low_.y) < width_[1] &&
           static_cast<std::uint32_t>(cell.z - low_.z) < width_[2];
  }

  std::size_t place_of(const base::Cell& cell) const {
    const auto x = static_cast<std::size_t>(cell.x - low_.x);
    const auto y = static_cast<std::size_t>(cell.y - low_.y);
    const auto z = static_cast<std::size_t>(cell.z - low_.z);
    return (z * width_[1] + y) * width_[0] + x;
  }

  base::Cell low_;
  std::array<std::uint32_t, 3> width_{};  ///< Of the box.
  std::vector<std::int32_t> table_;       ///< By place in the box; empty if there are slots.
  std::vector<Slot> slots_;
};

}  // namespace holdfast::model
