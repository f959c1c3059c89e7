// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "holdfast/base/result.hpp"
#include "holdfast/model/cell_index.hpp"
#include "holdfast/model/step.hpp"
#include "holdfast/plan/cell_box.hpp"
#include "holdfast/plan/motions.hpp"
#include "holdfast/plan/robot_state.hpp"
#include "holdfast/plan/transition.hpp"

/// Where single modules of a robot can go in one step.
namespace holdfast::plan {

/// What bars a module's way besides modules and obstacles.
struct MoveRule {
  /// The motions of the modules, of their lattice; without them those of its own body.
  std::shared_ptr<const Motions> motions = {};
  /// No module goes below; none: there is nothing that bars it.
  std::optional<std::int32_t> floor_z = {};
  /// No module leaves it.
  std::optional<CellBox> within = {};
  /// Cells that no module enters or sweeps, and that carry nothing.
  model::CellIndex avoid{0};
};

/// The modules without which all others are still one piece, and which stay neither as they are
/// fixed nor as they are kept: indices, ascending. By lowest points of a depth-first search [Tarjan
/// 1972].
std::vector<std::int32_t> loose_modules(const RobotState& robot);

/// Every move of one module that find_transition() takes and the rule allows, slides first. A
/// carrier is named only where there is more than one way around a corner.
std::vector<model::Move> moves_of(const RobotState& robot, std::int32_t module,
                                  const MoveRule& rule);

/// What bars one of the moves of a step with this transition: it is none of moves_of() with these
/// motions, or part of a body of several modules, of which motions say nothing. Each move is looked
/// at as if the others came later.
std::optional<base::Error> find_barred_move(const RobotState& robot, const model::Step& step,
                                            const Transition& transition,
                                            const std::shared_ptr<const Motions>& motions);

}  // namespace holdfast::plan
