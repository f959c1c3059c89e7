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

/// The intersection of two boxes; `low` is above `high` somewhere if it is empty.
CellBox shared(const CellBox& a, const CellBox& b) {
  return {
      .low = {std::max(a.low.x, b.low.x), std::max(a.low.y, b.low.y), std::max(a.low.z, b.low.z)},
      .high = {std::min(a.high.x, b.high.x), std::min(a.high.y, b.high.y),
               std::min(a.high.z, b.high.z)}};
}

/// Calls `use` with every cell of a box until that returns false.
template <class Use>
void for_cells(const CellBox& box, Use use) {
  for (std::int32_t z = box.low.z; z <= box.high.z; ++z) {
    for (std::int32_t y = box.low.y; y <= box.high.y; ++y) {
      for (std::int32_t x = box.low.x; x <= box.high.x; ++x) {
        if (!use(base::Cell{x, y, z})) {
          return;
        }
      }
    }
  }
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

/// The cells that an obstacle occupies.
class Occupied {
 public:
  explicit Occupied(const model::Obstacle& obstacle)
      : box_{.low = obstacle.from, .high = obstacle.to}, cells_(obstacle.cells.size()) {
    for (const base::Cell& cell : obstacle.cells) {
      cells_.insert(cell, 0);
    }
    is_list_ = !obstacle.cells.empty();
  }

  bool contains(const base::Cell& cell) const {
    return is_list_ ? cells_.find(cell) != model::CellIndex::kNone : box_.contains(cell);
  }

  /// Adds what of it lies in a box.
  void add_to(Collector& collector, const CellBox& box, bool is_bonded) const {
    const CellBox& part = is_list_ ? box : shared(box, box_);
    for_cells(part, [&](const base::Cell& cell) {
      if (contains(cell)) {
        collector.add(cell, is_bonded);
      }
      return !collector.is_full();
    });
  }

 private:
  CellBox box_;
  model::CellIndex cells_;
  bool is_list_ = false;
};

/// Adds an obstacle that nothing touches: of a box its part, of a list the cells near the robot.
void add_untouched(const model::Obstacle& obstacle, const Occupied& occupied, const CellBox& near,
                   bool is_bonded, Collector& collector) {
  if (obstacle.cells.empty()) {
    occupied.add_to(collector, near, is_bonded);
  }
  for (const base::Cell& cell : obstacle.cells) {
    if (near.contains(cell)) {
      collector.add(cell, is_bonded);
    }
  }
}

}  // namespace

NearObstacles obstacles_near(const model::Robot& robot,
                             std::span<const model::Obstacle> obstacles) {
  const std::vector<ObstacleCell> touched = touched_cells(robot);
  if (obstacles.empty() && touched.empty()) {
    return {};
  }
  Collector collector;
  for (const ObstacleCell& one : touched) {
    collector.add(one.cell, one.is_bonded);
  }
  const CellBox near = box_near(robot);
  for (const model::Obstacle& obstacle : obstacles) {
    const bool is_bonded = obstacle.touch.hold == model::Hold::kBonded;
    const Occupied occupied(obstacle);
    bool is_touched = false;
    for (const ObstacleCell& one : touched) {
      if (occupied.contains(one.cell)) {
        is_touched = true;
        const CellBox around = widened({.low = one.cell, .high = one.cell}, kReachOfTouch);
        occupied.add_to(collector, around, is_bonded);
      }
    }
    if (!is_touched) {
      add_untouched(obstacle, occupied, near, is_bonded, collector);
    }
  }
  return collector.take();
}

}  // namespace holdfast::io
