// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <set>
#include <vector>

#include "holdfast/base/rng.hpp"
#include "holdfast/model/step.hpp"
#include "move_brute_force.hpp"

namespace holdfast::plan::test {

using Cells = brute_force::Cells;

/// What shapes alone say of moves of cubes: it knows no more of the room than brute_force.
class Replayer {
 public:
  /// No module gets below the floor or into `barred`; both hold those beside.
  Replayer(Cells start, Cells fixed, Cells barred = {})
      : cells_(std::move(start)), fixed_(std::move(fixed)), barred_(std::move(barred)) {}

  /// Makes the moves; false at the first that cannot be made.
  bool run(const std::vector<model::Step>& steps) {
    return std::ranges::all_of(steps, [&](const model::Step& step) {
      return step.moves.size() == 1 && step.attach.empty() && step.detach.empty() &&
             step.release.empty() && go(step.moves[0].from, step.moves[0].to);
    });
  }

  const Cells& cells() const { return cells_; }

 private:
  bool is_free(const base::Cell& cell) const {
    return cell.z >= 0 && !cells_.contains(cell) && !barred_.contains(cell);
  }

  bool go(const base::Cell& from, const base::Cell& to) {
    if (!cells_.contains(from) || fixed_.contains(from) || !is_free(to)) {
      return false;
    }
    cells_.erase(from);
    const bool is_held =
        !fixed_.empty() || std::ranges::any_of(cells_, [&](const base::Cell& cell) {
          return cell.z == 0 ||
                 std::ranges::any_of(brute_force::sides(), [&](const base::Cell& side) {
                   return barred_.contains(brute_force::plus(cell, side));
                 });
        });
    const bool is_way = is_held && brute_force::is_connected(cells_) && has_way(from, to);
    cells_.insert(to);
    return is_way;
  }

  bool has_way(const base::Cell& from, const base::Cell& to) const {
    const auto at = [&](const base::Cell& cell) { return cells_.contains(cell); };
    for (const base::Cell& side : brute_force::sides()) {
      for (const base::Cell& along : brute_force::sides()) {
        const base::Cell carrier = brute_force::plus(from, side);
        const base::Cell ahead = brute_force::plus(from, along);
        const base::Cell over = brute_force::plus(ahead, side);
        const int turn = side.x * along.x + side.y * along.y + side.z * along.z;
        if (turn == 0 && at(carrier) &&
            ((ahead == to && at(over)) || (over == to && is_free(ahead)))) {
          return true;
        }
      }
    }
    return false;
  }

  Cells cells_;
  Cells fixed_;
  Cells barred_;
};

/// A random shape on the floor that grows cell by cell, in a box around the origin.
inline Cells random_blob(std::size_t count, const base::Cell& low, const base::Cell& high,
                         const Cells& barred, base::Rng& rng) {
  Cells cells = {{0, 0, 0}};
  while (cells.size() < count) {
    auto place = cells.begin();
    std::advance(place, static_cast<std::ptrdiff_t>(rng.below(cells.size())));
    const base::Cell next = brute_force::plus(*place, brute_force::sides()[rng.below(6)]);
    const bool is_inside = low.x <= next.x && next.x <= high.x && low.y <= next.y &&
                           next.y <= high.y && low.z <= next.z && next.z <= high.z;
    if (is_inside && !barred.contains(next)) {
      cells.insert(next);
    }
  }
  return cells;
}

}  // namespace holdfast::plan::test
