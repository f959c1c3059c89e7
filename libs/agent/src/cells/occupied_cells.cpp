// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "holdfast/agent/cells/occupied_cells.hpp"

namespace holdfast::agent {

bool OccupiedCells::fits(const base::Cell& first, const base::Cell& last) {
  std::int64_t cells = 1;
  for (const auto& [low, high] :
       {std::array{first.x, last.x}, std::array{first.y, last.y}, std::array{first.z, last.z}}) {
    if (high < low || high - low >= kCellsMax) {
      return false;
    }
    cells *= high - low + 1;
    if (cells > kCellsMax) {
      return false;
    }
  }
  return true;
}

void OccupiedCells::begin(const base::Cell& first, const base::Cell& last) {
  first_ = first;
  size_ = {last.x - first.x + 1, last.y - first.y + 1, last.z - first.z + 1};
  constexpr std::int32_t kPartCells = 8 * kPartBytes;
  part_count_ = (size_.x * size_.y * size_.z + kPartCells - 1) / kPartCells;
  bits_ = {};
}

bool OccupiedCells::is_in_box(const base::Cell& cell) const {
  const auto is_in = [](std::int32_t value, std::int32_t first, std::int32_t size) {
    return value >= first && value - first < size;
  };
  return is_in(cell.x, first_.x, size_.x) && is_in(cell.y, first_.y, size_.y) &&
         is_in(cell.z, first_.z, size_.z);
}

std::size_t OccupiedCells::index_of(const base::Cell& cell) const {
  return static_cast<std::size_t>(((cell.z - first_.z) * size_.y + cell.y - first_.y) * size_.x +
                                  cell.x - first_.x);
}

void OccupiedCells::add(const base::Cell& cell) {
  const std::size_t index = index_of(cell);
  bits_[index / 8] = static_cast<std::uint8_t>(bits_[index / 8] | (1U << (index % 8)));
}

bool OccupiedCells::has(const base::Cell& cell) const {
  if (!is_in_box(cell)) {
    return false;
  }
  const std::size_t index = index_of(cell);
  return (bits_[index / 8] >> (index % 8) & 1U) != 0;
}

}  // namespace holdfast::agent
