// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "many_planned.hpp"

#include <algorithm>
#include <set>
#include <vector>

#include "holdfast/base/check.hpp"
#include "holdfast/base/rng.hpp"
#include "random_robot.hpp"

namespace holdfast::test {
namespace {

using base::Cell;

constexpr std::size_t kPlannedMin = 6;

class Planner {
 public:
  Planner(std::uint64_t seed, const std::vector<Cell>& existing)
      : rng_(base::Rng(seed).next()), cells_(existing), taken_(existing.begin(), existing.end()) {}

  std::vector<Cell> plan(std::uint64_t kind, std::size_t planned_max) {
    const std::size_t existing = cells_.size();
    const std::size_t count = kPlannedMin + rng_.below(planned_max - kPlannedMin + 1);
    const bool is_pile = kind == 1;
    const int draws = kind == 2 ? 12 : 1;
    while (cells_.size() < existing + count) {
      const std::size_t first = is_pile && cells_.size() > existing ? existing : 0;
      Cell best = free_cell(first);
      for (int i = 1; i < draws; ++i) {
        const Cell other = free_cell(first);
        best = touching(other) > touching(best) ? other : best;
      }
      taken_.insert(best);
      cells_.push_back(best);
    }
    return {cells_.begin() + static_cast<std::ptrdiff_t>(existing), cells_.end()};
  }

 private:
  /// A free cell beside one of the modules from `first` on.
  Cell free_cell(std::size_t first) {
    for (;;) {
      const Cell beside = cells_[first + rng_.below(cells_.size() - first)];
      const Cell cell = base::neighbour(beside, base::kDirections[rng_.below(6)]);
      if (cell.z >= 0 && !taken_.contains(cell)) {
        return cell;
      }
    }
  }

  std::ptrdiff_t touching(const Cell& cell) const {
    return std::ranges::count_if(base::kDirections, [&](base::Direction direction) {
      return taken_.contains(base::neighbour(cell, direction));
    });
  }

  base::Rng rng_;
  std::vector<Cell> cells_;
  std::set<Cell> taken_;
};

}  // namespace

model::RobotSpec many_planned_robot(std::uint64_t seed, std::size_t planned_max) {
  HOLDFAST_CHECK(planned_max >= kPlannedMin);
  model::RobotSpec spec = random_robot(seed);
  spec.planned = Planner(seed, spec.existing).plan(seed / 4 % 3, planned_max);
  if (seed % 2 == 1) {
    spec.fixed = {spec.existing.front()};
  }
  return spec;
}

}  // namespace holdfast::test
