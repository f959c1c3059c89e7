// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "holdfast/plan/module_moves.hpp"

#include <algorithm>
#include <set>
#include <span>

#include "holdfast/plan/transition.hpp"
#include "way.hpp"

namespace holdfast::plan {
namespace {

using base::Cell;
using base::Direction;

/// The moves of one module. Keeps references.
class MoveFinder {
 public:
  MoveFinder(const RobotState& robot, std::int32_t module, const MoveRule& rule)
      : robot_(robot),
        lattice_(robot.lattice()),
        rule_(rule),
        from_(robot.module(module).cell),
        axial_(base::axial_of(lattice_, from_)) {}

  std::vector<model::Move> find() {
    for (const Cell& along : steps()) {
      if (is_open(sum(axial_, along)) && (!rule_.pivots || can_roll(along))) {
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
    return robot_.find(cell) == RobotState::kNone && (!rule_.floor_z || cell.z >= *rule_.floor_z) &&
           robot_.obstacles().find(cell) == model::CellIndex::kNone;
  }

  bool is_module(const Cell& axial) const {
    return robot_.find(base::cell_of(lattice_, axial)) != RobotState::kNone;
  }

  /// Whether a cube can turn by a quarter over two modules in a row.
  bool can_roll(const Cell& along) const {
    return std::ranges::any_of(steps(), [&](const Cell& away) {
      const Cell carrier = difference(axial_, away);
      return is_module(carrier) && is_module(sum(carrier, along)) && is_free(sum(axial_, away)) &&
             is_free(sum(sum(axial_, away), along));
    });
  }

  /// Whether a cube can turn by a half about the edge of its carrier.
  bool can_turn(const Cell& away, const Cell& along) const {
    const Cell beyond = sum(axial_, sum(along, along));
    return is_free(sum(axial_, away)) && is_free(sum(sum(axial_, away), along)) &&
           is_free(beyond) && is_free(difference(beyond, away));
  }

  void add_turns(const Cell& carrier) {
    const Cell centre = base::axial_of(lattice_, carrier);
    const Cell away = difference(axial_, centre);
    for (const Cell& along : steps()) {
      const Cell way = difference(along, away);
      const bool is_slide = way == Cell{} || std::ranges::find(steps(), way) != steps().end();
      if (is_slide || !is_open(sum(axial_, along)) || !is_open(sum(centre, along)) ||
          (rule_.pivots && !can_turn(away, along))) {
        continue;
      }
      const Cell to = base::cell_of(lattice_, sum(centre, along));
      if (!arrivals_.contains(to) && !add({.from = from_, .to = to, .carrier = {}})) {
        add({.from = from_, .to = to, .carrier = carrier});
      }
    }
  }

  /// To the neighbours, axial.
  std::span<const Cell> steps() const {
    return std::span(lattice_.steps).first(base::at(lattice_.direction_count));
  }

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
  const base::Lattice& lattice_;
  const MoveRule& rule_;
  Cell from_;
  Cell axial_;
  std::vector<model::Move> moves_;
  std::set<Cell> arrivals_;  ///< Of moves without a named carrier.
};

/// Cut vertices of the graph of modules.
class CutVertices {
 public:
  explicit CutVertices(const RobotState& robot)
      : robot_(robot), order_(robot.modules().size()), low_(order_.size()), is_cut_(order_.size()) {
    const auto modules = robot.modules();
    const auto root = std::ranges::find(modules, true, &ModuleState::is_there);
    if (root != modules.end()) {
      walk(static_cast<std::int32_t>(root - modules.begin()));
    }
  }

  bool contains(std::size_t module) const { return is_cut_[module]; }

 private:
  struct Visit {
    std::int32_t module = 0;
    std::int32_t parent = RobotState::kNone;
    int direction = 0;  ///< The next to look in.
    int child_count = 0;
  };

  void enter(std::int32_t module, std::int32_t parent) {
    order_[base::at(module)] = low_[base::at(module)] = ++count_;
    stack_.push_back({.module = module, .parent = parent});
  }

  void walk(std::int32_t root) {
    enter(root, RobotState::kNone);
    while (!stack_.empty()) {
      Visit& visit = stack_.back();
      if (visit.direction < robot_.lattice().direction_count) {
        look(visit, static_cast<Direction>(visit.direction++));
        continue;
      }
      const Visit done = visit;
      stack_.pop_back();
      if (stack_.empty()) {
        is_cut_[base::at(done.module)] = done.child_count > 1;
      } else {
        leave(done);
      }
    }
  }

  void look(Visit& visit, Direction direction) {
    const Cell& cell = robot_.module(visit.module).cell;
    const Cell next = base::neighbour(robot_.lattice(), cell, direction);
    const std::int32_t other = robot_.find(next);
    if (other == RobotState::kNone || other == visit.parent || !robot_.are_connected(cell, next)) {
      return;
    }
    std::int32_t& low = low_[base::at(visit.module)];
    if (order_[base::at(other)] != 0) {
      low = std::min(low, order_[base::at(other)]);
    } else {
      ++visit.child_count;
      enter(other, visit.module);
    }
  }

  void leave(const Visit& done) {
    const Visit& parent = stack_.back();
    std::int32_t& low = low_[base::at(parent.module)];
    low = std::min(low, low_[base::at(done.module)]);
    if (parent.parent != RobotState::kNone &&
        low_[base::at(done.module)] >= order_[base::at(parent.module)]) {
      is_cut_[base::at(parent.module)] = true;
    }
  }

  const RobotState& robot_;
  std::vector<std::int32_t> order_;  ///< By module; 0: not visited.
  std::vector<std::int32_t> low_;
  std::vector<bool> is_cut_;
  std::vector<Visit> stack_;
  std::int32_t count_ = 0;
};

}  // namespace

std::vector<std::int32_t> loose_modules(const RobotState& robot) {
  const CutVertices cuts(robot);
  std::vector<std::int32_t> loose;
  const auto modules = robot.modules();
  for (std::size_t i = 0; i < modules.size(); ++i) {
    if (modules[i].is_there && !modules[i].is_fixed && !cuts.contains(i)) {
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
