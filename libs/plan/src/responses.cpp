// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "responses.hpp"

#include <algorithm>

namespace holdfast::plan {

using solver::kLaneCount;
using solver::LaneBlock;

Responses::Responses(const solver::Influence& influence,
                     std::span<const std::vector<PointLoad>> quantities)
    : module_count_(influence.displacement().size()),
      columns_(quantities.size() * influence.displacement().size()) {
  std::vector<LaneBlock> lanes;
  for (std::size_t first = 0; first < quantities.size(); first += kLaneCount) {
    lanes.assign(influence.slot_count(), {});
    const std::size_t count = std::min(kLaneCount, quantities.size() - first);
    for (std::size_t lane = 0; lane < count; ++lane) {
      for (const PointLoad& part : quantities[first + lane]) {
        for (std::size_t k = 0; k < 6; ++k) {
          lanes[influence.slot(part.module)].values[k][lane] = part.load[k];
        }
      }
    }
    influence.solve(lanes);
    for (std::size_t module = 0; module < module_count_; ++module) {
      const LaneBlock& block = lanes[influence.slot(module)];
      for (std::size_t lane = 0; lane < count; ++lane) {
        for (std::size_t k = 0; k < 6; ++k) {
          columns_[(first + lane) * module_count_ + module][k] = block.values[k][lane];
        }
      }
    }
  }
}

}  // namespace holdfast::plan
