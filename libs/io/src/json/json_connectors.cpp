// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "json/json_connectors.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>

#include "holdfast/io/lattice_names.hpp"
#include "vocabulary.hpp"

namespace holdfast::io {
namespace {

constexpr double kUnlimited = model::ConnectorLaw::kUnlimited;

double positive_or_null(JsonReading& reading, const Json& value, const JsonPlace& place) {
  return value.is_null() ? kUnlimited : read_positive(reading, value, place);
}

/// Reads {"vertical": number, "lateral": number}; one of them may be absent.
std::vector<std::optional<double>> by_class(JsonReading& reading, const Json& value,
                                            const JsonPlace& place) {
  std::vector<std::optional<double>> values(kClassKeys.size());
  for (const auto& [key, member] : reading.members(value, place)) {
    const JsonPlace here = place.at(key);
    const auto found = std::ranges::find(kClassKeys, key);
    if (found != kClassKeys.end()) {
      values[static_cast<std::size_t>(found - kClassKeys.begin())] =
          positive_or_null(reading, member, here);
    } else {
      reading.note_unknown_key(here, kClassKeys);
    }
  }
  if (!values[0] && !values[1]) {
    reading.fail(place, "expected \"vertical\", \"lateral\" or both, found neither");
  }
  return values;
}

ConnectorParameter parameter(JsonReading& reading, const std::string& key, const Json& value,
                             const JsonPlace& place) {
  if (value.is_object()) {
    return {key, Spread::kClasses, by_class(reading, value, place)};
  }
  if (!value.is_array()) {
    if (!value.is_null() && !value.is_number()) {
      reading.refuse(value, place,
                     "a number, null, {\"vertical\": number, \"lateral\": number} or a list");
    }
    return {key, Spread::kAll, {positive_or_null(reading, value, place)}};
  }
  ConnectorParameter list{key, Spread::kPairs, {}};
  const Json::array_t& array = reading.elements(value, place);
  for (std::size_t i = 0; i < array.size() && !reading.has_failed(); ++i) {
    list.values.emplace_back(positive_or_null(reading, array[i], place.at(i)));
  }
  return list;
}

void check_pair_lists_of(JsonReading& reading, const Connectors& connectors,
                         const JsonPlace& place) {
  const base::Lattice& lattice = reading.document.extension.lattice;
  const auto pair_count = static_cast<std::size_t>(lattice.direction_count / 2);
  for (const ConnectorParameter& parameter : connectors.parameters) {
    if (parameter.spread == Spread::kPairs && parameter.values.size() != pair_count) {
      reading.fail(place.at(parameter.key),
                   fmt::format("expected a number for each of the {} pairs of directions of the "
                               "lattice \"{}\", found a list of {}",
                               pair_count, lattice_name(lattice), parameter.values.size()));
    }
  }
}

}  // namespace

std::optional<std::string> find_cv_fault(std::string_view key, double cv) {
  const double most = key == kScatterKeys[0] ? verdict::kCvMax : verdict::kMassCvMax;
  if (cv >= verdict::kCvMin && cv <= most) {
    return std::nullopt;
  }
  return fmt::format(
      "{}: expected a standard deviation over mean from {} to {}, such as 0.1 for 10 %, found {}",
      key, verdict::kCvMin, most, cv);
}

bool is_scatter_key(std::string_view key) {
  return std::ranges::find(kScatterKeys, key) != kScatterKeys.end();
}

void read_scatter(JsonReading& reading, const std::string& key, const Json& value,
                  const JsonPlace& place, Scatter& scatter) {
  if (key == kScatterKeys[2]) {
    const auto law = verdict::find_strength_distribution(reading.string(value, place));
    if (!law) {
      reading.refuse(value, place, "one of \"lognormal\", \"normal\", \"weibull\"");
    }
    scatter.distribution = law;
    return;
  }
  const double cv = reading.number(value, place);
  if (const auto fault = find_cv_fault(key, cv)) {
    reading.fail(place, *fault);
  }
  (key == kScatterKeys[0] ? scatter.strength_cv : scatter.mass_cv) = cv;
}

void read_connector_parameter(JsonReading& reading, const std::string& key, const Json& value,
                              const JsonPlace& place, Connectors& connectors) {
  if (key == kBendingKey) {
    connectors.bending =
        static_cast<model::BendingLaw>(read_choice(reading, value, place, kBendingNames));
  } else {
    connectors.parameters.push_back(parameter(reading, key, value, place));
  }
}

double read_not_negative(JsonReading& reading, const Json& value, const JsonPlace& place) {
  const double number = reading.number(value, place);
  if (!(number >= 0)) {
    reading.refuse(value, place, "a number that is not negative");
  }
  return number;
}

double read_positive(JsonReading& reading, const Json& value, const JsonPlace& place) {
  const double number = reading.number(value, place);
  if (!(number >= kPositiveMin)) {
    reading.refuse(value, place, fmt::format("a number of {} and more", kPositiveMin));
  }
  return number;
}

std::size_t read_choice(JsonReading& reading, const Json& value, const JsonPlace& place,
                        Names names) {
  const std::string name = reading.string(value, place);
  const auto found = std::ranges::find(names, name);
  if (found == names.end()) {
    reading.refuse(value, place, fmt::format("one of \"{}\"", fmt::join(names, "\", \"")));
    return 0;
  }
  return static_cast<std::size_t>(found - names.begin());
}

namespace {

/// Reads the pitches along the axes; where they are one number, that is the material's.
void read_pitches(JsonReading& reading, const Json& value, const JsonPlace& place) {
  const std::array<double, 3> pitches =
      reading.vector(value, place, "three numbers, such as [8, 8, 9.6]");
  for (std::size_t axis = 0; axis < pitches.size() && !reading.has_failed(); ++axis) {
    if (const auto fault = model::find_fault(*model::find_parameter(kPitchKey), pitches[axis])) {
      reading.fail(place.at(axis), *fault);
    }
  }
  const auto [least, most] = std::ranges::minmax(pitches);
  if (!reading.has_failed() && most > base::kStretchMax * least) {
    reading.fail(place, fmt::format("the longest pitch is {} times the shortest, expected up to {}",
                                    most / least, base::kStretchMax));
  }
  reading.document.material.pitch_mm = least;
  reading.document.extension.pitch_mm = least < most ? std::optional(pitches) : std::nullopt;
}

}  // namespace

bool is_material_extension(std::string_view key) {
  return key == kPitchKey || key == kFootKey || is_scatter_key(key) ||
         std::ranges::find(kConnectorKeys, key) != kConnectorKeys.end();
}

void read_material_extension(JsonReading& reading, const std::string& key, const Json& value,
                             const JsonPlace& place) {
  Extension& extension = reading.document.extension;
  if (key == kPitchKey) {
    read_pitches(reading, value, place);
  } else if (key == kFootKey) {
    extension.foot_mm = read_not_negative(reading, value, place);
  } else if (is_scatter_key(key)) {
    read_scatter(reading, key, value, place, extension.scatter);
  } else {
    read_connector_parameter(reading, key, value, place, extension.connectors);
  }
}

KindEntry read_kind(JsonReading& reading, const std::string& name, const Json& value,
                    const JsonPlace& place) {
  KindEntry kind{name, {}, {}, {}};
  for (const auto& [key, member] : reading.members(value, place)) {
    const JsonPlace here = place.at(key);
    if (key == "mass_kg") {
      kind.mass_kg = read_positive(reading, member, here);
      if (*kind.mass_kg > kPositiveMax) {
        reading.refuse(member, here, fmt::format("a number up to {}", kPositiveMax));
      }
    } else if (std::ranges::find(kClassStrengthKeys, key) != kClassStrengthKeys.end()) {
      kind.connectors.parameters.push_back(
          {key, Spread::kAll, {read_positive(reading, member, here)}});
    } else if (std::ranges::find(kConnectorKeys, key) != kConnectorKeys.end()) {
      read_connector_parameter(reading, key, member, here, kind.connectors);
    } else if (std::ranges::find(kKindScatterKeys, key) != kKindScatterKeys.end()) {
      read_scatter(reading, key, member, here, kind.scatter);
    } else {
      reading.note_unknown_key(here, kKindKeys);
    }
  }
  expect_one_strength(reading, value, place);
  return kind;
}

void expect_one_strength(JsonReading& reading, const Json& value, const JsonPlace& place) {
  const auto has = [&](std::string_view key) { return value.is_object() && value.contains(key); };
  if (has("strength_n") && std::ranges::any_of(kClassStrengthKeys, has)) {
    reading.fail(place.at("strength_n"),
                 "the strength stands here and in \"strength_vertical_n\" or "
                 "\"strength_lateral_n\", expected one of the two ways");
  }
}

void check_pair_lists(JsonReading& reading) {
  const Extension& extension = reading.document.extension;
  const JsonPlace top;
  check_pair_lists_of(reading, extension.connectors, top.at("material"));
  const JsonPlace kinds = top.at("kinds");
  for (const KindEntry& kind : extension.kinds) {
    check_pair_lists_of(reading, kind.connectors, kinds.at(kind.name));
  }
  const JsonPlace connections = top.at("connections");
  for (std::size_t i = 0; i < extension.connections.size(); ++i) {
    check_pair_lists_of(reading, extension.connections[i].connectors, connections.at(i));
  }
}

}  // namespace holdfast::io
