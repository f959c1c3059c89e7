// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "holdfast/plan/cell_box.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "holdfast/model/robot.hpp"

namespace holdfast::plan {

CellBox box_between(const base::Cell& a, const base::Cell& b) {
  return {.low = {std::min(a.x, b.x), std::min(a.y, b.y), std::min(a.z, b.z)},
          .high = {std::max(a.x, b.x), std::max(a.y, b.y), std::max(a.z, b.z)}};
}

base::Result<std::vector<base::Cell>> kept_modules(std::span<const CellBox> boxes,
                                                   std::span<const base::Cell> modules) {
  const std::set<base::Cell> all(modules.begin(), modules.end());
  std::set<base::Cell> kept;
  for (const CellBox& box : boxes) {
    if (box.low == box.high) {
      if (all.contains(box.low)) {
        kept.insert(box.low);
        continue;
      }
      return base::bad_input(
          fmt::format("the cell {} is to be kept, but no module is there", model::text(box.low)));
    }
    bool has_any = false;
    for (const base::Cell& cell : all) {
      if (box.contains(cell)) {
        kept.insert(cell);
        has_any = true;
      }
    }
    if (!has_any) {
      return base::bad_input(
          fmt::format("the box from {} to {} is to be kept, but no module is in "
                      "it",
                      model::text(box.low), model::text(box.high)));
    }
  }
  return std::vector<base::Cell>(kept.begin(), kept.end());
}

}  // namespace holdfast::plan
