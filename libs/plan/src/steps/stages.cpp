// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "holdfast/plan/stages.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>
#include <set>
#include <string>

#include "holdfast/model/connected_parts.hpp"
#include "steps/way.hpp"

namespace holdfast::plan {
namespace {

using base::Cell;
using model::text;
using Pieces = std::vector<std::vector<std::int32_t>>;

/// Modules by index, as far as they are connected; each list ascending, lists by their first.
/// Without the connections in `more`.
Pieces pieces_of(const RobotState& robot, const std::set<Cell>& gone,
                 const std::set<model::CellPair>& more) {
  const auto modules = robot.modules();
  const auto is_in = [&](std::int32_t module) {
    const auto& one = modules[static_cast<std::size_t>(module)];
    return one.is_there && !gone.contains(one.cell);
  };
  model::ConnectedParts parts(modules.size());
  for (std::int32_t i = 0; i < static_cast<std::int32_t>(modules.size()); ++i) {
    const Cell& cell = robot.module(i).cell;
    for (const base::Direction direction : base::directions(robot.lattice())) {
      const std::int32_t other = is_in(i)
                                     ? robot.find(base::neighbour(robot.lattice(), cell, direction))
                                     : RobotState::kNone;
      if (other == RobotState::kNone || other < i || !is_in(other)) {
        continue;
      }
      const model::CellPair pair = ordered({cell, robot.module(other).cell});
      if (!robot.released().contains(pair) && !more.contains(pair)) {
        parts.join(i, other);
      }
    }
  }
  Pieces pieces = parts.lists();
  std::erase_if(pieces, [&](const auto& piece) { return !is_in(piece.front()); });
  return pieces;
}

bool touches_obstacle(const RobotState& robot, const Cell& cell) {
  for (const base::Direction direction : base::directions(robot.lattice())) {
    if (robot.obstacles().find(base::neighbour(robot.lattice(), cell, direction)) !=
        model::CellIndex::kNone) {
      return true;
    }
  }
  return false;
}

/// Whether a floor, an obstacle or being fixed holds one of the modules.
bool is_supported(const RobotState& robot, std::span<const std::int32_t> piece) {
  const model::RobotSpec& around = robot.surroundings();
  return std::ranges::any_of(piece, [&](std::int32_t index) {
    const ModuleState& module = robot.module(index);
    if (module.is_fixed || (around.support_z && module.cell.z == *around.support_z)) {
      return true;
    }
    return !around.obstacles.empty() && touches_obstacle(robot, module.cell);
  });
}

/// The robot's pieces, each of which something holds.
base::Result<Pieces> supported_pieces(const RobotState& robot, Stage stage,
                                      const std::set<Cell>& gone,
                                      const std::set<model::CellPair>& more) {
  Pieces pieces = pieces_of(robot, gone, more);
  for (const auto& piece : pieces) {
    if (!is_supported(robot, piece)) {
      const std::string modules = piece.size() == 1
                                      ? "the module " + text(robot.module(piece.front()).cell)
                                      : fmt::format("{} modules, {} among them,", piece.size(),
                                                    text(robot.module(piece.front()).cell));
      return fault_in(stage, pieces.size() == 1
                                 ? "nothing holds the robot any more"
                                 : fmt::format("the robot is in {} pieces, and nothing holds {} "
                                               "any more",
                                               pieces.size(), modules));
    }
  }
  if (pieces.empty()) {
    return fault_in(stage, "no module is left");
  }
  return pieces;
}

std::vector<model::RobotSpec> specs_of(const RobotState& robot, const Pieces& pieces,
                                       const std::set<model::CellPair>& more) {
  const std::vector<model::CellPair> released(more.begin(), more.end());
  std::vector<model::RobotSpec> specs;
  for (const auto& piece : pieces) {
    specs.push_back(robot.spec(piece, released));
  }
  return specs;
}

base::Result<std::vector<Scene>> one_scene(const RobotState& robot, Stage stage,
                                           const std::set<model::CellPair>& more) {
  auto pieces = supported_pieces(robot, stage, {}, more);
  if (!pieces) {
    return pieces.error();
  }
  Scene scene;
  scene.pieces = specs_of(robot, pieces.value(), more);
  return std::vector<Scene>{std::move(scene)};
}

std::set<model::CellPair> released_by(const model::Step& step) {
  std::set<model::CellPair> released;
  for (const model::CellPair& pair : step.release) {
    released.insert(ordered(pair));
  }
  return released;
}

/// The carriers of a group at a waypoint, at its last one if it has arrived.
const std::vector<Cell>& carriers_at(const Group& group, std::size_t waypoint) {
  return group.carriers[std::min(waypoint, group.carriers.size() - 1)];
}

/// A scene for every choice of one carrier for each group.
std::vector<Scene> scenes_at(const RobotState& before, const Transition& transition,
                             std::size_t waypoint, const Pieces& pieces,
                             const std::vector<model::RobotSpec>& specs) {
  std::size_t count = 1;
  for (const Group& group : transition.groups) {
    count *= carriers_at(group, waypoint).size();
  }
  const auto piece_of = [&](const Cell& carrier) {
    const auto found = std::ranges::find_if(pieces, [&](const auto& piece) {
      return std::ranges::binary_search(piece, before.find(carrier));
    });
    return static_cast<std::size_t>(found - pieces.begin());
  };
  std::vector<Scene> scenes;
  for (std::size_t choice = 0; choice < count; ++choice) {
    Scene scene;
    scene.waypoint = waypoint;
    scene.pieces = specs;
    std::size_t rest = choice;
    for (const Group& group : transition.groups) {
      const std::vector<Cell>& carriers = carriers_at(group, waypoint);
      const Cell& carrier = carriers[rest % carriers.size()];
      rest /= carriers.size();
      const std::size_t here = std::min(waypoint, group.way.size() - 1);
      scene.hangings.push_back(hanging_on(before, group, here, carrier));
      hang(before, group, here, carrier, scene.pieces[piece_of(carrier)]);
    }
    scenes.push_back(std::move(scene));
  }
  return scenes;
}

/// The number of a stage's scenes; more than kSceneMax if there are too many.
std::size_t scene_count(const Transition& transition) {
  std::size_t count = 0;
  for (std::size_t waypoint = 0; waypoint < transition.waypoint_count(); ++waypoint) {
    std::size_t here = 1;
    for (const Group& group : transition.groups) {
      here = std::min(here * carriers_at(group, waypoint).size(), kSceneMax + 1);
    }
    count = std::min(count + here, kSceneMax + 1);
  }
  return count;
}

base::Result<std::vector<Scene>> shift_scenes(const RobotState& before, const model::Step& step,
                                              const Transition& transition) {
  const std::set<model::CellPair> released = released_by(step);
  const std::set<Cell> gone(transition.left.begin(), transition.left.end());
  auto pieces = supported_pieces(before, Stage::kShift, gone, released);
  if (!pieces) {
    return pieces.error();
  }
  const std::vector<model::RobotSpec> specs = specs_of(before, pieces.value(), released);
  if (transition.groups.empty()) {
    Scene scene;
    scene.pieces = specs;
    return std::vector<Scene>{std::move(scene)};
  }
  if (scene_count(transition) > kSceneMax) {
    return fault_in(
        Stage::kShift,
        fmt::format("groups that move at once can be connected to their carriers in more than "
                    "{} ways; name the carriers, or make several steps of it",
                    kSceneMax));
  }
  std::vector<Scene> scenes;
  for (std::size_t waypoint = 0; waypoint < transition.waypoint_count(); ++waypoint) {
    for (Scene& scene : scenes_at(before, transition, waypoint, pieces.value(), specs)) {
      scenes.push_back(std::move(scene));
    }
  }
  return scenes;
}

/// What was attached must touch the robot, also where a support holds it, unless it is to be apart.
std::optional<base::Error> find_stray(const RobotState& after, const model::Step& step) {
  const std::set<Cell> attached(step.attach.begin(), step.attach.end());
  if (attached.empty() || step.is_apart) {
    return std::nullopt;
  }
  for (const auto& piece : pieces_of(after, {}, {})) {
    if (std::ranges::all_of(piece, [&](std::int32_t index) {
          return attached.contains(after.module(index).cell);
        })) {
      return fault_in(Stage::kConnect,
                      fmt::format("the module that is attached at {} is not next to the robot, "
                                  "directly or through other new modules",
                                  text(after.module(piece.front()).cell)));
    }
  }
  return std::nullopt;
}

}  // namespace

std::vector<model::CellPair> let_go(const RobotState& before, const Group& group) {
  std::set<Cell> kept(group.from.begin(), group.from.end());
  for (const auto& carriers : group.carriers) {
    kept.insert(carriers.begin(), carriers.end());
  }
  std::vector<model::CellPair> pairs;
  for (const Cell& from : group.from) {
    for (const base::Direction direction : base::directions(before.lattice())) {
      const Cell other = base::neighbour(before.lattice(), from, direction);
      if (!kept.contains(other) && before.are_connected(from, other)) {
        pairs.push_back(ordered({from, other}));
      }
    }
  }
  return pairs;
}

base::Result<std::vector<Scene>> find_scenes(const RobotState& before, const model::Step& step,
                                             const Transition& transition, Stage stage) {
  switch (stage) {
    case Stage::kRelease: {
      std::set<model::CellPair> released = released_by(step);
      for (const Group& group : transition.groups) {
        const auto pairs = let_go(before, group);
        released.insert(pairs.begin(), pairs.end());
      }
      return one_scene(before, stage, released);
    }
    case Stage::kShift:
      return shift_scenes(before, step, transition);
    case Stage::kConnect:
      break;
  }
  RobotState after = before;
  apply(step, transition, after);
  if (auto stray = find_stray(after, step)) {
    return *std::move(stray);
  }
  return one_scene(after, stage, {});
}

}  // namespace holdfast::plan
