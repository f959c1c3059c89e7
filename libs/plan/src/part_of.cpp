// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "holdfast/plan/part_of.hpp"

#include <algorithm>

#include "holdfast/model/connected_parts.hpp"

namespace holdfast::plan {

model::RobotSpec part_of(const model::RobotSpec& spec, const ElementSet& modules) {
  model::RobotSpec part = spec;
  part.existing.clear();
  for (const Element element : modules.elements()) {
    part.existing.push_back(spec.existing[base::at(element)]);
  }
  forget_absent(part);
  return part;
}

std::vector<ElementSet> pieces_of(const model::Robot& target, const ElementSet& modules) {
  model::ConnectedParts parts(target.modules().size());
  for (const Element module : modules.elements()) {
    for (const std::int32_t other : target.connected()[base::at(module)]) {
      if (other > module && modules.contains(other)) {
        parts.join(module, other);
      }
    }
  }
  std::vector<ElementSet> pieces;
  for (const auto& list : parts.lists()) {
    if (modules.contains(list.front())) {
      ElementSet& piece = pieces.emplace_back(target.modules().size());
      std::ranges::for_each(list, [&](Element element) { piece.insert(element); });
    }
  }
  return pieces;
}

}  // namespace holdfast::plan
