// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "holdfast/plan/module_moves.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <span>

#include "barring_floor.hpp"
#include "cut_vertices.hpp"
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
    if (is_barred_between(axial_)) {
      return {};
    }
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

  /// Whether a module or an obstacle is in a cell, axial, or it is to be avoided.
  bool is_taken(const Cell& axial) const {
    const Cell cell = base::cell_of(lattice_, axial);
    return robot_.find(cell) != RobotState::kNone ||
           robot_.obstacles().find(cell) != model::CellIndex::kNone ||
           rule_.avoid.find(cell) != model::CellIndex::kNone;
  }

  bool is_module(const Cell& axial) const {
    return robot_.find(base::cell_of(lattice_, axial)) != RobotState::kNone;
  }

  bool is_step(const Cell& axial) const {
    return std::ranges::find(steps(), axial) != steps().end();
  }

  /// Whether a module's body gets into the next cell.
  bool can_step(const Cell& along) const {
    if (has_motions()) {
      return has_motion(along, std::nullopt);
    }
    if (lattice_ == base::kCubic) {
      return true;
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

  /// Whether one of the motions leads so far, along `carrier` if one is given, relative to here.
  bool has_motion(const Cell& way, const std::optional<Cell>& carrier) const {
    return std::ranges::any_of(rule_.motions->motions, [&](const Motion& motion) {
      return motion.to == way &&
             (!carrier || std::ranges::find(motion.modules, *carrier) != motion.modules.end()) &&
             std::ranges::all_of(motion.modules,
                                 [&](const Cell& cell) { return is_module(sum(axial_, cell)); }) &&
             std::ranges::all_of(motion.free,
                                 [&](const Cell& cell) { return is_free(sum(axial_, cell)); });
    });
  }

  bool has_motions() const { return rule_.motions && !rule_.motions->motions.empty(); }

  /// Whether a cell, axial, is barred as it is between two other modules on opposite sides of it.
  bool is_barred_between(const Cell& axial) const {
    return rule_.motions && !rule_.motions->goes_between &&
           std::ranges::any_of(steps(), [&](const Cell& away) {
             const Cell one = sum(axial, away);
             const Cell other = difference(axial, away);
             return one != axial_ && other != axial_ && is_module(one) && is_module(other);
           });
  }

  /// Whether a module's body gets around a carrier.
  bool can_turn(const Cell& carrier, const Cell& along) const {
    const Cell to = sum(carrier, along);
    if (has_motions()) {
      return has_motion(difference(to, axial_), difference(carrier, axial_));
    }
    return lattice_ == base::kCubic || !rolls(to, carrier) || can_roll(to, carrier);
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
    if (is_barred_between(base::axial_of(lattice_, move.to))) {
      return false;
    }
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
    if (modules[i].is_there && !modules[i].stays() && !is_cut[i]) {
      loose.push_back(static_cast<std::int32_t>(i));
    }
  }
  return loose;
}

std::vector<model::Move> moves_of(const RobotState& robot, std::int32_t module,
                                  const MoveRule& rule) {
  return MoveFinder(robot, module, rule).find();
}

std::optional<base::Error> find_barred_move(const RobotState& robot, const model::Step& step,
                                            const Transition& transition,
                                            const std::shared_ptr<const Motions>& motions) {
  std::vector<Cell> there;
  for (const ModuleState& module : robot.modules()) {
    if (module.is_there) {
      there.push_back(module.cell);
    }
  }
  const MoveRule rule = {.motions = motions,
                         .floor_z = barring_floor(robot.surroundings().support_z, there)};
  for (const Group& group : transition.groups) {
    if (group.from.size() > 1) {
      return base::bad_input(
          fmt::format("{} modules move as one body from {} on; motions are those of one module",
                      group.from.size(), model::text(group.from.front())));
    }
  }
  for (const model::Move& move : step.moves) {
    const std::vector<model::Move> allowed = moves_of(robot, robot.find(move.from), rule);
    const bool is_allowed = std::ranges::any_of(allowed, [&](const model::Move& each) {
      return each.to == move.to && (!move.carrier || !each.carrier || each.carrier == move.carrier);
    });
    if (!is_allowed) {
      return base::bad_input(fmt::format("no motion leads from {} to {}", model::text(move.from),
                                         model::text(move.to)));
    }
  }
  return std::nullopt;
}

}  // namespace holdfast::plan
