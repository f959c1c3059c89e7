// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "random_robot.hpp"

#include <algorithm>
#include <set>

#include "holdfast/base/rng.hpp"

namespace holdfast::test {
namespace {

using base::Cell;

class Builder {
 public:
  /// Builds a robot of `count_min` to `count_max` modules.
  Builder(std::uint64_t seed, std::size_t count_min, std::size_t count_max)
      : rng_(seed), count_max_(count_min + rng_.below(count_max - count_min + 1)) {}

  model::RobotSpec build(std::uint64_t kind) {
    put({0, 0, 0});
    if (kind >= kSlenderKind) {
      plate();
    }
    while (cells_.size() < count_max_) {
      switch (kind) {
        case kSlenderKind:
          spiral();
          break;
        case kSlenderKind + 1:
          ladder();
          break;
        case 0:
          grow(count_max_);
          break;
        case 1:
          wall();
          break;
        case 2:
          beam();
          break;
        default:
          feet();
      }
    }
    model::RobotSpec spec;
    spec.existing = cells_;
    const std::uint64_t planned = rng_.below(5);
    grow(cells_.size() + planned);
    spec.planned.assign(cells_.begin() + static_cast<std::ptrdiff_t>(spec.existing.size()),
                        cells_.end());
    return spec;
  }

 private:
  std::int32_t number(std::uint64_t bound) { return static_cast<std::int32_t>(rng_.below(bound)); }

  Cell any() { return cells_[rng_.below(cells_.size())]; }

  bool has_neighbour(const Cell& cell) const {
    return cells_.empty() || std::ranges::any_of(base::kDirections, [&](base::Direction direction) {
             return taken_.contains(base::neighbour(cell, direction));
           });
  }

  /// Adds a free cell above the ground that touches the robot, while there is room.
  void put(const Cell& cell) {
    if (cell.z >= 0 && cells_.size() < room_ && has_neighbour(cell) && taken_.insert(cell).second) {
      cells_.push_back(cell);
    }
  }

  void grow(std::size_t count) {
    room_ = count;
    while (cells_.size() < count) {
      // One draw a statement: compilers differ in the order of arguments.
      const base::Direction direction = base::kDirections[rng_.below(6)];
      put(base::neighbour(any(), direction));
    }
    room_ = count_max_;
  }

  /// A vertical plane, one module thick; one cell in five is left out as a door or window.
  void wall() {
    const Cell corner = any();
    const bool along_x = rng_.below(2) == 0;
    const std::int32_t width = 2 + number(6);
    const std::int32_t height = 1 + number(5);
    for (std::int32_t z = corner.z; z < corner.z + height; ++z) {
      for (std::int32_t i = 0; i < width; ++i) {
        if (rng_.below(5) != 0) {
          put(along_x ? Cell{corner.x + i, corner.y, z} : Cell{corner.x, corner.y + i, z});
        }
      }
    }
  }

  /// A straight row in any direction from a random module.
  void beam() {
    Cell cell = any();
    const base::Direction direction = base::kDirections[rng_.below(6)];
    for (std::int32_t i = 1 + number(7); i > 0; --i) {
      cell = base::neighbour(cell, direction);
      put(cell);
    }
  }

  /// A deck some cells up, with legs that reach the ground here and there.
  void feet() {
    const Cell start = any();
    const std::int32_t height = start.z + 1 + number(3);
    for (std::int32_t z = start.z; z <= height; ++z) {
      put({start.x, start.y, z});
    }
    const bool along_x = rng_.below(2) == 0;
    for (std::int32_t i = 1; i < 2 + number(8); ++i) {
      const Cell deck =
          along_x ? Cell{start.x + i, start.y, height} : Cell{start.x, start.y + i, height};
      put(deck);
      const std::int32_t leg = rng_.below(3) == 0 ? height : 0;
      for (std::int32_t down = 1; down <= leg; ++down) {
        put({deck.x, deck.y, height - down});
      }
    }
  }

  /// A foot of 3 x 3 around the first module.
  void plate() {
    for (const base::Cell& cell : {Cell{1, 0, 0},
                                   {-1, 0, 0},
                                   {0, 1, 0},
                                   {0, -1, 0},
                                   {1, 1, 0},
                                   {1, -1, 0},
                                   {-1, 1, 0},
                                   {-1, -1, 0}}) {
      put(cell);
    }
  }

  /// One module thick, round a square shaft and up in steps, until there is no more room.
  void spiral() {
    const std::int32_t width = 1 + number(3);
    Cell cell = {0, 0, 0};
    for (std::uint64_t turn = 0; cells_.size() < room_; turn = (turn + 1) % 4) {
      for (std::int32_t i = 1 + number(4); i > 0; --i) {
        put(cell = base::neighbour(cell, base::Direction::kPlusZ));
      }
      constexpr base::Direction kAround[] = {base::Direction::kPlusX, base::Direction::kPlusY,
                                             base::Direction::kMinusX, base::Direction::kMinusY};
      for (std::int32_t i = 0; i < width; ++i) {
        put(cell = base::neighbour(cell, kAround[turn]));
      }
    }
  }

  /// Adds two posts with rungs and here and there a spike, until there is no more room.
  void ladder() {
    const std::int32_t step = 1 + number(8);
    for (std::int32_t z = 1; cells_.size() < room_; ++z) {
      put({0, 0, z});
      if (z == 1) {
        put({1, 0, z});
      }
      put({2, 0, z});
      if (z % step == 0) {
        put({1, 0, z});
      }
      if (number(20) == 0) {
        put({number(2) == 0 ? -1 : 3, 0, z});
      }
    }
  }

  static constexpr std::uint64_t kSlenderKind = 4;

  base::Rng rng_;
  std::size_t count_max_;
  std::size_t room_ = count_max_;
  std::vector<Cell> cells_;
  std::set<Cell> taken_;
};

}  // namespace

model::RobotSpec random_robot(std::uint64_t seed) { return Builder(seed, 3, 60).build(seed % 4); }

model::RobotSpec random_robot(std::uint64_t seed, std::size_t count_min, std::size_t count_max) {
  model::RobotSpec spec = Builder(seed, count_min, count_max).build(seed % 6);
  if (seed % 5 == 0) {
    spec.fixed = {spec.existing.front()};
  }
  return spec;
}

}  // namespace holdfast::test
