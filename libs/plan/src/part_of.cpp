// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "part_of.hpp"

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

}  // namespace holdfast::plan
