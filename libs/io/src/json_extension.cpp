// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "json_extension.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <optional>

#include "text_input.hpp"
#include "vocabulary.hpp"

namespace holdfast::io {
namespace {

using base::Cell;

double positive(JsonReading& reading, const Json& value, const Place& place) {
  const double number = reading.number(value, place);
  if (!(number > 0)) {
    reading.refuse(value, place, "a positive number");
  }
  return number;
}

/// A coefficient of friction.
double friction(JsonReading& reading, const Json& value, const Place& place) {
  const double number = reading.number(value, place);
  if (!(number >= 0)) {
    reading.refuse(value, place, "a number that is not negative");
  }
  return number;
}

std::array<double, 3> vector(JsonReading& reading, const Json& value, const Place& place) {
  const Json::array_t& array = reading.elements(value, place);
  std::array<double, 3> numbers{};
  if (array.size() != numbers.size()) {
    reading.fail(place,
                 fmt::format("found an array of {}, expected are three numbers", array.size()));
    return numbers;
  }
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    numbers[i] = reading.number(array[i], place.at(i));
  }
  return numbers;
}

/// The index of a name, an enumerator; 0, and a failure, if it is none of them.
std::size_t choice(JsonReading& reading, const Json& value, const Place& place, Names names) {
  const std::string name = reading.string(value, place);
  const auto found = std::ranges::find(names, name);
  if (found == names.end()) {
    reading.refuse(value, place, fmt::format("one of \"{}\"", fmt::join(names, "\", \"")));
    return 0;
  }
  return static_cast<std::size_t>(found - names.begin());
}

/// Calls take(element, its place) for every element of an array that takes up cells.
template <class Take>
void for_each_element(JsonReading& reading, const Json& value, const Place& place,
                      const Take& take) {
  const Json::array_t& array = reading.elements(value, place);
  if (reading.take_room(array.size(), [&] { return place.pointer(); })) {
    for (std::size_t i = 0; i < array.size() && !reading.has_failed(); ++i) {
      take(array[i], place.at(i));
    }
  }
}

/// What read(reading, element, its place) makes of every element of an array.
template <class Read>
auto list_of(JsonReading& reading, const Json& value, const Place& place, const Read& read) {
  std::vector<decltype(read(reading, value, place))> list;
  for_each_element(reading, value, place, [&](const Json& element, const Place& here) {
    list.push_back(read(reading, element, here));
  });
  return list;
}

Cell cell(JsonReading& reading, const Json& value, const Place& place) {
  return reading.cell(value, place);
}

std::vector<Cell> cells(JsonReading& reading, const Json& value, const Place& place) {
  return list_of(reading, value, place, cell);
}

std::vector<CellPair> pairs(JsonReading& reading, const Json& value, const Place& place) {
  std::vector<CellPair> list;
  for_each_element(reading, value, place, [&](const Json& element, const Place& here) {
    const std::vector<Cell> ends = cells(reading, element, here);
    if (ends.size() == 2) {
      list.push_back({ends[0], ends[1]});
    } else {
      reading.fail(
          here, fmt::format("found {} cells, expected are the two of a connection", ends.size()));
    }
  });
  return list;
}

/// A failure if an object lacks a key that it must have.
void demand(JsonReading& reading, const Json& value, const Place& place, std::string_view key) {
  if (value.is_object() && !value.contains(key)) {
    reading.fail(place.at(key), fmt::format("\"{}\" is missing", key));
  }
}

void read_lattice(JsonReading& reading, const Json& value, const Place& place) {
  reading.document.extension.lattice =
      static_cast<LatticeName>(choice(reading, value, place, kLatticeNames));
}

void read_floor(JsonReading& reading, const Json& value, const Place& place) {
  for (const auto& [key, member] : reading.members(value, place)) {
    const Place here = place.at(key);
    if (key == "friction") {
      reading.document.extension.floor_friction = friction(reading, member, here);
    } else {
      reading.note_unknown_key(here, kFloorKeys);
    }
  }
}

/// Straight down it is what the material says, which version 1 can say too.
void read_gravity(JsonReading& reading, const Json& value, const Place& place) {
  const std::array<double, 3> gravity = vector(reading, value, place);
  Document& document = reading.document;
  if (gravity[0] == 0 && gravity[1] == 0 && gravity[2] < 0) {
    document.material.gravity_m_s2 = -gravity[2];
  } else {
    document.extension.gravity_m_s2 = gravity;
  }
}

NamedNumbers kind_parameters(JsonReading& reading, const Json& value, const Place& place) {
  NamedNumbers parameters;
  for (const auto& [key, member] : reading.members(value, place)) {
    const Place here = place.at(key);
    if (std::ranges::find(kKindKeys, key) != kKindKeys.end()) {
      parameters.emplace_back(key, positive(reading, member, here));
    } else {
      reading.note_unknown_key(here, kKindKeys);
    }
  }
  return parameters;
}

void read_kinds(JsonReading& reading, const Json& value, const Place& place) {
  for (const auto& [name, member] : reading.members(value, place)) {
    const Place here = place.at(name);
    if (const auto fault = find_string_fault(name); fault || name.empty()) {
      reading.fail(here, "the name of a kind is empty or no printable text");
    }
    reading.document.extension.kinds.push_back({name, kind_parameters(reading, member, here)});
  }
}

Obstacle obstacle(JsonReading& reading, const Json& value, const Place& place) {
  Obstacle found;
  bool is_list = false;
  for (const auto& [key, member] : reading.members(value, place)) {
    const Place here = place.at(key);
    if (key == "from") {
      found.from = reading.cell(member, here);
    } else if (key == "to") {
      found.to = reading.cell(member, here);
    } else if (key == "cells") {
      found.cells = cells(reading, member, here);
      is_list = true;
    } else if (key == "hold") {
      found.hold = static_cast<Hold>(choice(reading, member, here, kHoldNames));
    } else if (key == "friction") {
      found.friction = friction(reading, member, here);
    } else {
      reading.note_unknown_key(here, kObstacleKeys);
    }
  }
  const bool is_box = value.is_object() && value.contains("from") && value.contains("to");
  const bool has_corner = value.is_object() && (value.contains("from") || value.contains("to"));
  if (is_list ? has_corner || found.cells.empty() : !is_box) {
    reading.fail(place, "expected are either \"from\" and \"to\", or \"cells\" with at least one");
  }
  if (found.to.x < found.from.x || found.to.y < found.from.y || found.to.z < found.from.z) {
    reading.fail(place, "no coordinate of \"to\" may be below that of \"from\"");
  }
  return found;
}

void read_obstacles(JsonReading& reading, const Json& value, const Place& place) {
  reading.document.extension.obstacles = list_of(reading, value, place, obstacle);
}

Payload payload(JsonReading& reading, const Json& value, const Place& place) {
  Payload found;
  demand(reading, value, place, "cell");
  for (const auto& [key, member] : reading.members(value, place)) {
    const Place here = place.at(key);
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
  return found;
}

void read_loads(JsonReading& reading, const Json& value, const Place& place) {
  reading.document.extension.payloads = list_of(reading, value, place, payload);
}

Move move(JsonReading& reading, const Json& value, const Place& place) {
  Move found;
  demand(reading, value, place, "from");
  demand(reading, value, place, "to");
  for (const auto& [key, member] : reading.members(value, place)) {
    const Place here = place.at(key);
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

PlanStep plan_step(JsonReading& reading, const Json& value, const Place& place) {
  PlanStep step;
  for (const auto& [key, member] : reading.members(value, place)) {
    const Place here = place.at(key);
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
    } else {
      reading.note_unknown_key(here, kStepKeys);
    }
  }
  return step;
}

void read_steps(JsonReading& reading, const Json& value, const Place& place) {
  reading.document.extension.plan = list_of(reading, value, place, plan_step);
}

/// The readers of kExtensionKeys, in their order.
constexpr void (*kReaders[])(JsonReading&, const Json&, const Place&) = {
    read_lattice, read_floor, read_gravity, read_kinds, read_obstacles, read_loads, read_steps};
static_assert(std::size(kReaders) == kExtensionKeys.size());

}  // namespace

void read_extension_member(JsonReading& reading, std::string_view key, const Json& value,
                           const Place& place) {
  const auto found = std::ranges::find(kExtensionKeys, key);
  kReaders[found - kExtensionKeys.begin()](reading, value, place);
}

void read_connector_parameter(JsonReading& reading, const std::string& key, const Json& value,
                              const Place& place) {
  reading.document.extension.connectors.emplace_back(key, positive(reading, value, place));
}

void read_own_parameter(JsonReading& reading, std::string_view key, const Json& value,
                        const Place& place, OwnParameters& own) {
  if (key == "kind") {
    own.kind = reading.string(value, place);
    if (own.kind.empty()) {
      reading.refuse(value, place, "the name of a kind");
    }
  } else {
    own.mass_kg = positive(reading, value, place);
  }
}

void check_kinds(JsonReading& reading) {
  const Extension& extension = reading.document.extension;
  for (const OwnParameters& own : extension.own) {
    if (!own.kind.empty() &&
        std::ranges::find(extension.kinds, own.kind, &ModuleKind::name) == extension.kinds.end()) {
      reading.fail({base::ErrorCode::kBadInput,
                    fmt::format("the kind {} is none of those in \"kinds\"", excerpt(own.kind)),
                    fmt::format("/modules/{}/kind", own.module)});
    }
  }
}

}  // namespace holdfast::io
