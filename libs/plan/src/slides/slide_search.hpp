// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>
#include <limits>
#include <vector>

#include "slides/slide_grid.hpp"

namespace holdfast::plan {

/// The cells that a cube comes through, first to last. Where one of them holds another cube this
/// goes on, and the first one takes its place.
using SlidePath = std::vector<GridCell>;

/// A path and the moves in it beyond what it lowers the potential by.
struct WastefulPath {
  static constexpr int kAny = std::numeric_limits<int>::max();

  int waste = kAny;
  SlidePath path = {};  ///< Empty: there is none of less waste.
};

/// Seeks the path of least waste for one cube after another.
class SlideSearch {
 public:
  explicit SlideSearch(std::size_t size) : seen_(size), waste_(size), before_(size) {}

  /// The path from a cell without a cube to the first cell that `accepts`, by ways that waste less
  /// than `waste_max`. `may_pass(from, to)`: whether a move is not barred; `may_leave(cell)`:
  /// whether the cube in a cell can be made to go on.
  template <class Accepts, class MayPass, class MayLeave>
  WastefulPath seek(const SlideGrid& grid, const std::vector<int>& potential, GridCell start,
                    int waste_max, const Accepts& accepts, const MayPass& may_pass,
                    const MayLeave& may_leave) {
    WastefulPath found{.waste = waste_max};
    ++search_;
    put(start, start, 0);
    for (std::size_t waste = 0; waste < buckets_.size(); ++waste) {
      for (std::size_t i = 0; i < buckets_[waste].size() && found.path.empty(); ++i) {
        const GridCell cell = buckets_[waste][i];
        if (base::at(waste_[base::at(cell)]) != waste) {
          continue;
        }
        if (cell != start && grid.is_free(cell) && accepts(cell)) {
          found = {.waste = static_cast<int>(waste), .path = trace(cell)};
          break;
        }
        const auto go = [&](GridCell to) {
          const int gain = potential[base::at(cell)] - potential[base::at(to)];
          const int next = static_cast<int>(waste) + std::max(0, 1 - gain);
          if (next < waste_max && may_pass(cell, to)) {
            put(to, cell, next);
          }
        };
        grid.for_each_move(cell, go);
        grid.for_each_push(cell, [&](GridCell to) {
          if (may_leave(to)) {
            go(to);
          }
        });
      }
      buckets_[waste].clear();
    }
    return found;
  }

 private:
  void put(GridCell cell, GridCell before, int waste);
  SlidePath trace(GridCell end) const;

  // By cell; void unless it was seen in this search.
  std::vector<std::uint32_t> seen_;
  std::vector<int> waste_;
  std::vector<GridCell> before_;
  std::uint32_t search_ = 0;
  std::vector<std::vector<GridCell>> buckets_;  ///< Cells to go on from, by waste.
};

}  // namespace holdfast::plan
