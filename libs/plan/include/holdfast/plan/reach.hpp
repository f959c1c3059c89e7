// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "holdfast/base/cell.hpp"
#include "holdfast/model/robot.hpp"
#include "holdfast/plan/element_set.hpp"

/// Can a module get to the cell where it is to be attached?
namespace holdfast::plan {

enum class Reach : std::uint8_t {
  kFree,     ///< Any cell.
  kLine,     ///< A straight way in along a direction of the lattice, all cells of which are free.
  kSurface,  ///< Along the surface of the robot from a source.
};

/// "free", "line", "surface".
const char* name(Reach reach);

/// How modules get to their cells.
struct ReachRule {
  Reach reach = Reach::kFree;
  /// The cell that modules come from; kSurface only.
  std::optional<base::Cell> source = {};
  /// Cells that bar ways as obstacles do, and carry nothing; not for kFree, which has no ways.
  std::vector<base::Cell> avoid = {};
};

/// Finds out which cells a module can get to while some modules of a target are there.
///
/// Along the surface a module goes from cell to cell, each of them free and beside a module that is
/// there: to a neighbouring cell if it stays beside the same module, or if the module beside it has
/// a neighbour in the same direction (a slide); or about one module to another cell beside it if a
/// free cell lies between both (a convex turn). Floor, obstacles and cells to be avoided bar the
/// way and carry nobody; a floor below which the target has a module is taken to end beside the
/// robot, and bars nothing.
class ReachFinder {
 public:
  /// Keeps no reference.
  ReachFinder(const model::RobotSpec& target, ReachRule rule);
  ReachFinder(const ReachFinder&) = delete;
  ReachFinder& operator=(const ReachFinder&) = delete;
  ~ReachFinder() = default;

  /// Whether a module can get to `cell`, which is free, when `state` is there. Of an empty state
  /// every cell can be reached: nothing is in the way, and nothing there to go along.
  bool can_reach(const ElementSet& state, const base::Cell& cell) const;

  /// Whether floor and obstacles leave `cell` to a module.
  bool has_room(const base::Cell& cell) const;

  /// Answers can_reach() for many cells at once.
  std::vector<bool> can_reach_each(const ElementSet& state,
                                   const std::vector<base::Cell>& cells) const;

  /// Whether modules can get to all of these cells, of the target, in whatever order they come:
  /// each has a way that no other of them bars or carries.
  bool can_reach_in_any_order(const ElementSet& state, const std::vector<base::Cell>& cells) const;

 private:
  bool is_module(const ElementSet& state, const base::Cell& cell) const;
  bool is_free(const ElementSet& state, const base::Cell& cell) const;
  bool is_beside(const ElementSet& state, const base::Cell& cell) const;
  bool is_far(const base::Cell& cell) const;
  bool has_line(const ElementSet& state, const base::Cell& cell) const;
  void for_each_move(const ElementSet& carrying, const ElementSet& barring, const base::Cell& cell,
                     const std::function<void(const base::Cell&)>& take) const;
  std::vector<base::Cell> surface(const ElementSet& carrying, const ElementSet& barring) const;

  base::Lattice lattice_;
  std::optional<std::int32_t> floor_z_;  ///< None if it bars nothing.
  std::vector<model::Obstacle> obstacles_;
  model::ObstacleIndex obstacle_index_;
  model::CellIndex modules_;  ///< Of the target.
  base::Cell low_;            ///< Beyond these corners there is nothing but floor.
  base::Cell high_;
  ReachRule rule_;
};

}  // namespace holdfast::plan
