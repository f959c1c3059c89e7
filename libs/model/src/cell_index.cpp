// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "holdfast/model/cell_index.hpp"

#include <bit>

namespace holdfast::model {
namespace {

/// The number of places per cell up to which the table is smaller than the slots, or not much
/// larger.
constexpr std::uint64_t kPlacesPerCell = 16;

std::uint32_t width(std::int32_t low, std::int32_t high) {
  return static_cast<std::uint32_t>(high - low) + 1;
}

}  // namespace

CellIndex::CellIndex(std::size_t cell_count_max) : slots_(std::bit_ceil(2 * cell_count_max + 2)) {}

CellIndex::CellIndex(std::size_t cell_count_max, const base::Cell& low, const base::Cell& high)
    : low_(low), width_({width(low.x, high.x), width(low.y, high.y), width(low.z, high.z)}) {
  const std::uint64_t places = std::uint64_t{width_[0]} * width_[1] * width_[2];
  if (places <= kPlacesPerCell * cell_count_max) {
    table_.assign(places, kNone);
  } else {
    *this = CellIndex(cell_count_max);
  }
}

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
  if (!table_.empty()) {
    std::int32_t& place = table_[place_of(cell)];
    return place == kNone ? (place = index, kNone) : place;
  }
  Slot& slot = slots_[slot_of(cell)];
  if (slot.index == kNone) {
    slot = {cell, index};
    return kNone;
  }
  return slot.index;
}

}  // namespace holdfast::model
