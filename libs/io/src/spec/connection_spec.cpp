// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "spec/connection_spec.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <string>

#include "holdfast/plan/robot_state.hpp"
#include "json/json_values.hpp"
#include "spec/body_spec.hpp"
#include "vocabulary.hpp"

namespace holdfast::io {
namespace {

using model::ConnectorLaw;

/// The member of a law that a parameter sets; friction, which may be none, is not among them.
struct LawMember {
  std::string_view key;
  double ConnectorLaw::*value;
  std::optional<base::ConnectorClass> only = {};
};

constexpr LawMember kLawMembers[] = {
    {kClassStrengthKeys[0], &ConnectorLaw::strength_n, base::ConnectorClass::kVertical},
    {kClassStrengthKeys[1], &ConnectorLaw::strength_n, base::ConnectorClass::kLateral},
    {"strength_n", &ConnectorLaw::strength_n},
    {"lever_mm", &ConnectorLaw::lever_mm},
    {"shear_strength_n", &ConnectorLaw::shear_strength_n},
    {"torsion_strength_nmm", &ConnectorLaw::torsion_strength_nmm},
    {"torsion_radius_mm", &ConnectorLaw::torsion_radius_mm},
    {"gap_limit_mm", &ConnectorLaw::gap_limit_mm}};

void set(ConnectorLaw& law, std::string_view key, double value, base::ConnectorClass direction) {
  if (key == "friction") {
    law.friction = std::isinf(value) ? std::nullopt : std::optional(value);
    return;
  }
  const auto* const member = std::ranges::find(kLawMembers, key, &LawMember::key);
  if (member != std::end(kLawMembers) && member->only.value_or(direction) == direction) {
    law.*member->value = value;
  }
}

/// The value of a parameter for a direction; none if it has none.
std::optional<double> value_for(const ConnectorParameter& parameter, std::size_t direction,
                                base::ConnectorClass direction_class) {
  const std::size_t index = parameter.spread == Spread::kAll ? 0
                            : parameter.spread == Spread::kClasses
                                ? static_cast<std::size_t>(direction_class)
                                : direction / 2;
  return index < parameter.values.size() ? parameter.values[index] : std::nullopt;
}

/// Checks the pairs that a document names, and knows which they are.
class NamedPairs {
 public:
  NamedPairs(const Document& document, const BodyIndex& bodies)
      : lattice_(document.extension.lattice), cells_(cells_of(document)), bodies_(bodies) {}

  /// Takes a pair; an error if it is no pair of neighbours, or was taken before.
  std::optional<base::Error> take(const model::CellPair& pair, const JsonPlace& place) {
    const std::string text = model::text(pair[0]) + "-" + model::text(pair[1]);
    for (const base::Cell& cell : pair) {
      if (!cells_.contains(cell)) {
        return base::bad_input(
            fmt::format("{}: expected two modules, found none at {}", text, model::text(cell)),
            place.pointer());
      }
    }
    if (!model::direction_between(lattice_, pair[0], pair[1])) {
      return base::bad_input(
          fmt::format("{}: expected two modules whose faces touch, found two that do not", text),
          place.pointer());
    }
    if (const auto body = bodies_.inside(pair)) {
      return base::bad_input(fmt::format("{} is inside body {}: expected nothing said of it, as it "
                                         "never parts",
                                         text, *body),
                             place.pointer());
    }
    if (!pairs_.insert(plan::ordered(pair)).second) {
      return base::bad_input(
          fmt::format("{}: expected each pair once in \"open\" and \"connections\" together, "
                      "found it twice",
                      text),
          place.pointer());
    }
    return std::nullopt;
  }

  bool contains(const model::CellPair& pair) const { return pairs_.contains(plan::ordered(pair)); }

 private:
  const base::Lattice& lattice_;
  std::set<base::Cell> cells_;
  const BodyIndex& bodies_;
  std::set<model::CellPair> pairs_;
};

/// The kinds of modules by cell, of those that are not of the first one.
std::map<base::Cell, const model::ModuleKind*> kinds_by_cell(
    const Document& document, const std::vector<model::ModuleKind>& kinds) {
  std::map<base::Cell, const model::ModuleKind*> by_cell;
  for (const OwnParameters& own : document.extension.own) {
    const auto kind = std::ranges::find(kinds, own.kind, &model::ModuleKind::name);
    if (kind != kinds.end()) {
      const base::Cell& cell = own.step == 0 ? document.modules[own.module].cell
                                             : document.steps[own.step - 1][own.module].cell;
      by_cell[cell] = &*kind;
    }
  }
  return by_cell;
}

/// The laws of connections by what modules they join.
class KindLaws {
 public:
  KindLaws(const Document& document, const std::vector<model::ModuleKind>& kinds)
      : lattice_(document.extension.lattice),
        plain_(kinds.front()),
        by_cell_(kinds_by_cell(document, kinds)) {}

  static std::size_t direction(const base::Lattice& lattice, const model::CellPair& between) {
    return base::at(base::index(*model::direction_between(lattice, between[0], between[1])));
  }

  /// The weaker of the connectors of two neighbours.
  model::ConnectorLaw of(const model::CellPair& between) const {
    const std::size_t along = direction(lattice_, between);
    return model::weaker(kind_at(between[0]).connectors[along],
                         kind_at(between[1]).connectors[along ^ 1U]);
  }

 private:
  const model::ModuleKind& kind_at(const base::Cell& cell) const {
    const auto found = by_cell_.find(cell);
    return found == by_cell_.end() ? plain_ : *found->second;
  }

  const base::Lattice& lattice_;
  const model::ModuleKind& plain_;
  std::map<base::Cell, const model::ModuleKind*> by_cell_;
};

void add_laws(const Document& document, const KindLaws& laws, const std::set<base::Cell>& cells,
              model::RobotSpec& spec) {
  const Extension& extension = document.extension;
  for (std::size_t i = 0; i < extension.connections.size(); ++i) {
    const auto& [between, connectors, scatter] = extension.connections[i];
    const bool is_plain = connectors == Connectors{} && scatter == Scatter{};
    if (is_plain || !cells.contains(between[0]) || !cells.contains(between[1])) {
      continue;
    }
    model::ConnectorLaw law = laws.of(between);
    apply(connectors, extension.lattice, KindLaws::direction(extension.lattice, between), law);
    spec.own_connectors.push_back({between, law, static_cast<std::int32_t>(i)});
  }
}

/// Gives connections inside bodies a law that limits nothing.
void add_bodies(const Document& document, const KindLaws& laws, const std::set<base::Cell>& cells,
                const BodyIndex& index, model::RobotSpec& spec) {
  const base::Lattice& lattice = document.extension.lattice;
  for (const std::vector<base::Cell>& body : document.extension.bodies) {
    for (const base::Cell& cell : body) {
      for (const base::Direction direction : base::directions(lattice)) {
        const model::CellPair pair = {cell, base::neighbour(lattice, cell, direction)};
        const auto number = index.inside(pair);
        if (number && pair[0] < pair[1] && cells.contains(pair[0]) && cells.contains(pair[1])) {
          const model::ConnectorLaw usual = laws.of(pair);
          spec.own_connectors.push_back(
              {.between = pair,
               .law = {.lever_mm = usual.lever_mm, .bending = usual.bending},
               .body = *number});
        }
      }
    }
  }
}

}  // namespace

void apply(const Connectors& connectors, const base::Lattice& lattice, std::size_t direction,
           ConnectorLaw& law) {
  const base::ConnectorClass direction_class = lattice.connector_class[direction];
  for (const ConnectorParameter& parameter : connectors.parameters) {
    if (const auto value = value_for(parameter, direction, direction_class)) {
      set(law, parameter.key, *value, direction_class);
    }
  }
  law.bending = connectors.bending.value_or(law.bending);
}

bool has_connections(const Document& document) {
  const Extension& extension = document.extension;
  return extension.joins_listed || !extension.open.empty() || !extension.connections.empty() ||
         !extension.bodies.empty();
}

std::set<base::Cell> cells_of(const Document& document) {
  std::set<base::Cell> cells;
  if (!has_connections(document)) {
    return cells;
  }
  for (const ModuleEntry& module : document.modules) {
    cells.insert(module.cell);
  }
  for (const Step& step : document.steps) {
    for (const PlannedEntry& planned : step) {
      cells.insert(planned.cell);
    }
  }
  for (const model::Step& step : document.extension.plan) {
    cells.insert(step.attach.begin(), step.attach.end());
  }
  return cells;
}

std::optional<base::Error> add_connections(const Document& document,
                                           const std::vector<model::ModuleKind>& kinds,
                                           const std::set<base::Cell>& cells,
                                           model::RobotSpec& spec) {
  if (!has_connections(document)) {
    return std::nullopt;
  }
  if (auto error = find_bodies_fault(document)) {
    return error;
  }
  const Extension& extension = document.extension;
  const JsonPlace top;
  const JsonPlace connections = top.at("connections");
  const BodyIndex bodies(document);
  NamedPairs listed(document, bodies);
  for (std::size_t i = 0; i < extension.connections.size(); ++i) {
    const JsonPlace entry = connections.at(i);
    if (auto error = listed.take(extension.connections[i].between, entry.at(kBetweenKey))) {
      return error;
    }
  }
  NamedPairs named = listed;
  const JsonPlace open = top.at("open");
  std::set<model::CellPair> released;
  for (std::size_t i = 0; i < extension.open.size(); ++i) {
    if (auto error = named.take(extension.open[i], open.at(i))) {
      return error;
    }
    released.insert(plan::ordered(extension.open[i]));
  }
  if (extension.joins_listed) {
    for (const base::Cell& cell : cells) {
      for (const base::Direction direction : base::directions(extension.lattice)) {
        const model::CellPair pair = {cell, base::neighbour(extension.lattice, cell, direction)};
        if (cells.contains(pair[1]) && !listed.contains(pair) && !bodies.inside(pair)) {
          released.insert(plan::ordered(pair));
        }
      }
    }
  }
  std::ranges::copy_if(released, std::back_inserter(spec.released), [&](const auto& pair) {
    return cells.contains(pair[0]) && cells.contains(pair[1]);
  });
  const KindLaws laws(document, kinds);
  add_laws(document, laws, cells, spec);
  add_bodies(document, laws, cells, bodies, spec);
  return std::nullopt;
}

}  // namespace holdfast::io
