// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "holdfast/trial.hpp"

#include <algorithm>
#include <iterator>

#include "holdfast/plan/judgement.hpp"

namespace holdfast {
namespace {

/// A robot that topples needs no loads; one that is bonded to the ground does not topple.
verdict::Assessment try_robot(const model::Robot& robot, const CheckOptions& options) {
  verdict::Assessment look = first_look(robot);
  const bool topples = look.verdict == verdict::Verdict::kUnstable;
  return topples && !options.is_bonded ? look : check(robot, options).assessment;
}

}  // namespace

void add_module(model::RobotSpec& spec, const base::Cell& cell, Role role) {
  (role == Role::kPlanned ? spec.planned : spec.existing).push_back(cell);
  if (role == Role::kFixed) {
    spec.fixed.push_back(cell);
  }
}

std::vector<base::Cell> free_cells(const model::RobotSpec& spec) {
  std::vector<base::Cell> taken = spec.existing;
  taken.insert(taken.end(), spec.planned.begin(), spec.planned.end());
  std::ranges::sort(taken);
  std::vector<base::Cell> beside;
  for (const base::Cell& cell : taken) {
    for (const base::Direction direction : base::directions(spec.lattice)) {
      beside.push_back(base::neighbour(spec.lattice, cell, direction));
    }
  }
  std::ranges::sort(beside);
  beside.erase(std::unique(beside.begin(), beside.end()), beside.end());
  std::vector<base::Cell> free;
  std::set_difference(beside.begin(), beside.end(), taken.begin(), taken.end(),
                      std::back_inserter(free));
  const model::ObstacleIndex obstacles(spec.obstacles);
  std::erase_if(free, [&](const base::Cell& cell) {
    return obstacles.find(cell) != model::CellIndex::kNone;
  });
  return free;
}

verdict::Assessment first_look(const model::Robot& robot) { return plan::first_look(robot); }

std::vector<Trial> try_cells(const model::RobotSpec& spec, std::span<const base::Cell> cells,
                             Role role, const CheckOptions& options) {
  std::vector<Trial> trials;
  trials.reserve(cells.size());
  for (const base::Cell& cell : cells) {
    model::RobotSpec grown = spec;
    add_module(grown, cell, role);
    const auto robot = model::Robot::create(grown, options.thread_count);
    Trial& trial = trials.emplace_back(Trial{.cell = cell});
    if (!robot) {
      continue;
    }
    const verdict::Assessment assessment = try_robot(robot.value(), options);
    trial.is_robot = true;
    trial.verdict = assessment.verdict;
    trial.load_ratio_max = assessment.load_ratio_max;
    trial.margin_mm = assessment.simplified.margin_mm;
  }
  return trials;
}

}  // namespace holdfast
