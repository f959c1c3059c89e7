// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <numeric>
#include <set>
#include <utility>

#include "holdfast/io/document.hpp"
#include "holdfast/io/lattice_names.hpp"
#include "holdfast/model/robot_catalogue.hpp"
#include "json/json_values.hpp"
#include "robot_defaults.hpp"
#include "spec/connection_spec.hpp"
#include "text_input.hpp"
#include "vocabulary.hpp"

/// Translates what a file says into what a robot is made of.
namespace holdfast::io {
namespace {

void apply(const Connectors& connectors, const base::Lattice& lattice, model::ModuleKind& kind) {
  for (std::size_t d = 0; d < kind.connectors.size(); ++d) {
    apply(connectors, lattice, d, kind.connectors[d]);
  }
}

std::optional<base::Error> find_fault(const Connectors& connectors, const JsonPlace& place) {
  for (const ConnectorParameter& parameter : connectors.parameters) {
    for (const std::optional<double>& value : parameter.values) {
      if (!(value.value_or(1) >= kPositiveMin)) {
        return base::Error{base::ErrorCode::kBadInput,
                           fmt::format("expected {} or more, found {}", kPositiveMin, *value),
                           place.at(parameter.key).pointer()};
      }
    }
  }
  return std::nullopt;
}

/// The section of a beam as wide as the pitch, which a file that names a robot need not say.
model::Material section_of_pitch(double pitch_mm) {
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  model::Material section;
  section.pitch_mm = pitch_mm;
  section.facet_mm = section.section_area_mm2 = section.torsion_mm4 = kNone;
  section.moment_x_mm4 = section.moment_y_mm4 = kNone;
  model::fill_section(section);
  return section;
}

std::optional<base::Error> find_fault(const model::Material& material, const JsonPlace& place) {
  const model::Material of_pitch = section_of_pitch(material.pitch_mm);
  for (const model::MaterialParameter& parameter : model::kMaterialParameters) {
    const double value = material.*parameter.value;
    if (auto fault = model::find_fault(parameter, value)) {
      const bool is_of_pitch = value == of_pitch.*parameter.value;
      return base::Error{base::ErrorCode::kBadInput, *std::move(fault),
                         place.at(is_of_pitch ? "pitch_mm" : parameter.key).pointer()};
    }
  }
  return std::nullopt;
}

/// The pitch that a lattice is stretched from: that along axes which it cannot be stretched along.
double pitch_unit(const Extension& extension) {
  const std::array<double, 3>& pitches = *extension.pitch_mm;
  return base::can_stretch(extension.lattice, 0) ? std::ranges::min(pitches) : pitches[0];
}

std::optional<base::Error> find_pitch_fault(const Extension& extension, const JsonPlace& place) {
  for (std::size_t axis = 0; extension.pitch_mm && axis < 3; ++axis) {
    const double pitch = (*extension.pitch_mm)[axis];
    if (pitch != pitch_unit(extension) && !base::can_stretch(extension.lattice, axis)) {
      return base::Error{
          base::ErrorCode::kBadInput,
          fmt::format(
              "the pitch differs by direction, {}; expected {} in the lattice {}",
              fmt::join(*extension.pitch_mm, ", "),
              base::can_stretch(extension.lattice, 2) ? "the same along x and y" : "one number",
              lattice_name(extension.lattice)),
          place.at(kPitchKey).pointer()};
    }
  }
  return std::nullopt;
}

/// Finds faults before the robot is made, because the robot does not know the file's names and
/// places.
std::optional<base::Error> find_fault(const Document& document) {
  const Extension& extension = document.extension;
  const JsonPlace top;
  const JsonPlace material = top.at("material");
  auto fault = find_fault(document.material, material);
  fault = fault ? fault : find_pitch_fault(extension, material);
  fault = fault ? fault : find_fault(extension.connectors, material);
  const JsonPlace kinds = top.at("kinds");
  for (const KindEntry& kind : extension.kinds) {
    const JsonPlace place = kinds.at(kind.name);
    const double mass = kind.mass_kg.value_or(1);
    if (!fault && !(mass >= kPositiveMin && mass <= kPositiveMax)) {
      fault = {base::ErrorCode::kBadInput,
               fmt::format("expected {} to {}, found {}", kPositiveMin, kPositiveMax, mass),
               place.at("mass_kg").pointer()};
    }
    fault = fault ? fault : find_fault(kind.connectors, place);
  }
  const JsonPlace connections = top.at("connections");
  for (std::size_t i = 0; !fault && i < extension.connections.size(); ++i) {
    fault = find_fault(extension.connections[i].connectors, connections.at(i));
  }
  return fault;
}

/// The pitch and the lattice, stretched where the pitch differs by direction.
struct Lengths {
  double pitch_mm = 0;
  base::Lattice lattice;
};

Lengths lengths_of(const Document& document) {
  const Extension& extension = document.extension;
  if (!extension.pitch_mm) {
    return {document.material.pitch_mm, extension.lattice};
  }
  std::array<double, 3> factors = *extension.pitch_mm;
  const double unit = pitch_unit(extension);
  for (double& factor : factors) {
    factor /= unit;
  }
  const double scale = document.material.pitch_mm / std::ranges::min(*extension.pitch_mm);
  return {unit * scale, base::stretched(extension.lattice, factors)};
}

/// All modules without a kind of their own first, then the document's kinds in their order.
std::vector<model::ModuleKind> kinds_of(const Document& document) {
  const Extension& extension = document.extension;
  const auto [pitch_mm, lattice] = lengths_of(document);
  model::Material material = document.material;
  material.pitch_mm = pitch_mm;
  model::ModuleKind plain = model::default_kind(material, lattice);
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

/// The parameters that modules of one step of the document have of their own; step 0 is the
/// existing modules.
struct OwnLists {
  std::vector<model::OwnKind>& kinds;
  std::vector<model::OwnMass>& masses;
};

/// The cell of a module with parameters of its own; none if the document has no such module.
const base::Cell* find_cell(const Document& document, const OwnParameters& own) {
  if (own.step == 0) {
    return own.module < document.modules.size() ? &document.modules[own.module].cell : nullptr;
  }
  if (own.step > document.steps.size()) {
    return nullptr;
  }
  const Step& step = document.steps[own.step - 1];
  return own.module < step.size() ? &step[own.module].cell : nullptr;
}

/// Gives modules their own kinds and masses; `lists(step)` are those of a step, or none. A mass
/// that is that of the kind says nothing.
template <class Lists>
std::optional<base::Error> add_own(const Document& document,
                                   const std::vector<model::ModuleKind>& kinds,
                                   const Lists& lists) {
  for (const OwnParameters& own : document.extension.own) {
    const base::Cell* const cell = find_cell(document, own);
    const std::optional<OwnLists> list = cell == nullptr ? std::nullopt : lists(own.step);
    if (!list) {
      continue;
    }
    const auto kind = std::ranges::find(kinds, own.kind, &model::ModuleKind::name);
    if (kind == kinds.end()) {
      return base::Error{base::ErrorCode::kBadInput,
                         fmt::format("the kind {} of {} is not in \"kinds\"", excerpt(own.kind),
                                     model::text(*cell)),
                         "/kinds"};
    }
    if (kind != kinds.begin()) {
      list->kinds.push_back({*cell, static_cast<std::uint16_t>(kind - kinds.begin())});
    }
    if (own.mass_kg && *own.mass_kg != kind->mass_kg) {
      list->masses.push_back({*cell, *own.mass_kg});
    }
  }
  return std::nullopt;
}

/// The existing modules and all around them, without parameters of single modules.
model::RobotSpec start_of(const Document& document) {
  const Extension& extension = document.extension;
  model::RobotSpec spec{.material = document.material,
                        .is_modulus_stated = document.is_default_modulus_stated,
                        .lattice = extension.lattice,
                        .floor = {.friction = extension.floor_friction},
                        .obstacles = extension.obstacles,
                        .gravity_m_s2 = extension.gravity_m_s2,
                        .foot_mm = extension.foot_mm};
  const Lengths lengths = lengths_of(document);
  spec.material.pitch_mm = lengths.pitch_mm;
  spec.lattice = lengths.lattice;
  spec.support_z = extension.has_floor ? std::optional(document.support_z) : std::nullopt;
  spec.existing.reserve(document.modules.size());
  for (const ModuleEntry& module : document.modules) {
    spec.existing.push_back(module.cell);
    if (module.is_fixed) {
      spec.fixed.push_back(module.cell);
    }
  }
  return spec;
}

/// Whether default_kind() is not all that there is.
bool has_kinds(const Document& document) {
  return document.extension.connectors != Connectors{} ||
         robot_connectors(document.extension.robot) != Connectors{};
}

std::vector<model::Step> steps_of(const Document& document) {
  std::vector<model::Step> steps;
  for (std::size_t i = first_step(document); i < document.steps.size(); ++i) {
    model::Step& step = steps.emplace_back();
    for (const PlannedEntry& entry : document.steps[i]) {
      step.attach.push_back(entry.cell);
    }
  }
  const std::vector<model::Step>& plan = document.extension.plan;
  steps.insert(steps.end(), plan.begin(), plan.end());
  return steps;
}

/// Puts loads on existing modules, and those on others into the steps that attach them.
void add_payloads(const Document& document, Sequence& sequence) {
  if (document.extension.payloads.empty()) {
    return;
  }
  const std::set<base::Cell> existing(sequence.start.existing.begin(),
                                      sequence.start.existing.end());
  for (const model::Payload& payload : document.extension.payloads) {
    const auto attaching =
        existing.contains(payload.cell)
            ? sequence.steps.end()
            : std::ranges::find_if(sequence.steps, [&](const model::Step& step) {
                return std::ranges::find(step.attach, payload.cell) != step.attach.end();
              });
    (attaching == sequence.steps.end() ? sequence.start.payloads : attaching->payloads)
        .push_back(payload);
  }
}

/// All loads but those on modules that later steps attach.
std::vector<model::Payload> present_payloads(const Document& document) {
  if (document.steps.size() <= 1 && document.extension.plan.empty()) {
    return document.extension.payloads;
  }
  Sequence sequence{.start = start_of(document), .steps = steps_of(document)};
  add_payloads(document, sequence);
  std::vector<model::Payload> present = std::move(sequence.start.payloads);
  if (!document.steps.empty() && first_step(document) == 0) {
    const std::vector<model::Payload>& planned = sequence.steps.front().payloads;
    present.insert(present.end(), planned.begin(), planned.end());
  }
  return present;
}

/// The existing modules and those of the planned step.
std::vector<base::Cell> present_cells(const Document& document) {
  std::vector<base::Cell> cells;
  std::ranges::transform(document.modules, std::back_inserter(cells), &ModuleEntry::cell);
  if (!document.steps.empty()) {
    std::ranges::transform(document.steps.front(), std::back_inserter(cells), &PlannedEntry::cell);
  }
  return cells;
}

bool is_connected(std::vector<base::Cell> cells, const base::Lattice& lattice) {
  model::RobotSpec alone{
      .existing = std::move(cells), .support_z = std::nullopt, .lattice = lattice};
  alone.fixed = {alone.existing.front()};
  return model::Robot::create(alone).has_value();
}

/// The unit in which cells seem to be counted, such as millimetres: the largest number that divides
/// all distances along the axes, if the robot is connected once they are divided by it; else 1.
std::int32_t unit_of(std::vector<base::Cell> cells, const base::Lattice& lattice) {
  const base::Cell first = cells.front();
  std::int32_t unit = 0;
  for (const base::Cell& cell : cells) {
    unit = std::gcd(unit, std::gcd(cell.x - first.x, std::gcd(cell.y - first.y, cell.z - first.z)));
  }
  if (unit <= 1) {
    return 1;
  }
  for (base::Cell& cell : cells) {
    cell = {(cell.x - first.x) / unit, (cell.y - first.y) / unit, (cell.z - first.z) / unit};
  }
  return is_connected(std::move(cells), lattice) ? unit : 1;
}

/// Whether a document's modules all hang above the floor, and nothing else could hold them.
bool stands_higher(const Document& document) {
  return document.extension.has_floor && document.extension.obstacles.empty() &&
         std::ranges::all_of(document.modules, [&](const ModuleEntry& module) {
           return !module.is_fixed && module.cell.z > document.support_z;
         });
}

}  // namespace

base::Error with_other_lattice(base::Error error, const Document& document) {
  if (document.modules.empty()) {
    return error;
  }
  const std::vector<base::Cell> cells = present_cells(document);
  if (is_connected(cells, document.extension.lattice)) {
    if (stands_higher(document)) {
      error.message += "; --support-z lowest takes its layer";
    }
    return error;
  }
  const auto other = std::ranges::find_if(kNamedLattices, [&](const NamedLattice& row) {
    return !document.is_lattice_chosen && row.lattice != document.extension.lattice &&
           is_connected(cells, row.lattice);
  });
  if (other != kNamedLattices.end()) {
    const auto* const modules =
        std::ranges::find(kSimulatedModules, other->lattice, &SimulatedModules::lattice);
    error.message +=
        fmt::format("; the lattice is {}, in {} it is connected: --lattice {}",
                    lattice_name(document.extension.lattice), other->name, modules->name);
  } else if (const std::int32_t unit = unit_of(cells, document.extension.lattice); unit > 1) {
    error.message += fmt::format(
        "; all cells lie {} apart: coordinates count cells, not lengths, so divide them by {}",
        unit, unit);
  }
  return error;
}

Document with_allowed_strengths(Document document) {
  const double factor = std::exchange(document.extension.safety_factor, 1);
  if (factor == 1) {
    return document;
  }
  const auto divide = [factor](Connectors& connectors) {
    for (ConnectorParameter& parameter : connectors.parameters) {
      if (is_strength_key(parameter.key)) {
        for (std::optional<double>& value : parameter.values) {
          value = value ? std::optional(*value / factor) : std::nullopt;
        }
      }
    }
  };
  Extension& extension = document.extension;
  document.material.strength_vertical_n /= factor;
  document.material.strength_lateral_n /= factor;
  // The robot's figures become the document's own, before those that override them.
  Connectors all = robot_connectors(extension.robot);
  all.parameters.insert(all.parameters.end(), extension.connectors.parameters.begin(),
                        extension.connectors.parameters.end());
  extension.connectors.parameters = std::move(all.parameters);
  divide(extension.connectors);
  for (KindEntry& kind : extension.kinds) {
    divide(kind.connectors);
  }
  for (ConnectionEntry& connection : extension.connections) {
    divide(connection.connectors);
  }
  return document;
}

base::Result<model::RobotSpec> make_spec(const Document& document) {
  if (document.extension.safety_factor != 1) {
    return make_spec(with_allowed_strengths(document));
  }
  if (auto error = find_fault(document)) {
    return *std::move(error);
  }
  model::RobotSpec spec = start_of(document);
  spec.payloads = present_payloads(document);
  if (!document.steps.empty()) {
    for (const PlannedEntry& planned : document.steps.front()) {
      spec.planned.push_back(planned.cell);
    }
  }
  std::vector<model::ModuleKind> kinds = kinds_of(document);
  const auto lists = [&](std::size_t step) {
    return step <= 1 ? std::optional(OwnLists{spec.own_kinds, spec.own_masses}) : std::nullopt;
  };
  if (auto error = add_own(document, kinds, lists)) {
    return *std::move(error);
  }
  std::set<base::Cell> cells;
  if (has_connections(document)) {
    cells.insert(spec.existing.begin(), spec.existing.end());
    cells.insert(spec.planned.begin(), spec.planned.end());
  }
  if (auto error = add_connections(document, kinds, cells, spec)) {
    return *std::move(error);
  }
  if (!spec.own_kinds.empty() || has_kinds(document)) {
    spec.kinds = std::move(kinds);
  }
  return spec;
}

std::size_t first_step(const Document& document) {
  return !document.steps.empty() && document.steps.front().empty() ? 1 : 0;
}

std::size_t step_count(const Document& document) {
  return document.steps.size() - first_step(document) + document.extension.plan.size();
}

std::string step_pointer(const Document& document, std::size_t step) {
  const std::size_t index = step + first_step(document);
  const bool is_xml = document.origin.format == Format::kVisibleSimXml;
  if (index >= document.steps.size()) {
    return fmt::format("/steps/{}{}", index - document.steps.size(),
                       is_xml ? fmt::format(" in <{}>", kExtensionElement) : "");
  }
  if (is_xml) {
    return fmt::format("<target format=\"grid\">, number {}", index + 1);
  }
  return index == 0 ? "/planned" : fmt::format("/later_steps/{}", index - 1);
}

std::string step_list(const Document& document) {
  if (document.origin.format == Format::kVisibleSimXml) {
    return document.extension.plan.empty() ? "<targetList>"
                                           : fmt::format("/steps in <{}>", kExtensionElement);
  }
  return document.extension.plan.empty() && document.steps.size() > 1 ? "/later_steps" : "/steps";
}

base::Result<Sequence> make_sequence(const Document& document) {
  if (document.extension.safety_factor != 1) {
    return make_sequence(with_allowed_strengths(document));
  }
  if (auto error = find_fault(document)) {
    return *std::move(error);
  }
  Sequence sequence{.start = start_of(document), .steps = steps_of(document)};
  add_payloads(document, sequence);
  std::vector<model::ModuleKind> kinds = kinds_of(document);
  const auto lists = [&, first = first_step(document)](std::size_t step) {
    model::RobotSpec& start = sequence.start;
    if (step == 0) {
      return std::optional(OwnLists{start.own_kinds, start.own_masses});
    }
    model::Step& attaching = sequence.steps[step - 1 - first];
    return std::optional(OwnLists{attaching.own_kinds, attaching.own_masses});
  };
  if (auto error = add_own(document, kinds, lists)) {
    return *std::move(error);
  }
  if (auto error = add_connections(document, kinds, cells_of(document), sequence.start)) {
    return *std::move(error);
  }
  const bool is_any_special = !sequence.start.own_kinds.empty() ||
                              std::ranges::any_of(sequence.steps, [](const model::Step& step) {
                                return !step.own_kinds.empty();
                              });
  if (is_any_special || has_kinds(document)) {
    sequence.start.kinds = std::move(kinds);
  }
  return sequence;
}

base::Result<model::Robot> make_robot(const Document& document, int thread_count) {
  auto made = make_spec(document);
  if (!made) {
    return made.error();
  }
  model::RobotSpec spec = std::move(made).value();
  spec.may_be_in_pieces = document.may_be_in_pieces;
  auto robot = model::Robot::create(spec, thread_count);
  if (!robot) {
    return with_other_lattice(robot.error(), document);
  }
  if (!robot.value().pieces().empty() && !document.is_lattice_chosen) {
    spec.may_be_in_pieces = false;
    const auto whole = model::Robot::create(spec, thread_count);
    if (!whole && with_other_lattice(whole.error(), document).message != whole.error().message) {
      base::Error error = with_other_lattice(whole.error(), document);
      error.message += fmt::format("; if it is in pieces: --lattice {}",
                                   lattice_name(document.extension.lattice));
      return error;
    }
  }
  return robot;
}

}  // namespace holdfast::io
