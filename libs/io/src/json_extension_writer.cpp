// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <iterator>

#include "json_text.hpp"
#include "vocabulary.hpp"

namespace holdfast::io {
namespace {

std::string name_text(std::string_view name) { return json_text(std::string(name)); }

std::string vector_text(const std::array<double, 3>& vector) {
  return row({json_text(vector[0]), json_text(vector[1]), json_text(vector[2])});
}

std::string cells_text(const std::vector<base::Cell>& cells) {
  Items items;
  for (const base::Cell& cell : cells) {
    items.push_back(json_text(cell));
  }
  return row(items);
}

std::string pairs_text(const std::vector<CellPair>& pairs) {
  Items items;
  for (const CellPair& pair : pairs) {
    items.push_back(cells_text({pair.begin(), pair.end()}));
  }
  return row(items);
}

Items members_of(const NamedNumbers& numbers) {
  Items members;
  for (const auto& [name, value] : numbers) {
    members.push_back(member(name, json_text(value)));
  }
  return members;
}

std::string obstacle_text(const Obstacle& obstacle) {
  Items members;
  if (obstacle.cells.empty()) {
    members = {member("from", json_text(obstacle.from)), member("to", json_text(obstacle.to))};
  } else {
    members = {member("cells", cells_text(obstacle.cells))};
  }
  members.push_back(member("hold", name_text(kHoldNames[static_cast<std::size_t>(obstacle.hold)])));
  if (obstacle.friction) {
    members.push_back(member("friction", json_text(*obstacle.friction)));
  }
  return object(members);
}

std::string payload_text(const Payload& payload) {
  return object({member("cell", json_text(payload.cell)),
                 member("force_n", vector_text(payload.force_n)),
                 member("torque_nmm", vector_text(payload.torque_nmm))});
}

std::string move_text(const Move& move) {
  Items members = {member("from", json_text(move.from)), member("to", json_text(move.to))};
  if (move.carrier) {
    members.push_back(member("carrier", json_text(*move.carrier)));
  }
  return object(members);
}

std::string step_text(const PlanStep& step) {
  Items members;
  const auto add = [&](std::string_view key, const auto& list, const auto& to_text) {
    if (!list.empty()) {
      members.push_back(member(key, to_text(list)));
    }
  };
  add("attach", step.attach, cells_text);
  add("detach", step.detach, cells_text);
  add("move", step.moves, [](const std::vector<Move>& moves) {
    Items items;
    std::ranges::transform(moves, std::back_inserter(items), move_text);
    return row(items);
  });
  add("release", step.release, pairs_text);
  add("connect", step.connect, pairs_text);
  return object(members);
}

/// An item a line, if there are any.
template <class List, class ToText>
void add_list(Items& members, std::string_view key, const List& list, const ToText& to_text) {
  if (!list.empty()) {
    Items items;
    std::ranges::transform(list, std::back_inserter(items), to_text);
    members.push_back(member(key, array(items, 2)));
  }
}

}  // namespace

void add_setting_members(Items& members, const Extension& extension) {
  if (extension.lattice != LatticeName::kCubic) {
    members.push_back(
        member("lattice", name_text(kLatticeNames[static_cast<std::size_t>(extension.lattice)])));
  }
  if (extension.floor_friction) {
    members.push_back(
        member("floor", object({member("friction", json_text(*extension.floor_friction))})));
  }
  if (extension.gravity_m_s2) {
    members.push_back(member("gravity_m_s2", vector_text(*extension.gravity_m_s2)));
  }
}

void add_kind_members(Items& members, const Extension& extension) {
  Items kinds;
  for (const ModuleKind& kind : extension.kinds) {
    kinds.push_back(json_text(kind.name) + ": " + object(members_of(kind.parameters)));
  }
  if (!kinds.empty()) {
    members.push_back(member("kinds", lines('{', kinds, '}', 2)));
  }
}

void add_plan_members(Items& members, const Extension& extension) {
  add_list(members, "obstacles", extension.obstacles, obstacle_text);
  add_list(members, "loads", extension.payloads, payload_text);
  add_list(members, "steps", extension.plan, step_text);
}

void add_own_members(Items& members, const OwnParameters& own) {
  if (!own.kind.empty()) {
    members.push_back(member("kind", json_text(own.kind)));
  }
  if (own.mass_kg) {
    members.push_back(member("mass_kg", json_text(*own.mass_kg)));
  }
}

}  // namespace holdfast::io
