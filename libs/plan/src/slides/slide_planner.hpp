// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <optional>
#include <set>
#include <span>
#include <tuple>
#include <vector>

#include "holdfast/base/rng.hpp"
#include "slides/slide_search.hpp"

namespace holdfast::plan {

/// A walk of one cube along the surface of all others: the cells that it is in, first to last.
using SlideWalk = std::vector<GridCell>;

/// What moves in a SlidePlanner.
struct SlideTask {
  SlideGrid grid;                ///< With what is barred, and without modules.
  std::vector<GridCell> fixed;   ///< Modules that stay.
  std::vector<GridCell> start;   ///< Cubes alike.
  std::vector<GridCell> target;  ///< As many cells.
  std::vector<bool> is_support;  ///< By cell: whether a module there holds the robot.
  /// Among cubes as good as each other those furthest in this direction go first: a number in
  /// SlideGrid::sides().
  std::size_t first_side = kUp;

  static constexpr std::size_t kUp = 4;
};

/// What a planner asks besides geometry.
class SlideJudge {
 public:
  SlideJudge() = default;
  SlideJudge(const SlideJudge&) = delete;
  SlideJudge& operator=(const SlideJudge&) = delete;
  virtual ~SlideJudge() = default;

  /// The number of the first move of a walk that is not safe, if there is any.
  virtual std::optional<std::size_t> find_unsafe(std::span<const GridCell> walk) = 0;

  /// The walk that was asked for last, and is safe, is made.
  virtual void make() = 0;

  /// The last walk that was made, and is not taken back yet, is taken back.
  virtual void take_back() = 0;

  /// Whether to give up.
  virtual bool is_over() = 0;
};

/// Takes many sliding cubes from one shape to another, cube by cube. Of the cubes without which the
/// rest is one piece, and of the free cells of the target, the pair is taken whose path wastes the
/// fewest moves (slide_potential.hpp); where a path leads through other cubes each of them moves on
/// to the place of the next.
class SlidePlanner {
 public:
  /// Keeps a reference of the judge.
  SlidePlanner(const SlideTask& task, std::uint64_t seed, SlideJudge& judge);

  /// Goes on until the target is reached; false if it is stuck before, or the judge is over. Where
  /// it is stuck it takes cubes out of the way, so many times.
  bool run(std::size_t unlocks_left);

  /// What run() has made, in order.
  const std::vector<SlideWalk>& walks() const { return walks_; }

  /// Where the cubes are.
  const std::vector<GridCell>& cubes() const { return cubes_; }

 private:
  /// The best path of a cube as it was known after so many walks, counted from 1.
  struct Offer {
    WastefulPath best = {.waste = 0};
    std::size_t version = 0;
  };

  GridCell cell_of(std::size_t module) const {
    return module < cubes_.size() ? cubes_[module] : fixed_[module - cubes_.size()];
  }

  bool is_stray(GridCell cube) const { return !in_target_[base::at(cube)]; }

  bool is_loose_at(GridCell cell) const;
  bool is_beside(GridCell cell, const std::vector<bool>& modules) const;
  std::size_t count_strays() const;
  int height_of(GridCell cell) const;
  void renew_potential();
  void find_loose();
  bool advance();
  SlidePath choose();
  std::optional<std::size_t> next_to_ask() const;
  WastefulPath seek(std::size_t cube, int waste_max, const std::function<bool(GridCell)>& accepts);
  bool may_fill(GridCell goal) const;
  bool has_lost_goal(GridCell air, GridCell filled) const;
  bool bridge();
  bool unlock();
  bool set_foot();
  bool park(std::size_t cube, const std::vector<bool>& away_from);
  bool shake();
  std::vector<std::size_t> hanging_on(std::size_t cube) const;
  bool make(const SlidePath& path);
  bool step(SlideWalk walk);
  void relocate(GridCell from, GridCell to);

  SlideGrid grid_;
  std::vector<GridCell> fixed_;
  std::vector<GridCell> cubes_;
  std::vector<GridCell> target_;
  std::vector<bool> is_support_;
  std::vector<bool> in_target_;  ///< By cell.
  SlideJudge& judge_;
  base::Rng rng_;
  SlideSearch search_;
  std::vector<int> potential_;           ///< By cell.
  std::vector<std::int32_t> module_at_;  ///< By cell: fixed ones behind the cubes; or -1.
  std::vector<bool> is_loose_;           ///< By cube.
  std::size_t support_count_ = 0;        ///< Modules that hold the robot.
  std::vector<Offer> offers_;            ///< By cube.
  std::vector<SlideWalk> walks_;
  std::size_t first_side_;
  std::size_t renewed_ = 0;  ///< So many walks ago the potential was made.
  std::size_t version_ = 1;
  bool is_strict_ = true;   ///< Cells are not filled if a cube that has to leave is shut in.
  bool is_pushing_ = true;  ///< Paths may lead through cubes.
  /// Moves of a cube that are not safe while all others are where they are.
  std::set<std::tuple<std::size_t, GridCell, GridCell>> barred_;
};

}  // namespace holdfast::plan
