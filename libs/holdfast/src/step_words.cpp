// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
//
// A step in the words that modules are told.
#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>

#include "holdfast/simulated_stages.hpp"

namespace holdfast {
namespace {

using agent::StepWord;
using base::Cell;
using WordKind = StepWord::Kind;

constexpr std::uint8_t kUntilConnected = 0b011;
constexpr std::uint8_t kAlways = 0b111;

std::uint8_t number(base::Direction direction) {
  return static_cast<std::uint8_t>(base::index(direction));
}

/// Every module that leaves keeps one link: towards those that stay, by the fewest modules that
/// leave as well.
std::map<Cell, base::Direction> kept_links(const plan::RobotState& before,
                                           const std::vector<Cell>& leaving) {
  const std::set<Cell> left(leaving.begin(), leaving.end());
  std::map<Cell, base::Direction> kept;
  std::set<Cell> reached;
  for (bool is_growing = true; is_growing;) {
    std::map<Cell, base::Direction> next;
    for (const Cell& cell : left) {
      for (const base::Direction face : base::directions(before.lattice())) {
        const Cell other = base::neighbour(before.lattice(), cell, face);
        const bool stays = before.find(other) != plan::RobotState::kNone && !left.contains(other);
        if (!kept.contains(cell) && (stays || reached.contains(other))) {
          next.try_emplace(cell, face);
        }
      }
    }
    is_growing = !next.empty();
    for (const auto& [cell, face] : next) {
      kept.emplace(cell, face);
      reached.insert(cell);
    }
  }
  return kept;
}

void add_releases(const plan::RobotState& before, const model::Step& step,
                  const plan::Transition& transition, std::vector<StepWord>& words) {
  plan::RobotState after = before;
  plan::apply(step, transition, after);
  std::set<model::CellPair> pairs = before.released();
  for (const model::CellPair& pair : step.release) {
    pairs.insert(plan::ordered(pair));
  }
  for (const model::CellPair& pair : pairs) {
    const auto direction = model::direction_between(before.lattice(), pair[0], pair[1]);
    words.push_back({.kind = WordKind::kOff,
                     .face = number(direction.value()),
                     .mask = after.released().contains(pair) ? kAlways : kUntilConnected,
                     .cell = pair[0]});
  }
}

/// The direction of half a way, 2 axial coordinates.
base::Direction direction_of(const base::Lattice& lattice, const Cell& from, const Cell& to) {
  const Cell step = {to.x - from.x, to.y - from.y, to.z - from.z};
  return static_cast<base::Direction>(std::ranges::find(lattice.steps, step) -
                                      lattice.steps.begin());
}

void add_group(const base::Lattice& lattice, const plan::Group& group, std::uint8_t index,
               const std::map<Cell, base::Direction>& kept, std::vector<StepWord>& words) {
  for (const Cell& from : group.from) {
    StepWord word{.kind = WordKind::kMove,
                  .group = index,
                  .face = number(kept.at(from)),
                  .first = number(direction_of(lattice, group.way[0], group.way[1])),
                  .cell = from};
    if (group.way.size() > 3) {
      word.second = number(direction_of(lattice, group.way[2], group.way[3]));
    }
    words.push_back(word);
  }
  std::map<Cell, std::uint8_t> carriers;
  for (std::size_t waypoint = 0; waypoint < group.carriers.size(); ++waypoint) {
    for (const Cell& carrier : group.carriers[waypoint]) {
      carriers[carrier] = static_cast<std::uint8_t>(carriers[carrier] | 1U << waypoint);
    }
  }
  for (const auto& [carrier, mask] : carriers) {
    words.push_back({.kind = WordKind::kCarry, .group = index, .mask = mask, .cell = carrier});
  }
}

}  // namespace

base::Result<std::vector<StepWord>> step_words(const plan::RobotState& before,
                                               const model::Step& step,
                                               const plan::Transition& transition) {
  const auto kept = kept_links(before, transition.left);
  std::vector<StepWord> words;
  add_releases(before, step, transition, words);
  for (const Cell& cell : step.detach) {
    const auto link = kept.find(cell);
    words.push_back({.kind = WordKind::kDetach,
                     .face = link == kept.end() ? std::uint8_t{0} : number(link->second),
                     .cell = cell});
  }
  if (transition.groups.size() > agent::kGroupCount) {
    return base::Error{.code = base::ErrorCode::kUnsupported,
                       .message = fmt::format("{} groups move at once, modules know {} at most",
                                              transition.groups.size(), agent::kGroupCount),
                       .where = {}};
  }
  for (std::size_t i = 0; i < transition.groups.size(); ++i) {
    add_group(before.lattice(), transition.groups[i], static_cast<std::uint8_t>(i), kept, words);
  }
  for (const Cell& cell : step.attach) {
    words.push_back({.kind = WordKind::kAttach, .cell = cell});
  }
  if (words.size() > agent::kWordCountMax) {
    return base::Error{.code = base::ErrorCode::kUnsupported,
                       .message = fmt::format("the step takes {} words, modules keep {} at most",
                                              words.size(), agent::kWordCountMax),
                       .where = {}};
  }
  return words;
}

}  // namespace holdfast
