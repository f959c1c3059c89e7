// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <iterator>

#include "holdfast/io/lattice_names.hpp"
#include "json/json_text.hpp"
#include "vocabulary.hpp"

namespace holdfast::io {
namespace {

std::string name_text(std::string_view name) { return json_text(std::string(name)); }

std::string vector_text(const std::array<double, 3>& vector) {
  return row({json_text(vector[0]), json_text(vector[1]), json_text(vector[2])});
}

std::string pairs_text(const std::vector<model::CellPair>& pairs) {
  Items items;
  for (const model::CellPair& pair : pairs) {
    items.push_back(json_text(std::span(pair)));
  }
  return row(items);
}

std::string number_text(double value) {
  return std::isinf(value) ? std::string("null") : json_text(value);
}

std::string parameter_text(const ConnectorParameter& parameter) {
  Items items;
  for (std::size_t i = 0; i < parameter.values.size(); ++i) {
    if (const auto& value = parameter.values[i]) {
      const std::string text = number_text(*value);
      items.push_back(parameter.spread == Spread::kClasses ? member(kClassKeys[i], text) : text);
    }
  }
  return parameter.spread == Spread::kClasses ? object(items)
         : parameter.spread == Spread::kPairs ? row(items)
                                              : items.front();
}

std::string obstacle_text(const model::Obstacle& obstacle, const std::optional<Color>& color) {
  Items members;
  if (obstacle.cells.empty()) {
    members = {member("from", json_text(obstacle.from)), member("to", json_text(obstacle.to))};
  } else {
    members = {member("cells", json_text(std::span(obstacle.cells)))};
  }
  members.push_back(
      member("hold", name_text(kHoldNames[static_cast<std::size_t>(obstacle.touch.hold)])));
  if (obstacle.touch.friction) {
    members.push_back(member("friction", json_text(*obstacle.touch.friction)));
  }
  if (color) {
    members.push_back(member("color", json_text(*color)));
  }
  return object(members);
}

std::string payload_text(const model::Payload& payload) {
  return object({member("cell", json_text(payload.cell)),
                 member("force_n", vector_text(payload.force_n)),
                 member("torque_nmm", vector_text(payload.torque_nmm))});
}

std::string move_text(const model::Move& move) {
  Items members = {member("from", json_text(move.from)), member("to", json_text(move.to))};
  if (move.carrier) {
    members.push_back(member("carrier", json_text(*move.carrier)));
  }
  return object(members);
}

std::string step_object(const model::Step& step) {
  Items members;
  const auto add = [&](std::string_view key, const auto& list, const auto& to_text) {
    if (!list.empty()) {
      members.push_back(member(key, to_text(list)));
    }
  };
  const auto cells_text = [](std::span<const base::Cell> cells) { return json_text(cells); };
  add("attach", step.attach, cells_text);
  add("detach", step.detach, cells_text);
  add("move", step.moves, [](const std::vector<model::Move>& moves) {
    Items items;
    std::ranges::transform(moves, std::back_inserter(items), move_text);
    return row(items);
  });
  add("release", step.release, pairs_text);
  add("connect", step.connect, pairs_text);
  if (step.is_any_order) {
    members.push_back(member(kAnyOrderKey, "true"));
  }
  if (step.is_apart) {
    members.push_back(member(kApartKey, "true"));
  }
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

void add_connector_members(Items& members, const Connectors& connectors) {
  for (const ConnectorParameter& parameter : connectors.parameters) {
    members.push_back(member(parameter.key, parameter_text(parameter)));
  }
  if (connectors.bending) {
    const auto law = static_cast<std::size_t>(*connectors.bending);
    members.push_back(member(kBendingKey, name_text(kBendingNames[law])));
  }
}

void add_scatter_members(Items& members, const Scatter& scatter) {
  const auto add = [&](std::string_view key, const std::optional<double>& cv) {
    if (cv) {
      members.push_back(member(key, json_text(*cv)));
    }
  };
  add(kScatterKeys[0], scatter.strength_cv);
  add(kScatterKeys[1], scatter.mass_cv);
  if (scatter.distribution) {
    members.push_back(member(kScatterKeys[2], name_text(verdict::name(*scatter.distribution))));
  }
}

void add_factor_floor_and_gravity(Items& members, const Extension& extension) {
  if (extension.safety_factor != 1) {
    members.push_back(member(kSafetyFactorKey, json_text(extension.safety_factor)));
  }
  if (extension.floor_friction) {
    members.push_back(
        member("floor", object({member("friction", json_text(*extension.floor_friction))})));
  }
  if (extension.gravity_m_s2) {
    members.push_back(member("gravity_m_s2", vector_text(*extension.gravity_m_s2)));
  }
}

}  // namespace

void add_setting_members(Items& members, const Extension& extension,
                         const base::Lattice& default_lattice) {
  if (!extension.robot.empty()) {
    members.push_back(member("robot", json_text(extension.robot)));
  }
  if (extension.lattice != default_lattice) {
    members.push_back(member("lattice", name_text(lattice_name(extension.lattice))));
  }
  add_factor_floor_and_gravity(members, extension);
}

void add_kind_members(Items& members, const Extension& extension) {
  Items kinds;
  for (const KindEntry& kind : extension.kinds) {
    Items parameters;
    if (kind.mass_kg) {
      parameters.push_back(member("mass_kg", json_text(*kind.mass_kg)));
    }
    add_connector_members(parameters, kind.connectors);
    add_scatter_members(parameters, kind.scatter);
    kinds.push_back(json_text(kind.name) + ": " + object(parameters));
  }
  if (!kinds.empty()) {
    members.push_back(member("kinds", lines('{', kinds, '}', 2)));
  }
}

void add_connection_members(Items& members, const Extension& extension) {
  if (extension.joins_listed) {
    members.push_back(member("joined", name_text(kJoinedNames[1])));
  }
  add_list(members, "open", extension.open,
           [](const model::CellPair& pair) { return json_text(std::span(pair)); });
  add_list(members, "connections", extension.connections, [](const ConnectionEntry& entry) {
    Items items = {member(kBetweenKey, json_text(std::span(entry.between)))};
    add_connector_members(items, entry.connectors);
    add_scatter_members(items, entry.scatter);
    return object(items);
  });
  add_list(members, "bodies", extension.bodies,
           [](const std::vector<base::Cell>& body) { return json_text(std::span(body)); });
}

void add_obstacle_members(Items& members, const Extension& extension) {
  Items items;
  for (std::size_t i = 0; i < extension.obstacles.size(); ++i) {
    const auto& colors = extension.obstacle_colors;
    items.push_back(
        obstacle_text(extension.obstacles[i], i < colors.size() ? colors[i] : std::nullopt));
  }
  if (!items.empty()) {
    members.push_back(member("obstacles", array(items, 2)));
  }
}

void add_plan_members(Items& members, const Extension& extension) {
  add_list(members, "loads", extension.payloads, payload_text);
  add_list(members, "steps", extension.plan, step_object);
}

Items material_extension_members(const Extension& extension) {
  Items members;
  if (extension.pitch_mm) {
    const auto& [x, y, z] = *extension.pitch_mm;
    members.push_back(member(kPitchKey, row({json_text(x), json_text(y), json_text(z)})));
  }
  add_connector_members(members, extension.connectors);
  if (extension.foot_mm) {
    members.push_back(member(kFootKey, json_text(*extension.foot_mm)));
  }
  add_scatter_members(members, extension.scatter);
  return members;
}

std::string extension_text(const Extension& extension) {
  Items members;
  if (!extension.has_floor) {
    members.push_back(member("support_z", "null"));
  }
  add_factor_floor_and_gravity(members, extension);
  if (const Items material = material_extension_members(extension); !material.empty()) {
    members.push_back(member("material", object(material)));
  }
  add_kind_members(members, extension);
  add_connection_members(members, extension);
  add_plan_members(members, extension);
  return members.empty() ? std::string() : object(members);
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
