// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "part_of.hpp"

#include <algorithm>

namespace holdfast::plan {

void forget_absent(model::RobotSpec& spec) {
  if (spec.fixed.empty() && spec.released.empty() && spec.own_kinds.empty() &&
      spec.own_masses.empty() && spec.payloads.empty()) {
    return;
  }
  std::vector<base::Cell> there = spec.existing;
  there.insert(there.end(), spec.planned.begin(), spec.planned.end());
  std::ranges::sort(there);
  const auto is_absent = [&](const base::Cell& cell) {
    return !std::ranges::binary_search(there, cell);
  };
  std::erase_if(spec.fixed, is_absent);
  std::erase_if(spec.released, [&](const model::CellPair& pair) {
    return is_absent(pair[0]) || is_absent(pair[1]);
  });
  const auto is_of_absent = [&](const auto& own) { return is_absent(own.cell); };
  std::erase_if(spec.own_kinds, is_of_absent);
  std::erase_if(spec.own_masses, is_of_absent);
  std::erase_if(spec.payloads, is_of_absent);
}

model::RobotSpec part_of(const model::RobotSpec& spec, const ElementSet& modules) {
  model::RobotSpec part = spec;
  part.existing.clear();
  for (const Element element : modules.elements()) {
    part.existing.push_back(spec.existing[base::at(element)]);
  }
  forget_absent(part);
  return part;
}

}  // namespace holdfast::plan
