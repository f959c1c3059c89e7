// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "equilibria/influence_core.hpp"

#include <algorithm>

namespace holdfast::plan {

using base::at;
using base::Vec6;
using solver::kLaneCount;

bool InfluenceCore::find_columns(std::size_t memory_bytes_max) {
  const std::size_t module_count = influence_.displacement().size();
  place_.assign(module_count, kNone);
  for (const solver::FacetState& facet : influence_.facets()) {
    if (place_[facet.module] == kNone) {
      place_[facet.module] = static_cast<std::int32_t>(modules_.size());
      modules_.push_back(facet.module);
    }
  }
  if (modules_.size() * module_count > memory_bytes_max / sizeof(Mat)) {
    return false;
  }
  columns_.resize(modules_.size() * module_count);
  const std::size_t count = 6 * modules_.size();
  std::vector<solver::LaneBlock> lanes;
  for (std::size_t first = 0; first < count; first += kLaneCount) {
    lanes.assign(influence_.slot_count(), {});
    const std::size_t lane_count = std::min(kLaneCount, count - first);
    for (std::size_t lane = 0; lane < lane_count; ++lane) {
      const std::size_t load = first + lane;
      lanes[influence_.slot(modules_[load / 6])].values[load % 6][lane] = 1;
    }
    influence_.solve(lanes);
    for (std::size_t module = 0; module < module_count; ++module) {
      const solver::LaneBlock& block = lanes[influence_.slot(module)];
      for (std::size_t lane = 0; lane < lane_count; ++lane) {
        const std::size_t load = first + lane;
        for (std::size_t k = 0; k < 6; ++k) {
          columns_[module * modules_.size() + load / 6].values[6 * (load % 6) + k] =
              block.values[k][lane];
        }
      }
    }
  }
  return true;
}

/// By reciprocity where only the module that moves has a facet.
Vec6<double> InfluenceCore::answer(std::size_t module, const PointLoad& load) const {
  if (columns_.empty() || (place_[load.module] == kNone && place_[module] == kNone)) {
    return base::multiply(influence_.between(module, load.module), load.load);
  }
  if (place_[load.module] != kNone) {
    return base::multiply(column(module, place_[load.module]), load.load);
  }
  const Mat& turned = column(load.module, place_[module]);
  Vec6<double> u{};
  for (std::size_t k = 0; k < 6; ++k) {
    for (std::size_t i = 0; i < 6; ++i) {
      u[k] += turned.values[6 * k + i] * load.load[i];
    }
  }
  return u;
}

}  // namespace holdfast::plan
