// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "holdfast/io/document.hpp"
#include "json_values.hpp"
#include "robot_defaults.hpp"
#include "text_input.hpp"
#include "vocabulary.hpp"

/// From what a file says to what a robot is made from.
namespace holdfast::io {
namespace {

using model::ConnectorLaw;

/// Where a parameter goes; friction, which may be none, aside.
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

/// What a parameter says for a direction; none if nothing.
std::optional<double> value_for(const ConnectorParameter& parameter, std::size_t direction,
                                base::ConnectorClass direction_class) {
  const std::size_t index = parameter.spread == Spread::kAll ? 0
                            : parameter.spread == Spread::kClasses
                                ? static_cast<std::size_t>(direction_class)
                                : direction / 2;
  return index < parameter.values.size() ? parameter.values[index] : std::nullopt;
}

void apply(const Connectors& connectors, const base::Lattice& lattice, model::ModuleKind& kind) {
  for (std::size_t d = 0; d < kind.connectors.size(); ++d) {
    ConnectorLaw& law = kind.connectors[d];
    const base::ConnectorClass direction_class = lattice.connector_class[d];
    for (const ConnectorParameter& parameter : connectors.parameters) {
      if (const auto value = value_for(parameter, d, direction_class)) {
        set(law, parameter.key, *value, direction_class);
      }
    }
    law.bending = connectors.bending.value_or(law.bending);
  }
}

// What model::Robot allows; beyond it, products with other numbers leave the range of double.
constexpr double kNumberMin = 1e-12;
constexpr double kNumberMax = 1e12;

std::optional<base::Error> find_fault(const Connectors& connectors, const Place& place) {
  for (const ConnectorParameter& parameter : connectors.parameters) {
    for (const std::optional<double>& value : parameter.values) {
      if (!(value.value_or(1) >= kNumberMin)) {
        return base::Error{base::ErrorCode::kBadInput,
                           fmt::format("found {}, allowed is {} and more", *value, kNumberMin),
                           place.at(parameter.key).pointer()};
      }
    }
  }
  return std::nullopt;
}

/// Before the robot is made, which does not know the file's names and places.
std::optional<base::Error> find_fault(const Extension& extension) {
  const Place top;
  auto fault = find_fault(extension.connectors, top.at("material"));
  const Place kinds = top.at("kinds");
  for (const KindEntry& kind : extension.kinds) {
    const Place place = kinds.at(kind.name);
    const double mass = kind.mass_kg.value_or(1);
    if (!fault && !(mass >= kNumberMin && mass <= kNumberMax)) {
      fault = {base::ErrorCode::kBadInput,
               fmt::format("found {}, allowed is {} to {}", mass, kNumberMin, kNumberMax),
               place.at("mass_kg").pointer()};
    }
    fault = fault ? fault : find_fault(kind.connectors, place);
  }
  return fault;
}

/// All modules without a kind of their own first, then the document's kinds in their order.
std::vector<model::ModuleKind> kinds_of(const Document& document) {
  const Extension& extension = document.extension;
  model::ModuleKind plain = model::default_kind(document.material, extension.lattice);
  apply(robot_connectors(extension.robot), extension.lattice, plain);
  apply(extension.connectors, extension.lattice, plain);
  std::vector<model::ModuleKind> kinds = {plain};
  for (const KindEntry& entry : extension.kinds) {
    model::ModuleKind& kind = kinds.emplace_back(plain);
    kind.name = entry.name;
    kind.mass_kg = entry.mass_kg.value_or(plain.mass_kg);
    apply(entry.connectors, extension.lattice, kind);
  }
  return kinds;
}

/// The cell of a module with parameters of its own; none if nothing is checked of its step.
const base::Cell* find_cell(const Document& document, const OwnParameters& own) {
  if (own.step == 0 && own.module < document.modules.size()) {
    return &document.modules[own.module].cell;
  }
  const bool is_planned =
      own.step == 1 && !document.steps.empty() && own.module < document.steps.front().size();
  return is_planned ? &document.steps.front()[own.module].cell : nullptr;
}

/// Gives modules their own kinds and masses. A mass that is that of the kind says nothing.
std::optional<base::Error> add_own(const Document& document,
                                   const std::vector<model::ModuleKind>& kinds,
                                   model::RobotSpec& spec) {
  for (const OwnParameters& own : document.extension.own) {
    const base::Cell* const cell = find_cell(document, own);
    if (cell == nullptr) {
      continue;
    }
    const auto kind = std::ranges::find(kinds, own.kind, &model::ModuleKind::name);
    if (kind == kinds.end()) {
      return base::Error{base::ErrorCode::kBadInput,
                         fmt::format("the kind {} of {} is none of those in \"kinds\"",
                                     excerpt(own.kind), model::text(*cell)),
                         "/kinds"};
    }
    if (kind != kinds.begin()) {
      spec.own_kinds.push_back({*cell, static_cast<std::uint16_t>(kind - kinds.begin())});
    }
    if (own.mass_kg && *own.mass_kg != kind->mass_kg) {
      spec.own_masses.push_back({*cell, *own.mass_kg});
    }
  }
  return std::nullopt;
}

}  // namespace

std::optional<base::Error> find_unsupported(const Document& document) {
  if (document.extension.plan.empty()) {
    return std::nullopt;
  }
  return base::Error{base::ErrorCode::kUnsupported,
                     "a plan of steps cannot be computed yet: only the step in \"planned\" can",
                     "/steps"};
}

base::Result<model::RobotSpec> make_spec(const Document& document) {
  if (auto error = find_unsupported(document)) {
    return *std::move(error);
  }
  const Extension& extension = document.extension;
  if (auto error = find_fault(extension)) {
    return *std::move(error);
  }
  model::RobotSpec spec{.material = document.material,
                        .lattice = extension.lattice,
                        .floor = {.friction = extension.floor_friction},
                        .obstacles = extension.obstacles,
                        .gravity_m_s2 = extension.gravity_m_s2,
                        .foot_mm = extension.foot_mm,
                        .payloads = extension.payloads};
  spec.support_z = extension.has_floor ? std::optional(document.support_z) : std::nullopt;
  spec.existing.reserve(document.modules.size());
  for (const ModuleEntry& module : document.modules) {
    spec.existing.push_back(module.cell);
    if (module.is_fixed) {
      spec.fixed.push_back(module.cell);
    }
  }
  if (!document.steps.empty()) {
    for (const PlannedEntry& planned : document.steps.front()) {
      spec.planned.push_back(planned.cell);
    }
  }
  std::vector<model::ModuleKind> kinds = kinds_of(document);
  if (auto error = add_own(document, kinds, spec)) {
    return *std::move(error);
  }
  if (!spec.own_kinds.empty() || extension.connectors != Connectors{} ||
      robot_connectors(extension.robot) != Connectors{}) {
    spec.kinds = std::move(kinds);
  }
  return spec;
}

base::Result<model::Robot> make_robot(const Document& document, int thread_count) {
  const auto spec = make_spec(document);
  return spec ? model::Robot::create(spec.value(), thread_count)
              : base::Result<model::Robot>(spec.error());
}

}  // namespace holdfast::io
