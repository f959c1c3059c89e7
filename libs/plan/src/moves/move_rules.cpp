// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "moves/move_rules.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <string>

#include "barring_floor.hpp"

namespace holdfast::plan {

using base::Cell;

MoveRule rule_of(const MoveTask& task) {
  MoveRule rule{
      .motions = task.motions,
      .floor_z = barring_floor(task.start.support_z, task.start.existing, task.target.existing),
      .within = task.within,
      .avoid = model::CellIndex(task.avoid.size())};
  for (const Cell& cell : task.avoid) {
    rule.avoid.insert(cell, 0);
  }
  return rule;
}

RobotState kept_state(const MoveTask& task, const model::RobotSpec& spec) {
  RobotState robot(spec);
  for (const Cell& cell : task.keep) {
    if (robot.find(cell) != RobotState::kNone) {
      robot.keep(cell);
    }
  }
  return robot;
}

std::optional<base::Error> find_cell_fault(const MoveTask& task, const model::RobotSpec& spec,
                                           const std::string& which) {
  const std::set<Cell> avoided(task.avoid.begin(), task.avoid.end());
  std::set<Cell> staying(spec.fixed.begin(), spec.fixed.end());
  staying.insert(task.keep.begin(), task.keep.end());
  for (const Cell& cell : spec.existing) {
    if (avoided.contains(cell)) {
      return base::bad_input(fmt::format("the cell {} is to be avoided, but {} has a module there",
                                         model::text(cell), which));
    }
    if (task.within && !staying.contains(cell) && !task.within->contains(cell)) {
      return base::bad_input(fmt::format("{}: the module {} is outside the box from {} to {}",
                                         which, model::text(cell), model::text(task.within->low),
                                         model::text(task.within->high)));
    }
  }
  return std::nullopt;
}

std::vector<bool> allowed_steps(const MoveTask& task, const model::RobotSpec& start,
                                std::span<const model::Step> steps) {
  const MoveRule rule = rule_of(task);
  RobotState robot(start);
  std::vector<bool> are_allowed;
  for (const model::Step& step : steps) {
    const model::Move& move = step.moves.front();
    const std::int32_t module = robot.find(move.from);
    const std::vector<std::int32_t> loose = loose_modules(robot);
    const auto is_this = [&](const model::Move& each) {
      return each.to == move.to && (!move.carrier || !each.carrier || each.carrier == move.carrier);
    };
    are_allowed.push_back(std::ranges::find(task.keep, move.from) == task.keep.end() &&
                          std::ranges::binary_search(loose, module) &&
                          std::ranges::any_of(moves_of(robot, module, rule), is_this));
    robot.move({&move.from, 1}, {&move.to, 1});
  }
  return are_allowed;
}

}  // namespace holdfast::plan
