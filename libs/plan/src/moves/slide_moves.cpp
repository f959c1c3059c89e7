// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "moves/slide_moves.hpp"

#include <algorithm>
#include <iterator>
#include <limits>
#include <utility>

#include "moves/shape_search.hpp"
#include "slides/slide_plan.hpp"

namespace holdfast::plan {
namespace {

using base::Cell;

/// Cells around both shapes in which cubes may walk.
constexpr std::int32_t kMargin = 3;

/// Some 20 bytes a cell.
constexpr std::int64_t kGridCellsMax = 20'000'000;

/// The most cubes; their prices take some seconds, again and again.
constexpr std::size_t kCubesMax = 3000;

/// The most cubes for which plans are made in several orders, by geometry alone: a second for 300.
constexpr std::size_t kVariedMax = 400;

/// The box of both shapes and what is around, as far as the rule allows.
CellBox box_of(const RobotState& robot, const ShapeSpace& space, const MoveRule& rule) {
  CellBox box{.low = space.start().front(), .high = space.start().front()};
  const auto take = [&](const Cell& cell) {
    box.low = {std::min(box.low.x, cell.x), std::min(box.low.y, cell.y),
               std::min(box.low.z, cell.z)};
    box.high = {std::max(box.high.x, cell.x), std::max(box.high.y, cell.y),
                std::max(box.high.z, cell.z)};
  };
  for (const Shape& shape : {space.start(), space.target()}) {
    std::ranges::for_each(shape, take);
  }
  for (const ModuleState& module : robot.modules()) {
    take(module.cell);
  }
  box.low = {box.low.x - kMargin, box.low.y - kMargin, box.low.z - kMargin};
  box.high = {box.high.x + kMargin, box.high.y + kMargin, box.high.z + kMargin};
  if (rule.floor_z) {
    box.low.z = std::max(box.low.z, *rule.floor_z);
  }
  return box;
}

bool is_near_obstacle(const RobotState& robot, const Cell& cell) {
  for (const base::Direction direction : base::directions(robot.lattice())) {
    const Cell next = base::neighbour(robot.lattice(), cell, direction);
    if (robot.obstacles().find(next) != model::CellIndex::kNone) {
      return true;
    }
  }
  return false;
}

/// Says which walks are safe at every stage of their moves.
class WalkJudge : public SlideJudge {
 public:
  /// Keeps a reference of the judge. `robot`: in the shape that the planner begins with; `end`:
  /// walks from the target are judged from their ends to their beginnings.
  WalkJudge(const SlideGrid& grid, RobotState robot, End end, MoveJudge& judge)
      : grid_(grid), robot_(std::move(robot)), is_backward_(end == End::kTarget), judge_(judge) {}

  std::optional<std::size_t> find_unsafe(std::span<const GridCell> walk) override {
    asked_ = {.from = grid_.cell(walk.front()), .to = grid_.cell(walk.back())};
    found_.clear();
    if (judge_.ignores_mechanics()) {
      judge_.count_unjudged(walk.size() - 1);
      return std::nullopt;
    }
    std::vector<Cell> cells;
    std::ranges::transform(walk, std::back_inserter(cells),
                           [&](GridCell cell) { return grid_.cell(cell); });
    if (is_backward_) {
      std::ranges::reverse(cells);
      robot_.move({&asked_.from, 1}, {&asked_.to, 1});
    }
    std::size_t done = 0;
    while (done + 1 < cells.size() && go(cells[done], cells[done + 1])) {
      ++done;
    }
    const bool is_safe = done + 1 == cells.size();
    if (cells[done] != asked_.from) {
      robot_.move({&cells[done], 1}, {&asked_.from, 1});
    }
    return is_safe        ? std::nullopt
           : is_backward_ ? std::optional(cells.size() - 2 - done)
                          : std::optional(done);
  }

  void make() override {
    robot_.move({&asked_.from, 1}, {&asked_.to, 1});
    walks_.push_back(asked_);
    made_.push_back(std::exchange(found_, {}));
  }

  void take_back() override {
    robot_.move({&walks_.back().to, 1}, {&walks_.back().from, 1});
    walks_.pop_back();
    made_.pop_back();
  }

  bool is_over() override { return judge_.is_over(); }

  /// What was found of each move of the walks made; by walk, in the order in which it is gone.
  const std::vector<std::vector<StepJudgement>>& made() const { return made_; }

 private:
  struct Ends {
    Cell from;
    Cell to;
  };

  /// Makes a move if it is safe.
  bool go(const Cell& from, const Cell& to) {
    auto judged = judge_.judge_move(robot_, {.from = from, .to = to, .carrier = {}},
                                    found_.empty() ? nullptr : &found_.back());
    if (!judged) {
      return false;
    }
    found_.push_back(*std::move(judged));
    robot_.move({&from, 1}, {&to, 1});
    return true;
  }

  const SlideGrid& grid_;
  RobotState robot_;
  bool is_backward_;
  MoveJudge& judge_;
  Ends asked_ = {};
  std::vector<StepJudgement> found_;  ///< Of the walk asked for last.
  std::vector<Ends> walks_;
  std::vector<std::vector<StepJudgement>> made_;
};

}  // namespace

std::optional<SlideTask> slide_task(const ShapeSpace& space, const MoveRule& rule) {
  const RobotState robot = space.state_of(space.start());
  if (robot.lattice() != base::kCubic || rule.motions || space.class_count() != 1 ||
      space.start().size() > kCubesMax) {
    return std::nullopt;
  }
  const CellBox box = box_of(robot, space, rule);
  const std::int64_t size = (std::int64_t{box.high.x} - box.low.x + 3) *
                            (std::int64_t{box.high.y} - box.low.y + 3) *
                            (std::int64_t{box.high.z} - box.low.z + 3);
  if (size > kGridCellsMax) {
    return std::nullopt;
  }
  SlideTask task{.grid = SlideGrid(box),
                 .fixed = {},
                 .start = {},
                 .target = {},
                 .is_support = std::vector<bool>(static_cast<std::size_t>(size))};
  const auto number = [&](const Cell& cell) { return task.grid.find(cell); };
  std::ranges::transform(space.start(), std::back_inserter(task.start), number);
  std::ranges::transform(space.target(), std::back_inserter(task.target), number);
  for (std::size_t i = 0; i < task.grid.size(); ++i) {
    const auto place = static_cast<GridCell>(i);
    const Cell cell = task.grid.cell(place);
    if ((rule.within && !rule.within->contains(cell)) ||
        robot.obstacles().find(cell) != model::CellIndex::kNone ||
        rule.avoid.find(cell) != model::CellIndex::kNone) {
      task.grid.set(place, SlideGrid::What::kBarred);
    }
    task.is_support[i] = cell.z == robot.surroundings().support_z || is_near_obstacle(robot, cell);
  }
  for (const ModuleState& module : robot.modules()) {
    if (module.is_there && module.stays()) {
      const GridCell place = number(module.cell);
      task.fixed.push_back(place);
      task.is_support[base::at(place)] = task.is_support[base::at(place)] || module.is_fixed;
    }
  }
  return task;
}

namespace {

/// Judges nothing, but asks for time.
class PatientOnly : public SlideJudge {
 public:
  explicit PatientOnly(const MoveJudge& judge) : judge_(judge) {}

  std::optional<std::size_t> find_unsafe(std::span<const GridCell>) override {
    return std::nullopt;
  }

  void make() override {}

  void take_back() override {}

  bool is_over() override { return judge_.is_over(); }

 private:
  const MoveJudge& judge_;
};

/// The direction in which cubes go first in the shortest plan by geometry; up, for many.
std::size_t best_first_side(SlideTask task, std::uint64_t seed, const MoveJudge& judge) {
  std::size_t best = SlideTask::kUp;
  if (task.start.size() > kVariedMax) {
    return best;
  }
  std::size_t least = std::numeric_limits<std::size_t>::max();
  PatientOnly patient(judge);
  for (std::size_t side = SlideTask::kUp + 1; side-- > 0;) {
    task.first_side = side;
    const SlidePlan plan = plan_slides(task, seed, patient, patient);
    std::size_t length = 0;
    for (const SlideWalk& walk : plan.walks) {
      length += walk.size() - 1;
    }
    if (plan.is_found && length < least) {
      least = length;
      best = side;
    }
  }
  return best;
}

}  // namespace

std::optional<SlideMoves> find_slides(const ShapeSpace& space, const MoveRule& rule,
                                      std::uint64_t seed, MoveJudge& judge) {
  auto task = slide_task(space, rule);
  if (!task) {
    return std::nullopt;
  }
  task->first_side = best_first_side(*task, seed, judge);
  WalkJudge forth(task->grid, space.state_of(space.start()), End::kStart, judge);
  WalkJudge back(task->grid, space.state_of(space.target()), End::kTarget, judge);
  const SlidePlan plan = plan_slides(*task, seed, forth, back);
  SlideMoves found{.is_found = plan.is_found};
  for (const SlideWalk& walk : plan.walks) {
    for (std::size_t i = 1; i < walk.size(); ++i) {
      found.moves.push_back(
          {.from = task->grid.cell(walk[i - 1]), .to = task->grid.cell(walk[i]), .carrier = {}});
    }
  }
  for (const auto& walk : forth.made()) {
    found.judged.insert(found.judged.end(), walk.begin(), walk.end());
  }
  if (found.is_found) {
    std::for_each(back.made().rbegin(), back.made().rend(), [&](const auto& walk) {
      found.judged.insert(found.judged.end(), walk.begin(), walk.end());
    });
  }
  return found;
}

}  // namespace holdfast::plan
