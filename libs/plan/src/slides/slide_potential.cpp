// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "slides/slide_potential.hpp"

#include <algorithm>

#include "slides/assignment.hpp"

namespace holdfast::plan {
namespace {

using base::at;
using What = SlideGrid::What;

/// The cost of entering a cell that both shapes fill. With 1 plans of blobs are 3 % longer, with 6
/// no shorter.
constexpr int kCoreCost = 2;

/// A move through the air, away from both shapes.
constexpr int kAirCost = 2;

/// Distances in a grid, cost by cost. Memory of a search serves the next.
class CostFlood {
 public:
  CostFlood(const SlideGrid& grid, std::span<const GridCell> modules,
            std::span<const GridCell> goals)
      : grid_(grid), union_(grid), is_core_(grid.size()), cost_(grid.size(), kNoPotential) {
    for (std::size_t i = 0; i < grid.size(); ++i) {
      is_core_[i] = grid.is_module(static_cast<GridCell>(i));
    }
    for (const GridCell cell : modules) {
      is_core_[at(cell)] = false;
    }
    for (const GridCell cell : goals) {
      union_.set(cell, What::kModule);
    }
  }

  /// What each cell costs; kNoPotential where nothing leads.
  const std::vector<int>& cost() const { return cost_; }

  void clear() { std::ranges::fill(cost_, kNoPotential); }

  void put(GridCell cell, int cost) {
    if (cost < cost_[at(cell)]) {
      cost_[at(cell)] = cost;
      buckets_.resize(std::max(buckets_.size(), at(cost) + 1));
      buckets_[at(cost)].push_back(cell);
    }
  }

  /// Goes on from what was put. `is_backward`: a step costs what the cell that it leaves does, so
  /// that the ways lead the other way round.
  void along_surfaces(bool is_backward) {
    run([&](GridCell from, int cost) {
      for_each_edge(from, [&](GridCell to) {
        put(to, cost + (is_core_[at(is_backward ? from : to)] ? kCoreCost : 1));
      });
    });
  }

  /// Goes on to the cells that nothing has led to yet.
  void through_air() {
    for (std::size_t i = 0; i < cost_.size(); ++i) {
      if (cost_[i] < kNoPotential) {
        buckets_[at(cost_[i])].push_back(static_cast<GridCell>(i));
      }
    }
    const std::vector<int> known = cost_;
    run([&](GridCell from, int cost) {
      grid_.for_each_near(from, [&](GridCell to) {
        if (known[at(to)] == kNoPotential) {
          put(to, cost + kAirCost);
        }
      });
    });
  }

 private:
  template <class Step>
  void run(const Step& step) {
    for (std::size_t cost = 0; cost < buckets_.size(); ++cost) {
      for (std::size_t i = 0; i < buckets_[cost].size(); ++i) {
        const GridCell cell = buckets_[cost][i];
        if (at(cost_[at(cell)]) == cost) {
          step(cell, static_cast<int>(cost));
        }
      }
      buckets_[cost].clear();
    }
  }

  /// Slides and turns beside cells of either shape.
  template <class Visit>
  void for_each_edge(GridCell from, const Visit& visit) const {
    for (std::size_t along = 0; along < SlideGrid::kSideCount; ++along) {
      const GridCell ahead = from + grid_.sides()[along];
      if (union_.at(ahead) == What::kBarred) {
        continue;
      }
      for (std::size_t side = 0; side < SlideGrid::kSideCount; ++side) {
        if (side / 2 == along / 2 || !union_.is_module(from + grid_.sides()[side])) {
          continue;
        }
        const GridCell over = ahead + grid_.sides()[side];
        if (union_.is_module(over)) {
          visit(ahead);
        }
        if (union_.at(over) != What::kBarred) {
          visit(over);
        }
      }
    }
  }

  const SlideGrid& grid_;
  SlideGrid union_;
  std::vector<bool> is_core_;
  std::vector<int> cost_;
  std::vector<std::vector<GridCell>> buckets_;
};

}  // namespace

std::vector<int> slide_potential(const SlideGrid& grid, std::span<const GridCell> modules,
                                 std::span<const GridCell> goals) {
  CostFlood flood(grid, modules, goals);
  std::vector<int> costs;
  costs.reserve(modules.size() * goals.size());
  for (const GridCell module : modules) {
    flood.clear();
    flood.put(module, 0);
    flood.along_surfaces(false);
    for (const GridCell goal : goals) {
      costs.push_back(std::min(flood.cost()[at(goal)], kNoPotential / 2));
    }
  }
  const std::vector<int> price = assign(costs, goals.size()).column_price;
  flood.clear();
  if (!goals.empty()) {
    const int most = *std::ranges::max_element(price);
    for (std::size_t i = 0; i < goals.size(); ++i) {
      flood.put(goals[i], std::min(most - price[i], kNoPotential - 1));
    }
    flood.along_surfaces(true);
    flood.through_air();
  }
  return flood.cost();
}

}  // namespace holdfast::plan
