// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "equilibria/solved_core.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace holdfast::plan {

using base::Vec6;
using solver::kLaneCount;

bool SolvedCore::find_columns(std::span<const std::size_t> modules, std::size_t memory_bytes_max) {
  std::vector<std::size_t> missing;
  std::ranges::copy_if(modules, std::back_inserter(missing),
                       [&](std::size_t module) { return !has_column(module); });
  std::ranges::sort(missing);
  missing.erase(std::unique(missing.begin(), missing.end()), missing.end());
  if ((column_count_ + missing.size()) * columns_.size() > memory_bytes_max / sizeof(Mat)) {
    return false;
  }
  column_count_ += missing.size();
  for (const std::size_t module : missing) {
    columns_[module].resize(columns_.size());
  }
  std::vector<solver::LaneBlock> lanes;
  for (std::size_t first = 0; first < 6 * missing.size(); first += kLaneCount) {
    lanes.assign(influence_.slot_count(), {});
    const std::size_t lane_count = std::min(kLaneCount, 6 * missing.size() - first);
    for (std::size_t lane = 0; lane < lane_count; ++lane) {
      const std::size_t load = first + lane;
      lanes[influence_.slot(missing[load / 6])].values[load % 6][lane] = 1;
    }
    influence_.solve(lanes);
    for (std::size_t module = 0; module < columns_.size(); ++module) {
      const solver::LaneBlock& block = lanes[influence_.slot(module)];
      for (std::size_t lane = 0; lane < lane_count; ++lane) {
        const std::size_t load = first + lane;
        for (std::size_t k = 0; k < 6; ++k) {
          columns_[missing[load / 6]][module].values[6 * (load % 6) + k] = block.values[k][lane];
        }
      }
    }
  }
  return true;
}

/// Goes by reciprocity where only the module that moves has a column.
Vec6<double> SolvedCore::answer(std::size_t module, const PointLoad& load) const {
  if (has_column(load.module)) {
    return base::multiply(columns_[load.module][module], load.load);
  }
  if (!has_column(module)) {
    return base::multiply(influence_.between(module, load.module), load.load);
  }
  const Mat& turned = columns_[module][load.module];
  Vec6<double> u{};
  for (std::size_t k = 0; k < 6; ++k) {
    for (std::size_t i = 0; i < 6; ++i) {
      u[k] += turned.values[6 * k + i] * load.load[i];
    }
  }
  return u;
}

double rounding_share(const model::Robot& robot, const solver::Influence& influence) {
  double largest = 1;
  double change = 0;
  for (const model::Connection& pair : robot.connections()) {
    const auto ratio = [&](const std::vector<Vec6<double>>& u) {
      const Vec6<double> force =
          influence.beam().middle_force(pair.direction, u[base::at(pair.a)], u[base::at(pair.b)]);
      return model::load_ratio(robot.connector(pair), force).ratio;
    };
    const double fine = ratio(influence.displacement());
    const double rough = ratio(influence.rough_displacement());
    if (std::isnan(fine) || std::isnan(rough)) {
      return std::numeric_limits<double>::quiet_NaN();
    }
    largest = std::max(largest, std::abs(fine));
    change = std::max(change, std::abs(fine - rough));
  }
  return change / largest;
}

}  // namespace holdfast::plan
