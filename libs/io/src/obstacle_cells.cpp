// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "obstacle_cells.hpp"

#include <algorithm>

#include "holdfast/model/cell_index.hpp"

namespace holdfast::io {

bool touches_floor(const model::Robot& robot, const model::Facet& facet) {
  const base::Cell& cell = robot.modules()[static_cast<std::size_t>(facet.module)].cell;
  return facet.direction == base::down(robot.lattice()) && robot.has_floor() &&
         cell.z == robot.support_z();
}

namespace {

constexpr std::int32_t kReachOfRobot = 1;  // Cells.
constexpr std::int32_t kReachOfTouch = 2;

struct CellBox {
  base::Cell low;
  base::Cell high;

  bool contains(const base::Cell& cell) const {
    return cell.x >= low.x && cell.x <= high.x && cell.y >= low.y && cell.y <= high.y &&
           cell.z >= low.z && cell.z <= high.z;
  }
};

CellBox widened(const CellBox& box, std::int32_t reach) {
  return {.low = {box.low.x - reach, box.low.y - reach, box.low.z - reach},
          .high = {box.high.x + reach, box.high.y + reach, box.high.z + reach}};
}

CellBox box_near(const model::Robot& robot) {
  CellBox box = {.low = robot.modules().front().cell, .high = robot.modules().front().cell};
  for (const model::Module& module : robot.modules()) {
    const base::Cell& cell = module.cell;
    box.low = {std::min(box.low.x, cell.x), std::min(box.low.y, cell.y),
               std::min(box.low.z, cell.z)};
    box.high = {std::max(box.high.x, cell.x), std::max(box.high.y, cell.y),
                std::max(box.high.z, cell.z)};
  }
  return widened(box, kReachOfRobot);
}

/// What two boxes share; `low` is above `high` somewhere if that is nothing.
CellBox shared(const CellBox& a, const CellBox& b) {
  return {
      .low = {std::max(a.low.x, b.low.x), std::max(a.low.y, b.low.y), std::max(a.low.z, b.low.z)},
      .high = {std::min(a.high.x, b.high.x), std::min(a.high.y, b.high.y),
               std::min(a.high.z, b.high.z)}};
}

/// Takes cells, each once, as long as they are not too many.
class Collector {
 public:
  void add(const base::Cell& cell, bool is_bonded) {
    if (near_.cells.size() == kObstacleCellsMax) {
      near_.are_too_many = true;
      return;
    }
    const auto index = static_cast<std::int32_t>(near_.cells.size());
    if (index_.insert(cell, index) == model::CellIndex::kNone) {
      near_.cells.push_back({.cell = cell, .is_bonded = is_bonded});
    }
  }

  void add(const CellBox& box, bool is_bonded) {
    for (std::int32_t z = box.low.z; z <= box.high.z && !near_.are_too_many; ++z) {
      for (std::int32_t y = box.low.y; y <= box.high.y && !near_.are_too_many; ++y) {
        for (std::int32_t x = box.low.x; x <= box.high.x && !near_.are_too_many; ++x) {
          add(base::Cell{x, y, z}, is_bonded);
        }
      }
    }
  }

  bool is_full() const { return near_.are_too_many; }

  NearObstacles take() {
    if (near_.are_too_many) {
      near_.cells.clear();
    }
    return std::move(near_);
  }

 private:
  NearObstacles near_;
  model::CellIndex index_{kObstacleCellsMax};
};

/// The obstacle cells that facets touch, not the floor.
std::vector<ObstacleCell> touched_cells(const model::Robot& robot) {
  std::vector<ObstacleCell> cells;
  for (const model::Facet& facet : robot.facets()) {
    if (!touches_floor(robot, facet)) {
      const base::Cell& cell = robot.modules()[static_cast<std::size_t>(facet.module)].cell;
      cells.push_back({.cell = base::neighbour(robot.lattice(), cell, facet.direction),
                       .is_bonded = facet.is_bonded()});
    }
  }
  return cells;
}

/// Calls `use` with the parts of an obstacle in a box.
template <class Use>
void for_parts(const model::Obstacle& obstacle, const CellBox& box, Use use) {
  if (obstacle.cells.empty()) {
    use(shared({.low = obstacle.from, .high = obstacle.to}, box));
  }
  for (const base::Cell& cell : obstacle.cells) {
    if (box.contains(cell)) {
      use(CellBox{.low = cell, .high = cell});
    }
  }
}

bool occupies(const model::Obstacle& obstacle, const base::Cell& cell) {
  return obstacle.cells.empty() ? CellBox{.low = obstacle.from, .high = obstacle.to}.contains(cell)
                                : std::ranges::find(obstacle.cells, cell) != obstacle.cells.end();
}

}  // namespace

NearObstacles obstacles_near(const model::Robot& robot,
                             std::span<const model::Obstacle> obstacles) {
  Collector collector;
  const std::vector<ObstacleCell> touched = touched_cells(robot);
  for (const ObstacleCell& one : touched) {
    collector.add(one.cell, one.is_bonded);
  }
  const CellBox near = box_near(robot);
  for (const model::Obstacle& obstacle : obstacles) {
    const auto add = [&](const CellBox& box) {
      collector.add(box, obstacle.touch.hold == model::Hold::kBonded);
    };
    bool is_touched = false;
    for (const ObstacleCell& one : touched) {
      if (occupies(obstacle, one.cell) && !collector.is_full()) {
        is_touched = true;
        for_parts(obstacle, widened({.low = one.cell, .high = one.cell}, kReachOfTouch), add);
      }
    }
    if (!is_touched) {
      for_parts(obstacle, near, add);
    }
  }
  return collector.take();
}

}  // namespace holdfast::io
