// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "search/robot_symmetry.hpp"

#include <algorithm>

namespace holdfast::plan {
namespace {

using base::Cell;

/// Whether nothing but the cells distinguishes one direction sideways from another.
bool is_plain(const model::RobotSpec& spec) {
  return spec.lattice == base::kCubic && spec.released.empty() && spec.obstacles.empty() &&
         !spec.gravity_m_s2 && spec.kinds.empty() && spec.own_kinds.empty() &&
         spec.own_masses.empty() && spec.own_connectors.empty() && spec.payloads.empty() &&
         spec.carried.empty();
}

/// Whether beams bend alike about both axes of their section, so that x and y are alike.
bool is_square(const model::Material& material) {
  return material.moment_x_mm4 == material.moment_y_mm4;
}

}  // namespace

Cell RobotSymmetry::Image::of(const Cell& cell) const {
  const std::int32_t along_x = is_swapped ? cell.y : cell.x;
  const std::int32_t along_y = is_swapped ? cell.x : cell.y;
  return {sign[0] * along_x + shift[0], sign[1] * along_y + shift[1], cell.z};
}

RobotSymmetry::RobotSymmetry(const model::RobotSpec& spec) {
  if (!is_plain(spec) || spec.existing.empty()) {
    return;
  }
  find_box(spec);
  // The box stays where it is: its ends are taken to its ends.
  const std::array<std::int32_t, 2> low = {low_.x, low_.y};
  const std::array<std::int32_t, 2> high = {high_.x, high_.y};
  const bool may_swap = high[0] - low[0] == high[1] - low[1] && is_square(spec.material);
  for (const bool is_swapped : {false, true}) {
    for (int mirrored = 0; mirrored < 4 && (may_swap || !is_swapped); ++mirrored) {
      Image image{.is_swapped = is_swapped};
      for (std::size_t axis = 0; axis < 2; ++axis) {
        const std::size_t from = is_swapped ? 1 - axis : axis;
        const bool is_mirrored = (mirrored >> axis & 1) != 0;
        image.sign[axis] = is_mirrored ? -1 : 1;
        image.shift[axis] = is_mirrored ? high[axis] + low[from] : low[axis] - low[from];
      }
      if (is_swapped || mirrored != 0) {
        add_if_symmetric(spec, image);
      }
    }
  }
}

void RobotSymmetry::find_box(const model::RobotSpec& spec) {
  low_ = high_ = spec.existing.front();
  for (const std::vector<Cell>* const cells : {&spec.existing, &spec.planned}) {
    for (const Cell& cell : *cells) {
      low_ = {std::min(low_.x, cell.x), std::min(low_.y, cell.y), std::min(low_.z, cell.z)};
      high_ = {std::max(high_.x, cell.x), std::max(high_.y, cell.y), std::max(high_.z, cell.z)};
    }
  }
}

void RobotSymmetry::add_if_symmetric(const model::RobotSpec& spec, const Image& image) {
  for (const std::vector<Cell>* const cells : {&spec.existing, &spec.planned, &spec.fixed}) {
    std::vector<Cell> all = *cells;
    std::ranges::sort(all);
    const auto is_there = [&](const Cell& cell) {
      return std::ranges::binary_search(all, image.of(cell));
    };
    if (!std::ranges::all_of(all, is_there)) {
      return;
    }
  }
  images_.push_back(image);
}

Cell RobotSymmetry::representative(const Cell& cell) const {
  const auto is_beside = [](std::int32_t low, std::int32_t at, std::int32_t high) {
    return low - 1 <= at && at <= high + 1;
  };
  if (images_.empty() || !is_beside(low_.x, cell.x, high_.x) ||
      !is_beside(low_.y, cell.y, high_.y) || !is_beside(low_.z, cell.z, high_.z)) {
    return cell;
  }
  Cell first = cell;
  for (const Image& image : images_) {
    first = std::min(first, image.of(cell));
  }
  return first;
}

}  // namespace holdfast::plan
