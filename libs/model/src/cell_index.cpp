// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "holdfast/model/cell_index.hpp"

#include <bit>

namespace holdfast::model {

CellIndex::CellIndex(std::size_t cell_count_max) : slots_(std::bit_ceil(2 * cell_count_max + 2)) {}

std::size_t CellIndex::slot_of(const base::Cell& cell) const {
  std::uint64_t key = static_cast<std::uint32_t>(cell.x);
  key = key * 0x9e3779b97f4a7c15U + static_cast<std::uint32_t>(cell.y);
  key = key * 0x9e3779b97f4a7c15U + static_cast<std::uint32_t>(cell.z);
  key ^= key >> 29U;
  key *= 0xbf58476d1ce4e5b9U;
  key ^= key >> 32U;
  std::size_t slot = key & (slots_.size() - 1);
  while (slots_[slot].index != kNone && slots_[slot].cell != cell) {
    slot = (slot + 1) & (slots_.size() - 1);
  }
  return slot;
}

std::int32_t CellIndex::insert(const base::Cell& cell, std::int32_t index) {
  Slot& slot = slots_[slot_of(cell)];
  if (slot.index == kNone) {
    slot = {cell, index};
    return kNone;
  }
  return slot.index;
}

std::int32_t CellIndex::find(const base::Cell& cell) const { return slots_[slot_of(cell)].index; }

}  // namespace holdfast::model
