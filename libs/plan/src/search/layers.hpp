// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <compare>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "holdfast/model/robot.hpp"

namespace holdfast::plan {

/// Where a module comes in the order in which a robot grows best: in layers about some modules.
/// Those of a layer come outwards from its middle and from all sides in turns, so that the weights
/// of any that follow each other have little moment about it: an uneven robot carries more.
/// Finds how many steps through connections each module is from the nearest of `sources`; more than
/// there are modules where none leads there.
std::vector<std::int64_t> distances_from(const model::Robot& robot,
                                         std::vector<std::size_t> sources);

struct LayerPlace {
  std::int64_t layer = 0;  ///< Steps from the nearest source, through connections.
  std::int64_t in_layer = 0;

  auto operator<=>(const LayerPlace&) const = default;
};

/// The places by module. Modules that are connected with no source are the last layer.
std::vector<LayerPlace> places_in_layers(const model::Robot& robot,
                                         std::vector<std::size_t> sources);

}  // namespace holdfast::plan
