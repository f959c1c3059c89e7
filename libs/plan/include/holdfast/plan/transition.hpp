// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "holdfast/base/result.hpp"
#include "holdfast/model/step.hpp"
#include "holdfast/plan/robot_state.hpp"

/// What a step does to a robot: which modules go together, along which cells, and what carries
/// them.
namespace holdfast::plan {

/// The stages of a step ([Piranda 2021] Sec. II-B), in their order.
enum class Stage : std::uint8_t { kRelease, kShift, kConnect };

inline constexpr int kStageCount = 3;

/// "release", "shift", "connect".
const char* name(Stage stage);

/// Modules that move as one rigid body: moves of one step whose modules are connected and go the
/// same way.
///
/// A group goes to neighbouring cells (a slide), or over one cell between (a convex corner turn).
/// It is supported by its carriers: those that its moves name, on its whole way; if they name none
/// - in a slide, every module that touches a moved one before and after, and every pair of modules
///   one behind the other in the direction of the move, the first of which touches it before and
///   the second after: the first carries it at the start, the second at the end, both between;
/// - in a turn, the modules that touch a moved one before and after, opposite to the free cell
///   between.
struct Group {
  std::vector<base::Cell> from;  ///< By module.
  std::vector<base::Cell> to;
  /// Twice the way that the group has gone, axial coordinates, by waypoint: start, the middle
  /// between consecutive cells, cells, end.
  std::vector<base::Cell> way;
  std::vector<std::vector<base::Cell>> carriers;  ///< By waypoint, one or more.
};

/// A step that can be done.
struct Transition {
  std::vector<Group> groups;

  /// The most of any group, 0 without groups. All go half a cell at a time; who arrives first
  /// waits.
  std::size_t waypoint_count() const;

  /// Cells that are empty on the way: where moved modules were, and detached ones.
  std::vector<base::Cell> left;
};

/// What a step does to a robot. Errors, each beginning with the stage: what is released is not
/// connected, or what is connected no pair of released neighbours; a module is moved or detached
/// that is not there, is fixed, or twice; a cell on the way, or one to attach at, is occupied; the
/// way leads below the floor, though no module of the robot is there before or after; a move has no
/// carrier, or its carrier does not reach that far, or there are several ways.
base::Result<Transition> find_transition(const RobotState& robot, const model::Step& step);

/// The robot after a step whose transition is this.
void apply(const model::Step& step, const Transition& transition, RobotState& robot);

}  // namespace holdfast::plan
