// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "holdfast/model/environment.hpp"

#include <algorithm>
#include <numeric>

namespace holdfast::model {
namespace {

bool is_inside(const base::Cell& cell, const Obstacle& box) {
  return box.from.x <= cell.x && cell.x <= box.to.x && box.from.y <= cell.y && cell.y <= box.to.y &&
         box.from.z <= cell.z && cell.z <= box.to.z;
}

std::size_t listed_count(const std::vector<Obstacle>& obstacles) {
  return std::accumulate(
      obstacles.begin(), obstacles.end(), std::size_t{0},
      [](std::size_t sum, const Obstacle& obstacle) { return sum + obstacle.cells.size(); });
}

}  // namespace

ObstacleIndex::ObstacleIndex(const std::vector<Obstacle>& obstacles)
    : obstacles_(obstacles), listed_(listed_count(obstacles)) {
  for (std::size_t i = 0; i < obstacles.size(); ++i) {
    const auto index = static_cast<std::int32_t>(i);
    if (obstacles[i].cells.empty()) {
      boxes_.push_back(index);
    }
    for (const base::Cell& cell : obstacles[i].cells) {
      listed_.insert(cell, index);
    }
  }
}

std::int32_t ObstacleIndex::find(const base::Cell& cell) const {
  const auto box = std::ranges::find_if(boxes_, [&](std::int32_t index) {
    return is_inside(cell, obstacles_[static_cast<std::size_t>(index)]);
  });
  const std::int32_t listed = listed_.find(cell);
  if (box == boxes_.end() || (listed != CellIndex::kNone && listed < *box)) {
    return listed;
  }
  return *box;
}

}  // namespace holdfast::model
