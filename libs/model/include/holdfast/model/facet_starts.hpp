// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include "holdfast/model/robot.hpp"

namespace holdfast::model {

/// The first facet of each module, as facets are ordered by modules: a module's are those from
/// [module] to [module + 1].
inline std::vector<std::size_t> facet_starts(const Robot& robot) {
  std::vector<std::size_t> starts(robot.modules().size() + 1);
  for (const Facet& facet : robot.facets()) {
    ++starts[base::at(facet.module) + 1];
  }
  for (std::size_t i = 0; i + 1 < starts.size(); ++i) {
    starts[i + 1] += starts[i];
  }
  return starts;
}

}  // namespace holdfast::model
