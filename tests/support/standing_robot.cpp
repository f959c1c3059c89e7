// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "standing_robot.hpp"

#include <algorithm>
#include <set>
#include <utility>

#include "holdfast/base/rng.hpp"

namespace holdfast::test {
namespace {

using base::Cell;

class Builder {
 public:
  explicit Builder(std::uint64_t seed) : rng_(seed), room_(129 + rng_.below(272)) {}

  model::RobotSpec build() {
    switch (number(6)) {
      case 0:
        tower_on_neck();
        break;
      case 1:
        deck_on_legs();
        break;
      case 2:
      case 3:
        plate(3, 3, 1);
        grow(number(2) * 80);
        break;
      case 4:
        table();
        break;
      default:
        towers_on_plate();
    }
    model::RobotSpec spec;
    spec.existing = cells_;
    room_ += rng_.below(10);
    grow(0);
    spec.planned.assign(cells_.begin() + static_cast<std::ptrdiff_t>(spec.existing.size()),
                        cells_.end());
    return spec;
  }

 private:
  std::int32_t number(std::uint64_t bound) { return static_cast<std::int32_t>(rng_.below(bound)); }

  void put(const Cell& cell) {
    const bool touches =
        cells_.empty() || std::ranges::any_of(base::kDirections, [&](base::Direction direction) {
          return taken_.contains(base::neighbour(cell, direction));
        });
    if (touches && cell.z >= 0 && cells_.size() < room_ && taken_.insert(cell).second) {
      cells_.push_back(cell);
    }
  }

  void box(const Cell& corner, const Cell& size) {
    for (std::int32_t z = 0; z < size.z; ++z) {
      for (std::int32_t y = 0; y < size.y; ++y) {
        for (std::int32_t x = 0; x < size.x; ++x) {
          put({corner.x + x, corner.y + y, corner.z + z});
        }
      }
    }
  }

  /// A box of random size on the ground; returns its size.
  Cell plate(std::uint64_t width_max, std::uint64_t depth_max, std::uint64_t height_max) {
    Cell size;
    size.x = 1 + number(width_max);
    size.y = 1 + number(depth_max);
    size.z = 1 + number(height_max);
    box({0, 0, 0}, size);
    return size;
  }

  void leg(Cell top) {
    while (--top.z >= 0) {
      put(top);
    }
  }

  /// Fills the room; `tallness` percent of the new modules go near the last ones. Few of those
  /// that would stand on the ground are let.
  void grow(std::int32_t tallness) {
    constexpr int kAttemptMax = 200000;
    for (int attempt = 0; cells_.size() < room_ && attempt < kAttemptMax; ++attempt) {
      const bool is_near = number(100) < tallness;
      const std::size_t reach = is_near ? std::min<std::size_t>(cells_.size(), 6) : cells_.size();
      const Cell& from = cells_[cells_.size() - 1 - rng_.below(reach)];
      const Cell cell = base::neighbour(from, base::kDirections[rng_.below(6)]);
      if (cell.z > 0 || number(5) == 0) {
        put(cell);
      }
    }
  }

  void tower_on_neck() {
    const Cell base = plate(4, 4, 2);
    Cell corner;
    corner.x = number(static_cast<std::uint64_t>(base.x));
    corner.y = number(static_cast<std::uint64_t>(base.y));
    corner.z = base.z;
    const std::int32_t neck = number(4);
    box(corner, {1, 1, neck});
    const std::int32_t width = 1 + number(3);
    corner.x -= number(static_cast<std::uint64_t>(width));
    corner.y -= number(static_cast<std::uint64_t>(width));
    corner.z += neck;
    box(corner, {width, width, 4 + number(60)});
    grow(number(100));
  }

  void deck_on_legs() {
    const std::int32_t height = 1 + number(4);
    box({0, 0, 0}, {1, 1, height + 1});
    Cell cell{0, 0, height};
    for (std::int32_t beam = 2 + number(5); beam > 0; --beam) {
      const base::Direction direction = base::kDirections[rng_.below(4)];
      for (std::int32_t i = 2 + number(6); i > 0; --i) {
        cell = base::neighbour(cell, direction);
        put(cell);
      }
      if (number(3) != 0) {
        leg(cell);
      }
    }
    grow(number(90));
  }

  void table() {
    Cell far;
    far.x = 1 + number(7);
    far.y = 1 + number(7);
    const std::int32_t height = 1 + number(5);
    box({0, 0, 0}, {1, 1, height + 1});
    box({0, 0, height}, {far.x + 1, far.y + 1, 1});
    for (const Cell& top :
         {Cell{far.x, 0, height}, Cell{0, far.y, height}, Cell{far.x, far.y, height}}) {
      if (number(5) != 0) {
        leg(top);
      }
    }
    grow(number(60));
  }

  void towers_on_plate() {
    const Cell base = plate(4, 4, 3);
    std::int32_t height = base.z;
    for (int tower = 0; tower < 2; ++tower) {
      Cell corner;
      corner.x = number(static_cast<std::uint64_t>(base.x));
      corner.y = number(static_cast<std::uint64_t>(base.y));
      corner.z = height;
      const std::int32_t width = 1 + number(2);
      box(corner, {width, width, 5 + number(40)});
      height = cells_.back().z + 1;
    }
    grow(50 + number(50));
  }

  base::Rng rng_;
  std::size_t room_;
  std::vector<Cell> cells_;
  std::set<Cell> taken_;
};

void shuffle(std::vector<Cell>& cells, base::Rng& rng) {
  for (std::size_t i = cells.size(); i > 1; --i) {
    std::swap(cells[i - 1], cells[rng.below(i)]);
  }
}

}  // namespace

model::RobotSpec standing_robot(std::uint64_t seed) { return Builder(seed).build(); }

Cell turned(Cell cell, int turn) {
  if (turn >= kTurnCount / 2) {
    cell.x = -cell.x;
  }
  for (int quarter = turn % (kTurnCount / 2); quarter > 0; --quarter) {
    cell = {-cell.y, cell.x, cell.z};
  }
  return cell;
}

model::RobotSpec turned(model::RobotSpec spec, int turn, std::uint64_t order) {
  base::Rng rng(order);
  for (std::vector<Cell>* cells : {&spec.existing, &spec.planned, &spec.fixed}) {
    std::ranges::for_each(*cells, [&](Cell& cell) { cell = turned(cell, turn); });
    if (order != 0) {
      shuffle(*cells, rng);
    }
  }
  return spec;
}

}  // namespace holdfast::test
