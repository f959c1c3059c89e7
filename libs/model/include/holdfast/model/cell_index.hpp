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

  /// For cells from `low` to `high` only.
  CellIndex(std::size_t cell_count_max, const base::Cell& low, const base::Cell& high);

  /// Adds a cell; returns kNone, or the index under which the cell was added before.
  std::int32_t insert(const base::Cell& cell, std::int32_t index);

  /// The index of a cell, or kNone.
  std::int32_t find(const base::Cell& cell) const;

 private:
  struct Slot {
    base::Cell cell;
    std::int32_t index = kNone;
  };

  std::size_t slot_of(const base::Cell& cell) const;
  bool is_inside(const base::Cell& cell) const;
  std::size_t place_of(const base::Cell& cell) const;

  base::Cell low_;
  std::array<std::uint32_t, 3> width_{};  ///< Of the box.
  std::vector<std::int32_t> table_;       ///< By place in the box; empty if there are slots.
  std::vector<Slot> slots_;
};

}  // namespace holdfast::model
