// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "holdfast/base/algebra.hpp"
#include "holdfast/plan/module_moves.hpp"

namespace holdfast::plan {

/// A cell of a SlideGrid, as a number.
using GridCell = std::int32_t;

/// Cubes in a box of cells that nobody leaves, and where one of them can slide: the moves of
/// module_moves.hpp for the cubic lattice, without allocation.
class SlideGrid {
 public:
  enum class What : std::uint8_t { kFree, kModule, kBarred };

  static constexpr std::size_t kSideCount = 6;

  explicit SlideGrid(const CellBox& box);

  std::size_t size() const { return what_.size(); }

  GridCell find(const base::Cell& cell) const {
    return cell.x - low_.x + (cell.y - low_.y) * sides_[2] + (cell.z - low_.z) * sides_[4];
  }

  base::Cell cell(GridCell cell) const;

  /// Cells that are barred around the box are part of the grid, so that every cell of the box has
  /// all its neighbours.
  bool is_inside(GridCell cell) const { return is_inside_[base::at(cell)]; }

  What at(GridCell cell) const { return what_[base::at(cell)]; }

  bool is_free(GridCell cell) const { return at(cell) == What::kFree; }

  bool is_module(GridCell cell) const { return at(cell) == What::kModule; }

  void set(GridCell cell, What what) { what_[base::at(cell)] = what; }

  /// Steps to the six neighbours; each odd one is opposite to the one before.
  const std::array<GridCell, kSideCount>& sides() const { return sides_; }

  /// Calls visit(to) for every end of a move of a cube at `from`, some more than once. The grid
  /// must not have the cube itself as a module.
  template <class Visit>
  void for_each_move(GridCell from, const Visit& visit) const {
    for (std::size_t along = 0; along < kSideCount; ++along) {
      const GridCell ahead = from + sides_[along];
      if (!is_free(ahead)) {
        continue;
      }
      for (std::size_t side = 0; side < kSideCount; ++side) {
        if (side / 2 == along / 2 || !is_module(from + sides_[side])) {
          continue;
        }
        const GridCell over = ahead + sides_[side];
        if (is_module(over)) {
          visit(ahead);
        } else if (is_free(over)) {
          visit(over);
        }
      }
    }
  }

  /// Calls visit(to) for every module whose place a cube at `from` could take if it were free.
  template <class Visit>
  void for_each_push(GridCell from, const Visit& visit) const {
    for (std::size_t along = 0; along < kSideCount; ++along) {
      const GridCell ahead = from + sides_[along];
      for (std::size_t side = 0; side < kSideCount; ++side) {
        const GridCell over = ahead + sides_[side];
        if (side / 2 == along / 2 || !is_module(from + sides_[side]) || !is_module(over)) {
          continue;
        }
        if (is_module(ahead)) {
          visit(ahead);
        } else if (is_free(ahead)) {
          visit(over);
        }
      }
    }
  }

  /// Calls visit(cell) for every cell one move away through the air.
  template <class Visit>
  void for_each_near(GridCell from, const Visit& visit) const {
    for (const GridCell step : near_) {
      if (is_inside(from + step)) {
        visit(from + step);
      }
    }
  }

  /// Whether a cube in a free cell parts the free cells around it, as far as its 26 neighbours say.
  bool may_part_air(GridCell cell) const;

 private:
  base::Cell low_;  ///< Of all cells of the grid.
  base::Cell span_;
  std::array<GridCell, kSideCount> sides_{};
  std::array<GridCell, 18> near_{};  ///< Steps to the cells that one move can reach.
  std::vector<What> what_;
  std::vector<bool> is_inside_;
};

}  // namespace holdfast::plan
