// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "json/json_extension.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <iterator>
#include <optional>
#include <utility>

#include "holdfast/host/text.hpp"
#include "json/json_connectors.hpp"
#include "json/json_shapes.hpp"
#include "text_input.hpp"
#include "vocabulary.hpp"

namespace holdfast::io {
namespace {

using base::Cell;

std::array<double, 3> vector(JsonReading& reading, const Json& value, const JsonPlace& place) {
  return reading.vector(value, place, "three numbers, such as [0, 0, -9.81]");
}

/// Calls take(element, its place) for every element of an array that takes up cells.
template <class Take>
void for_each_element(JsonReading& reading, const Json& value, const JsonPlace& place,
                      const Take& take) {
  const Json::array_t& array = reading.elements(value, place);
  if (reading.take_room(array.size(), [&] { return place.pointer(); })) {
    for (std::size_t i = 0; i < array.size() && !reading.has_failed(); ++i) {
      take(array[i], place.at(i));
    }
  }
}

/// The list of read(reading, element, its place) for every element of an array.
template <class Read>
auto list_of(JsonReading& reading, const Json& value, const JsonPlace& place, const Read& read) {
  std::vector<decltype(read(reading, value, place))> list;
  for_each_element(reading, value, place, [&](const Json& element, const JsonPlace& here) {
    list.push_back(read(reading, element, here));
  });
  return list;
}

Cell cell(JsonReading& reading, const Json& value, const JsonPlace& place) {
  return reading.cell(value, place);
}

std::vector<Cell> cells(JsonReading& reading, const Json& value, const JsonPlace& place) {
  return list_of(reading, value, place, cell);
}

model::CellPair pair(JsonReading& reading, const Json& value, const JsonPlace& place) {
  const std::vector<Cell> ends = cells(reading, value, place);
  if (ends.size() != 2) {
    reading.fail(place,
                 fmt::format("expected the two cells of a connection, found {}", ends.size()));
    return {};
  }
  return {ends[0], ends[1]};
}

std::vector<model::CellPair> pairs(JsonReading& reading, const Json& value,
                                   const JsonPlace& place) {
  return list_of(reading, value, place, pair);
}

/// A failure if an object lacks a key that it must have.
void demand(JsonReading& reading, const Json& value, const JsonPlace& place, std::string_view key) {
  if (value.is_object() && !value.contains(key)) {
    reading.fail_missing(value, place, key);
  }
}

void read_safety_factor(JsonReading& reading, const Json& value, const JsonPlace& place) {
  const double factor = reading.number(value, place);
  if (!(factor >= 1 && factor <= kSafetyFactorMax)) {
    reading.refuse(value, place, fmt::format("a number from 1 to {}", kSafetyFactorMax));
  }
  reading.document.extension.safety_factor = factor;
}

void read_floor(JsonReading& reading, const Json& value, const JsonPlace& place) {
  for (const auto& [key, member] :
       reading.members(value, place, "an object such as {\"friction\": 0.5}")) {
    const JsonPlace here = place.at(key);
    if (key == "friction") {
      reading.document.extension.floor_friction = read_not_negative(reading, member, here);
    } else {
      reading.note_unknown_key(here, kFloorKeys);
    }
  }
}

/// Reads gravity; if it points straight down, it becomes that of the material, which version 1 can
/// say.
void read_gravity(JsonReading& reading, const Json& value, const JsonPlace& place) {
  const std::array<double, 3> gravity = vector(reading, value, place);
  Document& document = reading.document;
  if (!reading.has_failed() && gravity == std::array<double, 3>{}) {
    reading.fail(place,
                 "gravity is zero, expected a vector: without weight a robot rests on nothing, and "
                 "there is nothing to hold; where loads are meant to act alone, give a tiny one, "
                 "such as [0, 0, -1e-9]");
  }
  if (gravity[0] == 0 && gravity[1] == 0 && gravity[2] < 0) {
    document.material.gravity_m_s2 = -gravity[2];
    if (const auto fault = model::find_fault(*model::find_parameter("gravity_m_s2"), -gravity[2])) {
      reading.fail(place, "the size of " + *fault);
    }
  } else {
    document.extension.gravity_m_s2 = gravity;
  }
}

void read_kinds(JsonReading& reading, const Json& value, const JsonPlace& place) {
  for (const auto& [name, member] :
       reading.members(value, place, "an object such as {\"battery\": {\"mass_kg\": 0.2}}")) {
    const JsonPlace here = place.at(name);
    if (const auto fault = find_string_fault(name); fault || name.empty()) {
      reading.fail(here, "the name of a kind is empty or no printable text");
    }
    reading.document.extension.kinds.push_back(read_kind(reading, name, member, here));
  }
}

void read_joined(JsonReading& reading, const Json& value, const JsonPlace& place) {
  reading.document.extension.joins_listed = read_choice(reading, value, place, kJoinedNames) == 1;
}

void read_open(JsonReading& reading, const Json& value, const JsonPlace& place) {
  reading.document.extension.open = pairs(reading, value, place);
}

ConnectionEntry connection(JsonReading& reading, const Json& value, const JsonPlace& place) {
  ConnectionEntry entry;
  demand(reading, value, place, kBetweenKey);
  for (const auto& [key, member] :
       reading.members(value, place, "an object such as {\"between\": [[0,0,0], [0,0,1]]}")) {
    const JsonPlace here = place.at(key);
    if (key == kBetweenKey) {
      entry.between = pair(reading, member, here);
    } else if (std::ranges::find(kConnectorKeys, key) != kConnectorKeys.end()) {
      read_connector_parameter(reading, key, member, here, entry.connectors);
    } else if (std::ranges::find(kConnectionScatterKeys, key) != kConnectionScatterKeys.end()) {
      read_scatter(reading, key, member, here, entry.scatter);
    } else {
      reading.note_unknown_key(here, kConnectionKeys);
    }
  }
  return entry;
}

void read_connections(JsonReading& reading, const Json& value, const JsonPlace& place) {
  reading.document.extension.connections = list_of(reading, value, place, connection);
}

std::vector<Cell> body(JsonReading& reading, const Json& value, const JsonPlace& place) {
  std::vector<Cell> found;
  for_each_element(reading, value, place, [&](const Json& element, const JsonPlace& here) {
    if (is_shape(element)) {
      for (const auto& [key, member] : reading.members(element, here)) {
        if (std::ranges::find(kShapeKeys, key) == kShapeKeys.end()) {
          reading.note_unknown_key(here.at(key), kShapeKeys);
        }
      }
      const std::vector<Cell> shape = shape_cells(reading, element, here);
      found.insert(found.end(), shape.begin(), shape.end());
    } else {
      found.push_back(reading.cell(element, here));
    }
  });
  if (found.empty()) {
    reading.fail(place, "expected at least one cell, found an empty array");
  }
  return found;
}

void read_bodies(JsonReading& reading, const Json& value, const JsonPlace& place) {
  reading.document.extension.bodies = list_of(reading, value, place, body);
}

struct ColoredObstacle {
  model::Obstacle obstacle;
  std::optional<Color> color;
};

ColoredObstacle obstacle(JsonReading& reading, const Json& value, const JsonPlace& place) {
  ColoredObstacle colored;
  model::Obstacle& found = colored.obstacle;
  bool is_list = false;
  for (const auto& [key, member] :
       reading.members(value, place, "an object with \"from\" and \"to\", or with \"cells\"")) {
    const JsonPlace here = place.at(key);
    if (key == "from") {
      found.from = reading.cell(member, here);
    } else if (key == "to") {
      found.to = reading.cell(member, here);
    } else if (key == "cells") {
      found.cells = cells(reading, member, here);
      is_list = true;
    } else if (key == "hold") {
      found.touch.hold = static_cast<model::Hold>(read_choice(reading, member, here, kHoldNames));
    } else if (key == "friction") {
      found.touch.friction = read_not_negative(reading, member, here);
    } else if (key == "color") {
      colored.color = reading.color(member, here);
    } else {
      reading.note_unknown_key(here, kObstacleKeys);
    }
  }
  const bool is_box = value.is_object() && value.contains("from") && value.contains("to");
  const bool has_corner = value.is_object() && (value.contains("from") || value.contains("to"));
  if (is_list ? has_corner || found.cells.empty() : !is_box) {
    reading.fail(place, "expected either \"from\" and \"to\", or \"cells\" with at least one");
  }
  reading.expect_corners(found.from, found.to, place);
  return colored;
}

void read_obstacles(JsonReading& reading, const Json& value, const JsonPlace& place) {
  Extension& extension = reading.document.extension;
  bool is_colored = false;
  for (ColoredObstacle& found : list_of(reading, value, place, obstacle)) {
    extension.obstacles.push_back(std::move(found.obstacle));
    extension.obstacle_colors.push_back(found.color);
    is_colored = is_colored || found.color;
  }
  if (!is_colored) {
    extension.obstacle_colors.clear();
  }
}

model::Payload payload(JsonReading& reading, const Json& value, const JsonPlace& place) {
  model::Payload found;
  demand(reading, value, place, "cell");
  for (const auto& [key, member] :
       reading.members(value, place, "an object with \"cell\" and \"force_n\"")) {
    const JsonPlace here = place.at(key);
    if (key == "cell") {
      found.cell = reading.cell(member, here);
    } else if (key == "force_n") {
      found.force_n = vector(reading, member, here);
    } else if (key == "torque_nmm") {
      found.torque_nmm = vector(reading, member, here);
    } else {
      reading.note_unknown_key(here, kLoadKeys);
    }
  }
  if (value.is_object() && !value.contains("force_n") && !value.contains("torque_nmm")) {
    reading.fail(place, "expected \"force_n\", \"torque_nmm\" or both, found neither");
  }
  return found;
}

void read_loads(JsonReading& reading, const Json& value, const JsonPlace& place) {
  reading.document.extension.payloads = list_of(reading, value, place, payload);
}

model::Move move(JsonReading& reading, const Json& value, const JsonPlace& place) {
  model::Move found;
  demand(reading, value, place, "from");
  demand(reading, value, place, "to");
  for (const auto& [key, member] : reading.members(value, place)) {
    const JsonPlace here = place.at(key);
    if (key == "from") {
      found.from = reading.cell(member, here);
    } else if (key == "to") {
      found.to = reading.cell(member, here);
    } else if (key == "carrier") {
      found.carrier = reading.cell(member, here);
    } else {
      reading.note_unknown_key(here, kMoveKeys);
    }
  }
  return found;
}

model::Step plan_step(JsonReading& reading, const Json& value, const JsonPlace& place) {
  model::Step step;
  for (const auto& [key, member] :
       reading.members(value, place, "an object such as {\"attach\": [[0, 0, 1]]}")) {
    const JsonPlace here = place.at(key);
    if (key == "attach") {
      step.attach = cells(reading, member, here);
    } else if (key == "detach") {
      step.detach = cells(reading, member, here);
    } else if (key == "move") {
      step.moves = list_of(reading, member, here, move);
    } else if (key == "release") {
      step.release = pairs(reading, member, here);
    } else if (key == "connect") {
      step.connect = pairs(reading, member, here);
    } else if (key == kAnyOrderKey) {
      step.is_any_order = reading.boolean(member, here);
    } else if (key == kApartKey) {
      step.is_apart = reading.boolean(member, here);
    } else {
      reading.note_unknown_key(here, kStepKeys);
    }
  }
  if (step == model::Step{.is_any_order = step.is_any_order, .is_apart = step.is_apart}) {
    reading.fail(place, fmt::format("expected an entry in at least one of \"{}\", found none",
                                    fmt::join(kStepLists, "\", \"")));
  }
  const bool is_one_list = step == model::Step{.attach = step.attach, .is_any_order = true} ||
                           step == model::Step{.detach = step.detach, .is_any_order = true};
  if (step.is_any_order && !is_one_list) {
    reading.fail(place.at(kAnyOrderKey),
                 "only a step that attaches, or only detaches, is done in any order: expected "
                 "nothing else beside \"attach\" or \"detach\"");
  }
  if (step.is_apart && step.attach.empty()) {
    reading.fail(place.at(kApartKey), "only attached modules stand apart: expected \"attach\"");
  }
  return step;
}

void read_steps(JsonReading& reading, const Json& value, const JsonPlace& place) {
  reading.document.extension.plan = list_of(reading, value, place, plan_step);
}

/// Skips a member that is read before all others.
void pass_over(JsonReading& /*reading*/, const Json& /*value*/, const JsonPlace& /*place*/) {}

/// The JSON pointer to a module that has parameters of its own.
std::string own_place(const OwnParameters& own) {
  const std::string list = own.step == 0   ? "/modules"
                           : own.step == 1 ? "/planned"
                                           : fmt::format("/later_steps/{}", own.step - 2);
  return fmt::format("{}/{}", list, own.module);
}

/// The readers of kExtensionKeys, in their order.
constexpr void (*kReaders[])(JsonReading&, const Json&, const JsonPlace&) = {
    pass_over,      pass_over,   read_safety_factor, read_floor,       read_gravity,
    read_kinds,     read_joined, read_open,          read_connections, read_bodies,
    read_obstacles, read_loads,  read_steps};
static_assert(std::size(kReaders) == kExtensionKeys.size());

}  // namespace

void read_extension_member(JsonReading& reading, std::string_view key, const Json& value,
                           const JsonPlace& place) {
  const auto found = std::ranges::find(kExtensionKeys, key);
  kReaders[found - kExtensionKeys.begin()](reading, value, place);
}

void read_own_parameter(JsonReading& reading, std::string_view key, const Json& value,
                        const JsonPlace& place, OwnParameters& own) {
  if (key == "kind") {
    own.kind = reading.string(value, place);
    if (own.kind.empty()) {
      reading.refuse(value, place, "the name of a kind");
    }
  } else {
    own.mass_kg = read_positive(reading, value, place);
  }
}

namespace {

/// Translates a JSON pointer into the terms of a VisibleSim file: an attribute of a block, or a
/// pointer into <extension>.
std::string place_in_xml(const Document& document, const std::string& pointer) {
  for (const OwnParameters& own : document.extension.own) {
    if (pointer == own_place(own) + "/kind") {
      const bool is_module = own.step == 0;
      const Cell& cell = is_module ? document.modules[own.module].cell
                                   : document.steps[own.step - 1][own.module].cell;
      return fmt::format("{} of <{}> at {}", kOwnKindAttribute, is_module ? "block" : "cell",
                         model::text(cell));
    }
  }
  return fmt::format("{} in <{}>", pointer, kExtensionElement);
}

}  // namespace

void read_extension_text(Reading& reading, std::string_view text, const Reading::Where& where) {
  JsonReading json;
  json.allows_unknown = reading.allows_unknown;
  json.document.material = reading.document.material;
  json.document.extension = reading.document.extension;
  const auto root = parse_json(text);
  if (!root) {
    reading.fail({root.error().code,
                  fmt::format("in <{}>: {}", kExtensionElement, root.error().message), where()});
    return;
  }
  const JsonPlace top;
  for (const auto& [key, value] : json.members(root.value(), top)) {
    const JsonPlace here = top.at(key);
    if (key == "support_z" && value.is_null()) {
      json.document.extension.has_floor = false;
    } else if (key == "material") {
      for (const auto& [name, member] : json.members(value, here)) {
        if (is_material_extension(name)) {
          read_material_extension(json, name, member, here.at(name));
        } else {
          json.note_unknown_key(here.at(name), kConnectorKeys);
        }
      }
      expect_one_strength(json, value, here);
    } else if (std::ranges::find(kExtensionKeys, key) != kExtensionKeys.end()) {
      read_extension_member(json, key, value, here);
    } else {
      json.note_unknown_key(here, kExtensionKeys);
    }
  }
  check_kinds(json);
  check_pair_lists(json);
  auto read = std::move(json).finish();
  if (read) {
    ReadDocument found = std::move(read).value();
    reading.document.material = found.document.material;
    reading.document.extension = std::move(found.document.extension);
    for (std::string& warning : found.warnings) {
      reading.warn(std::move(warning), where);
    }
  } else {
    reading.fail({read.error().code,
                  fmt::format("{}: {}", place_in_xml(reading.document, read.error().where),
                              read.error().message),
                  where()});
  }
}

void check_kinds(JsonReading& reading) {
  Extension& extension = reading.document.extension;
  std::vector<std::string_view> names;
  std::ranges::transform(extension.kinds, std::back_inserter(names), &KindEntry::name);
  std::ranges::sort(extension.own, {},
                    [](const OwnParameters& own) { return std::pair(own.step, own.module); });
  for (const OwnParameters& own : extension.own) {
    if (!own.kind.empty() && std::ranges::find(names, own.kind) == names.end()) {
      reading.fail(
          {base::ErrorCode::kBadInput,
           fmt::format("the kind {} is not in \"kinds\", which has {}", excerpt(own.kind),
                       names.empty() ? "none" : excerpt(fmt::format("{}", fmt::join(names, ", ")))),
           own_place(own) + "/kind"});
    }
  }
}

}  // namespace holdfast::io
