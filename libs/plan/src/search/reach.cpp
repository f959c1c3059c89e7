// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "holdfast/plan/reach.hpp"

#include <algorithm>
#include <set>
#include <utility>

#include "barring_floor.hpp"
#include "holdfast/base/lattice.hpp"

namespace holdfast::plan {
namespace {

using base::Cell;

Cell low_of(const Cell& a, const Cell& b) {
  return {std::min(a.x, b.x), std::min(a.y, b.y), std::min(a.z, b.z)};
}

Cell high_of(const Cell& a, const Cell& b) {
  return {std::max(a.x, b.x), std::max(a.y, b.y), std::max(a.z, b.z)};
}

/// All that bars ways but the floor.
std::vector<model::Obstacle> what_bars(const model::RobotSpec& target, const ReachRule& rule) {
  std::vector<model::Obstacle> obstacles = target.obstacles;
  if (!rule.avoid.empty()) {
    obstacles.push_back({.from = {}, .to = {}, .cells = rule.avoid});
  }
  return obstacles;
}

}  // namespace

const char* name(Reach reach) {
  switch (reach) {
    case Reach::kLine:
      return "line";
    case Reach::kSurface:
      return "surface";
    case Reach::kFree:
      break;
  }
  return "free";
}

ReachFinder::ReachFinder(const model::RobotSpec& target, ReachRule rule)
    : lattice_(target.lattice),
      floor_z_(barring_floor(target.support_z, target.existing)),
      obstacles_(what_bars(target, rule)),
      obstacle_index_(obstacles_),
      modules_(target.existing.size()),
      low_(target.existing.front()),
      high_(low_),
      rule_(std::move(rule)) {
  for (std::size_t i = 0; i < target.existing.size(); ++i) {
    modules_.insert(target.existing[i], static_cast<std::int32_t>(i));
    low_ = low_of(low_, target.existing[i]);
    high_ = high_of(high_, target.existing[i]);
  }
  for (const model::Obstacle& obstacle : obstacles_) {
    const std::vector<Cell> box = {obstacle.from, obstacle.to};
    for (const Cell& cell : obstacle.cells.empty() ? box : obstacle.cells) {
      low_ = low_of(low_, cell);
      high_ = high_of(high_, cell);
    }
  }
}

bool ReachFinder::is_module(const ElementSet& state, const Cell& cell) const {
  const std::int32_t found = modules_.find(cell);
  return found != model::CellIndex::kNone && state.contains(found);
}

bool ReachFinder::has_room(const Cell& cell) const {
  return (!floor_z_ || cell.z >= *floor_z_) &&
         (obstacles_.empty() || obstacle_index_.find(cell) == model::CellIndex::kNone);
}

bool ReachFinder::is_free(const ElementSet& state, const Cell& cell) const {
  return !is_module(state, cell) && has_room(cell);
}

bool ReachFinder::is_beside(const ElementSet& state, const Cell& cell) const {
  for (const base::Direction direction : base::directions(lattice_)) {
    if (is_module(state, base::neighbour(lattice_, cell, direction))) {
      return true;
    }
  }
  return false;
}

bool ReachFinder::is_far(const Cell& cell) const {
  return cell.x < low_.x || cell.y < low_.y || cell.z < low_.z || cell.x > high_.x ||
         cell.y > high_.y || cell.z > high_.z;
}

bool ReachFinder::has_line(const ElementSet& state, const Cell& cell) const {
  for (const base::Direction direction : base::directions(lattice_)) {
    Cell next = base::neighbour(lattice_, cell, direction);
    while (is_free(state, next) && !is_far(next)) {
      next = base::neighbour(lattice_, next, direction);
    }
    // Lines that sink reach the floor somewhere.
    const bool sinks = lattice_.steps[base::at(base::index(direction))].z < 0 && floor_z_;
    if (is_free(state, next) && !sinks) {
      return true;
    }
  }
  return false;
}

void ReachFinder::for_each_move(const ElementSet& carrying, const ElementSet& barring,
                                const Cell& cell,
                                const std::function<void(const Cell&)>& take) const {
  for (const base::Direction side : base::directions(lattice_)) {
    const Cell carrier = base::neighbour(lattice_, cell, side);
    if (!is_module(carrying, carrier)) {
      continue;
    }
    for (const base::Direction way : base::directions(lattice_)) {
      const Cell next = base::neighbour(lattice_, cell, way);
      if (!is_free(carrying, next)) {
        continue;
      }
      bool is_carried = is_module(carrying, base::neighbour(lattice_, carrier, way));
      for (const base::Direction beside : base::directions(lattice_)) {
        const Cell turned = base::neighbour(lattice_, next, beside);
        is_carried = is_carried || turned == carrier;
        for (const base::Direction back : base::directions(lattice_)) {
          if (turned != cell && base::neighbour(lattice_, turned, back) == carrier &&
              is_free(barring, next) && is_free(carrying, turned)) {
            take(turned);
          }
        }
      }
      if (is_carried) {
        take(next);
      }
    }
  }
}

/// The cells that modules can get to, carried by some modules and barred by more: those of the
/// latter alone may be entered, and are not gone on from.
std::vector<Cell> ReachFinder::surface(const ElementSet& carrying,
                                       const ElementSet& barring) const {
  std::vector<Cell> reached;
  if (!rule_.source || !is_free(carrying, *rule_.source) || !is_beside(carrying, *rule_.source)) {
    return reached;
  }
  std::set<Cell> seen = {*rule_.source};
  reached.push_back(*rule_.source);
  for (std::size_t i = 0; i < reached.size(); ++i) {
    const Cell cell = reached[i];
    if (!is_free(barring, cell)) {
      continue;
    }
    for_each_move(carrying, barring, cell, [&](const Cell& next) {
      if (seen.insert(next).second) {
        reached.push_back(next);
      }
    });
  }
  std::ranges::sort(reached);
  return reached;
}

bool ReachFinder::can_reach(const ElementSet& state, const Cell& cell) const {
  return can_reach_each(state, {cell}).front();
}

std::vector<bool> ReachFinder::can_reach_each(const ElementSet& state,
                                              const std::vector<Cell>& cells) const {
  std::vector<bool> can(cells.size(), true);
  if (rule_.reach == Reach::kFree || state.size() == 0) {
    return can;
  }
  const std::vector<Cell> reached =
      rule_.reach == Reach::kSurface ? surface(state, state) : std::vector<Cell>{};
  for (std::size_t i = 0; i < cells.size(); ++i) {
    can[i] = rule_.reach == Reach::kSurface ? std::ranges::binary_search(reached, cells[i])
                                            : has_line(state, cells[i]);
  }
  return can;
}

bool ReachFinder::can_reach_in_any_order(const ElementSet& state,
                                         const std::vector<Cell>& cells) const {
  if (rule_.reach == Reach::kFree || cells.size() < 2) {
    return rule_.reach == Reach::kFree || cells.empty() || can_reach(state, cells.front());
  }
  ElementSet all = state;
  std::ranges::for_each(cells, [&](const Cell& cell) { all.insert(modules_.find(cell)); });
  if (rule_.reach == Reach::kSurface) {
    const std::vector<Cell> reached = surface(state, all);
    return std::ranges::all_of(
        cells, [&](const Cell& cell) { return std::ranges::binary_search(reached, cell); });
  }
  return std::ranges::all_of(cells, [&](const Cell& cell) {
    ElementSet others = all;
    others.erase(modules_.find(cell));
    return has_line(others, cell);
  });
}

}  // namespace holdfast::plan
