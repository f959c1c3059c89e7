// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "holdfast/plan/transition.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>
#include <set>
#include <string>
#include <utility>

#include "steps/way.hpp"

namespace holdfast::plan {
namespace {

using base::Cell;
using model::Move;
using model::text;

using Fault = std::optional<std::string>;

std::string pair_text(const model::CellPair& pair) { return text(pair[0]) + "-" + text(pair[1]); }

std::string move_text(const Move& move) { return text(move.from) + " to " + text(move.to); }

/// Whether a cell occurs once more in `seen`, which it is added to.
bool is_seen(std::set<Cell>& seen, const Cell& cell) { return !seen.insert(cell).second; }

Fault find_release_fault(const RobotState& robot, const model::Step& step) {
  std::set<model::CellPair> seen;
  for (const model::CellPair& pair : step.release) {
    if (!robot.are_connected(pair[0], pair[1]) || !seen.insert(ordered(pair)).second) {
      return fmt::format(
          "{} cannot be released, as it is not connected; expected pairs of connected modules, "
          "each once",
          pair_text(pair));
    }
  }
  return std::nullopt;
}

Fault find_departure_fault(const RobotState& robot, const model::Step& step) {
  std::set<Cell> seen;
  for (const Cell& cell : step.detach) {
    if (robot.find(cell) == RobotState::kNone || is_seen(seen, cell)) {
      return fmt::format(
          "no module can be detached at {}: {}", text(cell),
          robot.find(cell) == RobotState::kNone ? "none is there" : "it is detached twice");
    }
  }
  for (const Move& move : step.moves) {
    const std::int32_t module = robot.find(move.from);
    const char* fault = module == RobotState::kNone     ? "no module is there"
                        : is_seen(seen, move.from)      ? "it moves or is detached already"
                        : robot.module(module).is_fixed ? "that module is fixed"
                                                        : nullptr;
    if (fault != nullptr) {
      return fmt::format("no module can move from {}: {}", move_text(move), fault);
    }
  }
  return std::nullopt;
}

/// Moves that make one body, by index, each list ascending; lists by their first move.
std::vector<std::vector<std::size_t>> bodies_of(const RobotState& robot, const model::Step& step) {
  const std::vector<Move>& moves = step.moves;
  std::vector<std::size_t> parent(moves.size());
  std::iota(parent.begin(), parent.end(), 0);
  const auto root = [&](std::size_t i) {
    while (parent[i] != i) {
      i = parent[i];
    }
    return i;
  };
  const auto translation = [&](const Move& move) {
    return difference(base::axial_of(robot.lattice(), move.to),
                      base::axial_of(robot.lattice(), move.from));
  };
  const std::set<model::CellPair> loose = [&] {
    std::set<model::CellPair> pairs;
    for (const model::CellPair& pair : step.release) {
      pairs.insert(ordered(pair));
    }
    return pairs;
  }();
  for (std::size_t i = 0; i < moves.size(); ++i) {
    for (std::size_t k = 0; k < i; ++k) {
      const std::size_t a = root(i);
      const std::size_t b = root(k);
      if (a != b && translation(moves[i]) == translation(moves[k]) &&
          robot.are_connected(moves[i].from, moves[k].from) &&
          !loose.contains(ordered({moves[i].from, moves[k].from}))) {
        parent[std::max(a, b)] = std::min(a, b);
      }
    }
  }
  std::vector<std::vector<std::size_t>> bodies(moves.size());
  for (std::size_t i = 0; i < moves.size(); ++i) {
    bodies[root(i)].push_back(i);
  }
  std::erase_if(bodies, [](const auto& body) { return body.empty(); });
  return bodies;
}

/// Whether cells on the way of several groups are one, or are not free.
Fault find_collision(const RobotState& robot, const Transition& transition) {
  std::set<Cell> passed;
  for (const Group& group : transition.groups) {
    std::set<Cell> own;
    for (std::size_t i = 2; i < group.way.size(); i += 2) {
      for (const Cell& from : group.from) {
        own.insert(moved(robot.lattice(), from, group.way[i]));
      }
    }
    for (const Cell& cell : own) {
      if (is_seen(passed, cell)) {
        return fmt::format("two groups that move at once pass through {}", text(cell));
      }
    }
  }
  return std::nullopt;
}

base::Result<Transition> find_ways(const RobotState& robot, const model::Step& step) {
  Transition transition;
  transition.left = step.detach;
  for (const Move& move : step.moves) {
    transition.left.push_back(move.from);
  }
  const WayFinder finder(robot, step, transition.left);
  for (const auto& body : bodies_of(robot, step)) {
    auto group = finder.find(body);
    if (!group) {
      return group.error();
    }
    transition.groups.push_back(std::move(group).value());
  }
  return transition;
}

/// What is wrong with modules that arrive and with pairs that are connected.
Fault find_arrival_fault(const RobotState& robot, const model::Step& step,
                         const Transition& transition) {
  std::set<Cell> gone(transition.left.begin(), transition.left.end());
  std::set<Cell> taken;
  for (const Group& group : transition.groups) {
    taken.insert(group.to.begin(), group.to.end());
  }
  for (const Cell& cell : step.attach) {
    const bool is_occupied =
        (robot.find(cell) != RobotState::kNone && !gone.contains(cell)) || is_seen(taken, cell);
    const bool is_obstacle = robot.obstacles().find(cell) != model::CellIndex::kNone;
    if (is_occupied || is_obstacle) {
      return fmt::format("no module can be attached at {}: {} there, expected free cells",
                         text(cell), is_obstacle ? "an obstacle is" : "a module is");
    }
  }
  std::set<model::CellPair> seen;
  for (const model::CellPair& pair : step.connect) {
    const bool is_released =
        robot.released().contains(ordered(pair)) ||
        std::ranges::any_of(step.release, [&](const model::CellPair& released) {
          return ordered(released) == ordered(pair);
        });
    if (!is_released || gone.contains(pair[0]) || gone.contains(pair[1]) ||
        !seen.insert(ordered(pair)).second) {
      return fmt::format(
          "{} cannot be connected; expected neighbours that were released before, each once",
          pair_text(pair));
    }
  }
  return std::nullopt;
}

}  // namespace

base::Error fault_in(Stage stage, const std::string& message) {
  return {.code = base::ErrorCode::kBadInput,
          .message = fmt::format("{}: {}", name(stage), message),
          .where = {}};
}

const char* name(Stage stage) {
  switch (stage) {
    case Stage::kRelease:
      return "release";
    case Stage::kShift:
      return "shift";
    case Stage::kConnect:
      break;
  }
  return "connect";
}

std::size_t Transition::waypoint_count() const {
  std::size_t count = 0;
  for (const Group& group : groups) {
    count = std::max(count, group.way.size());
  }
  return count;
}

base::Result<Transition> find_transition(const RobotState& robot, const model::Step& step) {
  auto fault = find_release_fault(robot, step);
  fault = fault ? fault : find_departure_fault(robot, step);
  if (fault) {
    return fault_in(Stage::kRelease, *fault);
  }
  auto ways = find_ways(robot, step);
  if (!ways) {
    return fault_in(Stage::kShift, ways.error().message);
  }
  fault = find_collision(robot, ways.value());
  if (fault) {
    return fault_in(Stage::kShift, *fault);
  }
  fault = find_arrival_fault(robot, step, ways.value());
  if (fault) {
    return fault_in(Stage::kConnect, *fault);
  }
  return ways;
}

void apply(const model::Step& step, const Transition& transition, RobotState& robot) {
  for (const model::CellPair& pair : step.release) {
    robot.release(pair);
  }
  for (const Cell& cell : step.detach) {
    robot.remove(cell);
  }
  for (const Group& group : transition.groups) {
    robot.move(group.from, group.to);
  }
  for (const model::CellPair& pair : step.connect) {
    robot.connect(pair);
  }
  for (const Cell& cell : step.attach) {
    const auto kind = std::ranges::find(step.own_kinds, cell, &model::OwnKind::cell);
    const auto mass = std::ranges::find(step.own_masses, cell, &model::OwnMass::cell);
    ModuleState added{.cell = cell};
    if (kind != step.own_kinds.end()) {
      added.kind = kind->kind;
    }
    if (mass != step.own_masses.end()) {
      added.own_mass_kg = mass->mass_kg;
    }
    for (const model::Payload& payload : step.payloads) {
      if (payload.cell == cell) {
        add_payload(payload, added);
      }
    }
    robot.add(added);
  }
}

}  // namespace holdfast::plan
