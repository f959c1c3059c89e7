// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "holdfast/plan/module_moves.hpp"

#include <algorithm>
#include <set>
#include <span>

#include "cut_vertices.hpp"
#include "holdfast/plan/transition.hpp"
#include "moves/rolling.hpp"
#include "steps/way.hpp"

namespace holdfast::plan {
namespace {

using base::Cell;
using base::Direction;

/// Rounding of heights, in pitches.
constexpr double kTouching = 1e-9;

/// The moves of one module. Keeps references.
class MoveFinder {
 public:
  MoveFinder(const RobotState& robot, std::int32_t module, const MoveRule& rule)
      : robot_(robot),
        lattice_(base::unstretched(robot.lattice())),
        rule_(rule),
        from_(robot.module(module).cell),
        axial_(base::axial_of(lattice_, from_)) {}

  std::vector<model::Move> find() {
    for (const Cell& along : steps()) {
      if (is_open(sum(axial_, along)) && can_step(along)) {
        add({.from = from_, .to = base::cell_of(lattice_, sum(axial_, along)), .carrier = {}});
      }
    }
    for (const Direction side : base::directions(lattice_)) {
      const Cell carrier = base::neighbour(lattice_, from_, side);
      if (robot_.find(carrier) != RobotState::kNone) {
        add_turns(carrier);
      }
    }
    return std::move(moves_);
  }

 private:
  /// Whether a module may be in a cell, axial.
  bool is_open(const Cell& axial) const {
    const Cell cell = base::cell_of(lattice_, axial);
    return is_free(axial) && (!rule_.within || rule_.within->contains(cell));
  }

  /// Whether a module may sweep a cell, axial.
  bool is_free(const Cell& axial) const {
    const Cell cell = base::cell_of(lattice_, axial);
    return !is_taken(axial) && (!rule_.floor_z || cell.z >= *rule_.floor_z);
  }

  /// Whether a module or an obstacle is in a cell, axial.
  bool is_taken(const Cell& axial) const {
    const Cell cell = base::cell_of(lattice_, axial);
    return robot_.find(cell) != RobotState::kNone ||
           robot_.obstacles().find(cell) != model::CellIndex::kNone;
  }

  bool is_module(const Cell& axial) const {
    return robot_.find(base::cell_of(lattice_, axial)) != RobotState::kNone;
  }

  bool is_step(const Cell& axial) const {
    return std::ranges::find(steps(), axial) != steps().end();
  }

  /// Whether a module's body gets into the next cell.
  bool can_step(const Cell& along) const {
    if (lattice_ == base::kCubic) {
      return !rule_.pivots || can_pivot(along);
    }
    const Cell to = sum(axial_, along);
    const auto is_beside = [&](const Cell& away) {
      const Cell other = difference(axial_, away);
      return is_taken(other) && is_step(difference(to, other)) && rolls(to, other);
    };
    if (lattice_ == base::kHexagonalPrism && std::ranges::none_of(steps(), is_beside)) {
      return true;
    }
    return std::ranges::any_of(steps(), [&](const Cell& away) {
      const Cell carrier = difference(axial_, away);
      return is_beside(away) && is_module(carrier) && can_roll(to, carrier);
    });
  }

  /// Whether the way to a cell about a neighbour is that of a ball or disc. Prisms slide up, down
  /// and over each other. In their layer they come through the places of a disc that rolls about
  /// the same carrier, a third of a turn about a corner from one to the next.
  bool rolls(const Cell& to, const Cell& carrier) const {
    return lattice_ != base::kHexagonalPrism || (to.z == axial_.z && carrier.z == axial_.z);
  }

  /// Whether a ball, or a disc, can roll to a cell, axial, about a carrier that both cells touch,
  /// alone or with another such module, without coming nearer than a pitch to anybody else.
  bool can_roll(const Cell& to, const Cell& carrier) const {
    const auto alone = RollingArc::about(lattice_, axial_, to, carrier);
    if (alone && is_above_floor(*alone) && !is_barred(*alone, carrier)) {
      return true;
    }
    // A disc does not leave its plane.
    return lattice_ == base::kFaceCentred && std::ranges::any_of(steps(), [&](const Cell& away) {
             const Cell second = difference(axial_, away);
             return second != carrier && is_module(second) && is_step(difference(to, second)) &&
                    (can_roll_along(to, carrier, second) || can_roll_along(to, second, carrier));
           });
  }

  bool can_roll_along(const Cell& to, const Cell& first, const Cell& second) const {
    const RollingArc arc = RollingArc::about(lattice_, axial_, to, first, second);
    return is_above_floor(arc) && !is_barred(arc, first) && !is_barred(arc, second);
  }

  bool is_above_floor(const RollingArc& arc) const {
    return !rule_.floor_z ||
           arc.lowest() > base::node_place(lattice_, {0, 0, *rule_.floor_z})[2] - kTouching;
  }

  /// Whether the corner of a prism that turns in its layer sweeps somebody beyond the carrier's
  /// neighbour in a direction: its outermost corner is 2 / sqrt(3) pitches from the one that it
  /// turns about, so it reaches into the cells behind each place that it comes through.
  bool is_swept_by_corner(const RollingArc& arc, const Cell& carrier, const Cell& away) const {
    const Cell near = sum(carrier, away);
    return lattice_ == base::kHexagonalPrism && away.z == 0 && is_taken(sum(near, away)) &&
           arc.sweeps(base::place_of<double>(lattice_, near));
  }

  /// Whether somebody within two steps of a carrier is in the way; further away nobody is.
  bool is_barred(const RollingArc& arc, const Cell& carrier) const {
    const auto bars = [&](const Cell& axial) {
      return axial != axial_ && is_taken(axial) &&
             arc.sweeps(base::place_of<double>(lattice_, axial));
    };
    return std::ranges::any_of(steps(), [&](const Cell& first) {
      const Cell near = sum(carrier, first);
      return bars(near) || is_swept_by_corner(arc, carrier, first) ||
             std::ranges::any_of(steps(),
                                 [&](const Cell& second) { return bars(sum(near, second)); });
    });
  }

  /// Whether a cube can turn by a quarter over two modules in a row.
  bool can_pivot(const Cell& along) const {
    const Cell back = difference({}, along);
    return std::ranges::any_of(steps(), [&](const Cell& away) {
      const Cell carrier = difference(axial_, away);
      return away != along && away != back && is_module(carrier) &&
             is_module(sum(carrier, along)) && is_free(sum(axial_, away)) &&
             is_free(sum(sum(axial_, away), along));
    });
  }

  /// Whether a module's body gets around a carrier.
  bool can_turn(const Cell& carrier, const Cell& along) const {
    if (lattice_ == base::kCubic) {
      return !rule_.pivots || can_pivot_around(difference(axial_, carrier), along);
    }
    const Cell to = sum(carrier, along);
    return !rolls(to, carrier) || can_roll(to, carrier);
  }

  /// Whether a cube can turn by a half about the edge of its carrier.
  bool can_pivot_around(const Cell& away, const Cell& along) const {
    const Cell beyond = sum(axial_, sum(along, along));
    return is_free(sum(axial_, away)) && is_free(sum(sum(axial_, away), along)) &&
           is_free(beyond) && is_free(difference(beyond, away));
  }

  void add_turns(const Cell& carrier) {
    const Cell centre = base::axial_of(lattice_, carrier);
    const Cell away = difference(axial_, centre);
    for (const Cell& along : steps()) {
      const Cell way = difference(along, away);
      const bool is_slide = way == Cell{} || is_step(way);
      if (is_slide || !is_open(sum(axial_, along)) || !is_open(sum(centre, along)) ||
          !can_turn(centre, along)) {
        continue;
      }
      const Cell to = base::cell_of(lattice_, sum(centre, along));
      if (!arrivals_.contains(to) && !add({.from = from_, .to = to, .carrier = {}})) {
        add({.from = from_, .to = to, .carrier = carrier});
      }
    }
  }

  std::span<const Cell> steps() const { return steps_of(lattice_); }

  bool add(const model::Move& move) {
    model::Step step;
    step.moves = {move};
    if (!find_transition(robot_, step)) {
      return false;
    }
    if (!move.carrier) {
      arrivals_.insert(move.to);
    }
    moves_.push_back(move);
    return true;
  }

  const RobotState& robot_;
  base::Lattice lattice_;  ///< How modules move does not depend on the lengths of their sides.
  const MoveRule& rule_;
  Cell from_;
  Cell axial_;
  std::vector<model::Move> moves_;
  std::set<Cell> arrivals_;  ///< Of moves without a named carrier.
};

}  // namespace

std::vector<std::int32_t> loose_modules(const RobotState& robot) {
  std::vector<std::int32_t> loose;
  const auto modules = robot.modules();
  const auto root = std::ranges::find(modules, true, &ModuleState::is_there);
  if (root == modules.end()) {
    return loose;
  }
  const std::vector<bool> is_cut = cut_vertices(
      modules.size(), static_cast<std::int32_t>(root - modules.begin()),
      base::at(robot.lattice().direction_count), [&](std::int32_t module, std::size_t direction) {
        const Cell& cell = robot.module(module).cell;
        const Cell next = base::neighbour(robot.lattice(), cell, static_cast<Direction>(direction));
        const std::int32_t other = robot.find(next);
        return other != RobotState::kNone && robot.are_connected(cell, next) ? other
                                                                             : RobotState::kNone;
      });
  for (std::size_t i = 0; i < modules.size(); ++i) {
    if (modules[i].is_there && !modules[i].is_fixed && !is_cut[i]) {
      loose.push_back(static_cast<std::int32_t>(i));
    }
  }
  return loose;
}

std::vector<model::Move> moves_of(const RobotState& robot, std::int32_t module,
                                  const MoveRule& rule) {
  return MoveFinder(robot, module, rule).find();
}

}  // namespace holdfast::plan
