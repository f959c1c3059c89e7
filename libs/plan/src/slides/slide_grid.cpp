// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "slides/slide_grid.hpp"

#include <bit>

namespace holdfast::plan {
namespace {

using base::Cell;

/// The cells around the middle one of 27, numbered x + 3 y + 9 z: by each a mask of its neighbours.
constexpr std::array<std::uint32_t, 27> kBeside = [] {
  std::array<std::uint32_t, 27> masks{};
  for (int a = 0; a < 27; ++a) {
    for (const auto& [stride, place] :
         {std::pair(1, a % 3), std::pair(3, a / 3 % 3), std::pair(9, a / 9)}) {
      masks[static_cast<std::size_t>(a)] |= place > 0 ? 1U << (a - stride) : 0U;
      masks[static_cast<std::size_t>(a)] |= place < 2 ? 1U << (a + stride) : 0U;
    }
  }
  return masks;
}();

constexpr int kMiddle = 13;

}  // namespace

SlideGrid::SlideGrid(const CellBox& box)
    : low_{box.low.x - 1, box.low.y - 1, box.low.z - 1},
      span_{box.high.x - box.low.x + 3, box.high.y - box.low.y + 3, box.high.z - box.low.z + 3} {
  const GridCell y = span_.x;
  const GridCell z = span_.x * span_.y;
  sides_ = {1, -1, y, -y, z, -z};
  std::size_t count = 0;
  for (std::size_t i = 0; i < kSideCount; ++i) {
    near_[count++] = sides_[i];
    for (std::size_t j = 0; j < i; ++j) {
      if (i / 2 != j / 2) {
        near_[count++] = sides_[i] + sides_[j];
      }
    }
  }
  what_.assign(base::at(z * span_.z), What::kBarred);
  is_inside_.assign(what_.size(), false);
  for (std::size_t i = 0; i < what_.size(); ++i) {
    if (box.contains(cell(static_cast<GridCell>(i)))) {
      what_[i] = What::kFree;
      is_inside_[i] = true;
    }
  }
}

Cell SlideGrid::cell(GridCell cell) const {
  return {low_.x + cell % sides_[2], low_.y + cell % sides_[4] / sides_[2],
          low_.z + cell / sides_[4]};
}

bool SlideGrid::may_part_air(GridCell cell) const {
  std::uint32_t free = 0;
  for (int i = 0; i < 27; ++i) {
    const GridCell near =
        cell + (i % 3 - 1) + (i / 3 % 3 - 1) * sides_[2] + (i / 9 - 1) * sides_[4];
    free |= i != kMiddle && is_free(near) ? 1U << i : 0U;
  }
  const std::uint32_t faces = free & kBeside[kMiddle];
  std::uint32_t reached = faces & -faces;
  for (std::uint32_t border = reached; border != 0;) {
    const auto next = static_cast<std::size_t>(std::countr_zero(border));
    border &= border - 1;
    const std::uint32_t more = kBeside[next] & free & ~reached;
    reached |= more;
    border |= more;
  }
  return (faces & ~reached) != 0;
}

}  // namespace holdfast::plan
