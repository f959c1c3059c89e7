// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "steps/way.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <string>
#include <vector>

#include "barring_floor.hpp"

namespace holdfast::plan {
namespace {

using base::Cell;
using model::text;

std::string way_text(const Group& group) {
  return fmt::format("{} cannot go to {}", text(group.from.front()), text(group.to.front()));
}

/// Twice the ways that are gone at the waypoints of a slide, or over a cell between.
std::vector<Cell> slide_way(const Cell& step) { return {{}, step, sum(step, step)}; }

std::vector<Cell> turn_way(const Cell& first, const Cell& second) {
  const Cell corner = sum(first, first);
  const Cell half = sum(corner, second);
  return {{}, first, corner, half, sum(half, second)};
}

}  // namespace

Cell moved(const base::Lattice& lattice, const Cell& from, const Cell& doubled) {
  return base::cell_of(
      lattice, sum(base::axial_of(lattice, from), {doubled.x / 2, doubled.y / 2, doubled.z / 2}));
}

WayFinder::WayFinder(const RobotState& robot, const model::Step& step, std::span<const Cell> left)
    : robot_(robot), step_(step), left_(left.begin(), left.end()) {
  for (const model::CellPair& pair : step.release) {
    released_.insert(ordered(pair));
  }
}

bool WayFinder::is_staying(const Cell& cell) const {
  return robot_.find(cell) != RobotState::kNone && !left_.contains(cell);
}

/// Whether the floor bars the cell, by the modules before the step and after.
bool WayFinder::is_under_floor(const Cell& cell) const {
  const std::optional<std::int32_t>& support_z = robot_.surroundings().support_z;
  if (!support_z || cell.z >= *support_z) {
    return false;
  }
  std::vector<Cell> before_and_after = step_.attach;
  for (const model::Move& move : step_.moves) {
    before_and_after.push_back(move.to);
  }
  for (const ModuleState& module : robot_.modules()) {
    if (module.is_there) {
      before_and_after.push_back(module.cell);
    }
  }
  return barring_floor(support_z, before_and_after).has_value();
}

/// Whether a cell is free of modules that stay or move elsewhere, of obstacles, and of the floor.
bool WayFinder::is_free(const Cell& cell, const Draft& draft) const {
  return (robot_.find(cell) == RobotState::kNone || draft.members.contains(cell) ||
          std::ranges::find(step_.detach, cell) != step_.detach.end()) &&
         robot_.obstacles().find(cell) == model::CellIndex::kNone && !is_under_floor(cell);
}

bool WayFinder::is_step(const Cell& axial) const {
  const std::span<const Cell> steps = steps_of(robot_.lattice());
  return std::ranges::find(steps, axial) != steps.end();
}

bool WayFinder::touches(const Cell& carrier, const std::set<Cell>& cells) const {
  for (const base::Direction direction : base::directions(robot_.lattice())) {
    if (cells.contains(base::neighbour(robot_.lattice(), carrier, direction))) {
      return true;
    }
  }
  return false;
}

/// Whether a module stays and is connected to a moved one before the move.
bool WayFinder::holds(const Cell& carrier, const Draft& draft) const {
  return is_staying(carrier) && std::ranges::any_of(draft.members, [&](const Cell& member) {
           return robot_.are_connected(carrier, member) &&
                  !released_.contains(ordered({carrier, member}));
         });
}

/// The modules beside cells that stay, each once.
std::vector<Cell> WayFinder::beside(const std::set<Cell>& cells) const {
  std::set<Cell> found;
  for (const Cell& cell : cells) {
    for (const base::Direction direction : base::directions(robot_.lattice())) {
      const Cell other = base::neighbour(robot_.lattice(), cell, direction);
      if (is_staying(other)) {
        found.insert(other);
      }
    }
  }
  return {found.begin(), found.end()};
}

base::Result<Group> WayFinder::find(std::span<const std::size_t> moves) const {
  Draft draft;
  for (const std::size_t i : moves) {
    const model::Move& move = step_.moves[i];
    draft.group.from.push_back(move.from);
    draft.group.to.push_back(move.to);
    draft.members.insert(move.from);
    draft.arrivals.insert(move.to);
    if (move.carrier && std::ranges::find(draft.named, *move.carrier) == draft.named.end()) {
      draft.named.push_back(*move.carrier);
    }
  }
  const base::Lattice& lattice = robot_.lattice();
  draft.translation = difference(base::axial_of(lattice, draft.group.to.front()),
                                 base::axial_of(lattice, draft.group.from.front()));
  std::optional<std::string> fault;
  if (draft.translation == Cell{}) {
    fault = way_text(draft.group) + ": it is there already";
  }
  for (const Cell& cell : draft.group.to) {
    if (!fault && !is_free(cell, draft)) {
      fault = fmt::format("{}: {} is occupied", way_text(draft.group), text(cell));
    }
  }
  if (!fault && !draft.named.empty()) {
    fault = find_named(draft);
  } else if (!fault) {
    fault = is_step(draft.translation) ? find_slide(draft) : find_turn(draft);
  }
  fault = fault ? fault : find_obstruction(draft);
  if (fault) {
    return base::Error{
        .code = base::ErrorCode::kBadInput, .message = *std::move(fault), .where = {}};
  }
  return std::move(draft.group);
}

std::optional<std::string> WayFinder::find_named(Draft& draft) const {
  for (const Cell& carrier : draft.named) {
    if (!holds(carrier, draft)) {
      return fmt::format("{}: the carrier {} is no module that stays and is connected to it",
                         way_text(draft.group), text(carrier));
    }
  }
  if (!is_step(draft.translation)) {
    return find_named_turn(draft);
  }
  draft.group.way = slide_way(draft.translation);
  draft.group.carriers.assign(draft.group.way.size(), draft.named);
  return std::nullopt;
}

/// The turn about all named carriers. If none is free it is one that is not, which
/// find_obstruction() complains of.
std::optional<std::string> WayFinder::find_named_turn(Draft& draft) const {
  std::set<Cell> ways = turns_about(draft.named.front(), draft);
  for (const Cell& carrier : draft.named) {
    const std::set<Cell> own = turns_about(carrier, draft);
    std::erase_if(ways, [&](const Cell& way) { return !own.contains(way); });
    if (ways.empty()) {
      return fmt::format(
          "{}: that is out of reach of its carrier {}; a carrier reaches as far as a slide by one "
          "cell, or a turn about its corner",
          way_text(draft.group), text(carrier));
    }
  }
  const auto is_open = [&](const Cell& way) { return is_open_turn(way, draft); };
  const auto open_count = std::ranges::count_if(ways, is_open);
  if (open_count > 1) {
    return fmt::format(
        "{}: there is more than one way about its carrier {}; name one more carrier, or move its "
        "modules one after another",
        way_text(draft.group), text(draft.named.front()));
  }
  const Cell first = open_count == 1 ? *std::ranges::find_if(ways, is_open) : *ways.begin();
  draft.group.way = turn_way(first, difference(draft.translation, first));
  draft.group.carriers.assign(draft.group.way.size(), draft.named);
  return std::nullopt;
}

std::optional<std::string> WayFinder::find_slide(Draft& draft) const {
  const base::Lattice& lattice = robot_.lattice();
  const Cell forth = sum(draft.translation, draft.translation);
  const Cell back = {-forth.x, -forth.y, -forth.z};
  std::vector<Cell> start;
  std::vector<Cell> end;
  for (const Cell& carrier : beside(draft.members)) {
    const Cell next = moved(lattice, carrier, forth);
    if (holds(carrier, draft) && (touches(carrier, draft.arrivals) || is_staying(next))) {
      start.push_back(carrier);
    }
  }
  for (const Cell& carrier : beside(draft.arrivals)) {
    if (holds(carrier, draft) || holds(moved(lattice, carrier, back), draft)) {
      end.push_back(carrier);
    }
  }
  if (start.empty()) {
    return fmt::format(
        "{}: no module carries it: none touches it before and after, and no two in a row lie along "
        "its way",
        way_text(draft.group));
  }
  std::set<Cell> both(start.begin(), start.end());
  both.insert(end.begin(), end.end());
  draft.group.way = slide_way(draft.translation);
  draft.group.carriers = {start, {both.begin(), both.end()}, end};
  return std::nullopt;
}

/// The ways to the cell between, axial, by which the group can turn about a corner of the carrier:
/// one for every arrival beside it at most.
std::set<Cell> WayFinder::turns_about(const Cell& carrier, const Draft& draft) const {
  const Cell centre = base::axial_of(robot_.lattice(), carrier);
  std::set<Cell> ways;
  for (const Cell& arrival : draft.group.to) {
    const Cell first = difference(base::axial_of(robot_.lattice(), arrival), centre);
    const Cell second = difference(draft.translation, first);
    if (first != second && is_step(first) &&
        is_step(second)) {  // Else it goes through the carrier.
      ways.insert(first);
    }
  }
  return ways;
}

/// Whether the cell between is free for every module.
bool WayFinder::is_open_turn(const Cell& first, const Draft& draft) const {
  return std::ranges::all_of(draft.members, [&](const Cell& member) {
    return is_free(moved(robot_.lattice(), member, sum(first, first)), draft);
  });
}

std::optional<std::string> WayFinder::find_turn(Draft& draft) const {
  std::set<Cell> ways;
  std::vector<Cell> carriers;
  for (const Cell& carrier : beside(draft.members)) {
    if (!holds(carrier, draft)) {
      continue;
    }
    std::set<Cell> own = turns_about(carrier, draft);
    std::erase_if(own, [&](const Cell& way) { return !is_open_turn(way, draft); });
    if (!own.empty()) {
      ways.insert(own.begin(), own.end());
      carriers.push_back(carrier);
    }
  }
  if (ways.size() != 1) {
    return fmt::format("{}: there is {}", way_text(draft.group),
                       ways.empty() ? "no slide by one cell and no turn about a corner that leads "
                                      "there"
                                    : "more than one way; name its carrier");
  }
  draft.group.way = turn_way(*ways.begin(), difference(draft.translation, *ways.begin()));
  draft.group.carriers.assign(draft.group.way.size(), carriers);
  return std::nullopt;
}

std::optional<std::string> WayFinder::find_obstruction(const Draft& draft) const {
  for (std::size_t i = 2; i < draft.group.way.size(); i += 2) {
    for (const Cell& member : draft.group.from) {
      const Cell cell = moved(robot_.lattice(), member, draft.group.way[i]);
      if (!is_free(cell, draft)) {
        return fmt::format("{}: on its way {} is {}", way_text(draft.group), text(cell),
                           is_under_floor(cell) ? "below the floor" : "occupied");
      }
    }
  }
  return std::nullopt;
}

}  // namespace holdfast::plan
