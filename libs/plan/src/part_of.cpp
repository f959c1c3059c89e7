// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "part_of.hpp"

#include <algorithm>

namespace holdfast::plan {

model::RobotSpec part_of(const model::RobotSpec& spec, const ElementSet& modules) {
  model::RobotSpec part = spec;
  part.existing.clear();
  for (const Element element : modules.elements()) {
    part.existing.push_back(spec.existing[base::at(element)]);
  }
  if (spec.fixed.empty() && spec.released.empty() && spec.own_kinds.empty() &&
      spec.own_masses.empty() && spec.payloads.empty()) {
    return part;
  }
  std::vector<base::Cell> there = part.existing;
  std::ranges::sort(there);
  const auto is_absent = [&](const base::Cell& cell) {
    return !std::ranges::binary_search(there, cell);
  };
  std::erase_if(part.fixed, is_absent);
  std::erase_if(part.released, [&](const model::CellPair& pair) {
    return is_absent(pair[0]) || is_absent(pair[1]);
  });
  const auto is_of_absent = [&](const auto& own) { return is_absent(own.cell); };
  std::erase_if(part.own_kinds, is_of_absent);
  std::erase_if(part.own_masses, is_of_absent);
  std::erase_if(part.payloads, is_of_absent);
  return part;
}

}  // namespace holdfast::plan
