// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "holdfast/plan/order_help.hpp"

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <limits>
#include <set>
#include <utility>

#include "barring_floor.hpp"
#include "holdfast/base/lattice.hpp"
#include "patience.hpp"

namespace holdfast::plan {
namespace {

using base::Cell;

/// Pairs are tried only of so few cells.
constexpr std::size_t kPairedCellsMax = 60;

/// Runs of modules that would help are sought up to this length.
constexpr std::size_t kRunMax = 40;

/// Other sources are tried up to this number.
constexpr std::size_t kSourcesMax = 40;

/// How far cells are apart, in steps of their coordinates.
std::int64_t distance(const Cell& a, const Cell& b) {
  const auto apart = [](std::int32_t x, std::int32_t y) { return std::abs(std::int64_t{x} - y); };
  return apart(a.x, b.x) + apart(a.y, b.y) + apart(a.z, b.z);
}

std::vector<Cell> sorted(std::vector<Cell> cells) {
  std::ranges::sort(cells);
  return cells;
}

class HelpSearch {
 public:
  HelpSearch(const OrderTask& task, const HelpOptions& options)
      : task_(task),
        options_(options),
        floor_z_(barring_floor(task.target.support_z, task.target.existing)) {
    taken_.insert(task.target.existing.begin(), task.target.existing.end());
    list_cells();
  }

  std::optional<Help> run();

  /// Whether there is an order in pieces, of a robot that needs help to be built in one.
  bool do_pieces_help() const;

 private:
  bool is_free(const Cell& cell) const;
  void list_cells();
  std::vector<std::vector<Cell>> runs() const;
  std::vector<Help> other_sources() const;
  std::optional<Help> try_all(const std::vector<Help>& helps) const;
  bool serves(const Help& help) const;
  bool has_order(const OrderTask& task,
                 double seconds_max = std::numeric_limits<double>::infinity()) const;

  const OrderTask& task_;
  const HelpOptions& options_;
  std::optional<std::int32_t> floor_z_;
  std::set<Cell> taken_;
  std::vector<Cell> beside_;  ///< Free cells beside the target, ascending by layer.
  std::vector<Cell> below_;   ///< Those straight below a module, where the lattice has any.
  Patience patience_{options_.seconds_max, options_.is_interrupted};
};

bool HelpSearch::is_free(const Cell& cell) const {
  const model::ObstacleIndex obstacles(task_.target.obstacles);
  return !taken_.contains(cell) && obstacles.find(cell) == model::CellIndex::kNone &&
         (!floor_z_ || cell.z >= *floor_z_) && task_.rule.source != cell &&
         std::ranges::find(task_.rule.avoid, cell) == task_.rule.avoid.end();
}

void HelpSearch::list_cells() {
  std::set<Cell> beside;
  const base::Lattice& lattice = task_.target.lattice;
  for (const Cell& module : task_.target.existing) {
    for (const base::Direction direction : base::directions(lattice)) {
      const Cell cell = base::neighbour(lattice, module, direction);
      if (!is_free(cell)) {
        continue;
      }
      if (beside.insert(cell).second) {
        beside_.push_back(cell);
      }
      if (direction == base::down(lattice)) {
        below_.push_back(cell);
      }
    }
  }
  const auto by_layer = [](const Cell& cell) { return std::array{cell.z, cell.x, cell.y}; };
  std::ranges::sort(beside_, {}, by_layer);
  std::ranges::sort(below_, {}, by_layer);
}

/// Straight runs of two or more free cells from a module of the target to another, or to the floor.
std::vector<std::vector<Cell>> HelpSearch::runs() const {
  std::set<std::vector<Cell>> found;
  const base::Lattice& lattice = task_.target.lattice;
  for (const Cell& module : task_.target.existing) {
    for (const base::Direction direction : base::directions(lattice)) {
      std::vector<Cell> run;
      Cell cell = base::neighbour(lattice, module, direction);
      while (is_free(cell) && run.size() < kRunMax) {
        run.push_back(cell);
        cell = base::neighbour(lattice, cell, direction);
        const bool is_on_floor = run.back().z == task_.target.support_z && cell.z < run.back().z;
        if (run.size() > 1 && (is_on_floor || taken_.contains(cell))) {
          found.insert(sorted(run));
        }
      }
    }
  }
  return {found.begin(), found.end()};
}

bool HelpSearch::has_order(const OrderTask& task, double seconds_max) const {
  const auto found = find_robot_order(task, {.seconds_max = seconds_max,
                                             .state_count_max = options_.state_count_max,
                                             .is_interrupted = options_.is_interrupted,
                                             .thread_count = options_.thread_count});
  return found && found.value().order.outcome == OrderOutcome::kFound;
}

bool HelpSearch::do_pieces_help() const {
  if (task_.in_pieces || task_.group_size > 1 || task_.parallel_max > 1) {
    return false;
  }
  OrderTask task = task_;
  task.in_pieces = true;
  return has_order(task, options_.seconds_max / 4);
}

bool HelpSearch::serves(const Help& help) const {
  OrderTask helped = task_;
  helped.rule = help.rule.value_or(task_.rule);
  for (const Cell& cell : help.supports) {
    helped.target.obstacles.push_back({.from = cell, .to = cell});
  }
  helped.target.existing.insert(helped.target.existing.end(), help.temporary.begin(),
                                help.temporary.end());
  if (!has_order(helped)) {
    return false;
  }
  if (help.temporary.empty()) {
    return true;
  }
  helped.start = task_.target.existing;
  return has_order(helped);
}

std::optional<Help> HelpSearch::try_all(const std::vector<Help>& helps) const {
  for (const Help& help : helps) {
    if (patience_.is_over()) {
      return std::nullopt;
    }
    if (serves(help)) {
      return help;
    }
  }
  return std::nullopt;
}

/// Free cells beside the target instead of the source, the nearest first.
std::vector<Help> HelpSearch::other_sources() const {
  std::vector<Help> helps;
  if (!task_.rule.source) {
    return helps;
  }
  std::vector<Cell> cells = beside_;
  std::ranges::stable_sort(cells, {},
                           [&](const Cell& cell) { return distance(cell, *task_.rule.source); });
  cells.resize(std::min(cells.size(), kSourcesMax));
  for (const Cell& cell : cells) {
    helps.push_back({.rule = task_.rule});
    helps.back().rule->source = cell;
  }
  return helps;
}

std::optional<Help> HelpSearch::run() {
  const Help free_ways = {.rule = ReachRule{}};
  const bool is_barred_by_ways = task_.rule.reach != Reach::kFree && serves(free_ways);
  if (is_barred_by_ways) {
    if (auto other = try_all(other_sources())) {
      return other;
    }
  }
  std::vector<Help> helps;
  for (const Cell& cell : below_) {
    helps.push_back({.supports = {cell}});
  }
  for (const Cell& cell : beside_) {
    helps.push_back({.temporary = {cell}});
  }
  for (std::size_t i = 0; beside_.size() <= kPairedCellsMax && i < beside_.size(); ++i) {
    for (std::size_t k = 0; k < i; ++k) {
      helps.push_back({.temporary = {beside_[k], beside_[i]}});
    }
  }
  for (std::vector<Cell>& run : runs()) {
    helps.push_back({.temporary = std::move(run)});
  }
  std::ranges::stable_sort(
      helps, {}, [](const Help& help) { return help.supports.size() + help.temporary.size(); });
  auto found = try_all(helps);
  return found || !is_barred_by_ways ? found : free_ways;
}

}  // namespace

std::optional<Help> find_help(const OrderTask& task, const HelpOptions& options) {
  HelpSearch search(task, options);
  const bool in_pieces = search.do_pieces_help();
  auto found = search.run();
  if (in_pieces) {
    found = found.value_or(Help{});
    found->in_pieces = true;
  }
  return found;
}

}  // namespace holdfast::plan
