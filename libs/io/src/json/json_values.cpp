// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "json/json_values.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>
#include <limits>
#include <utility>

#include "text_input.hpp"
#include "vocabulary.hpp"

namespace holdfast::io {
namespace {

constexpr std::size_t kKeysShownMax = 6;
constexpr std::size_t kKeyShownMax = 20;

/// A value for a message.
std::string describe(const Json& value) {
  if (value.is_string()) {
    return excerpt(value.get_ref<const std::string&>());
  }
  if (!value.is_object()) {
    return value.is_array() ? fmt::format("an array of {}", value.size()) : value.dump();
  }
  std::string text = value.empty() ? "an empty object" : "an object with ";
  std::size_t count = 0;
  for (const auto& [key, member] : value.get_ref<const Json::object_t&>()) {
    if (++count > kKeysShownMax) {
      return text + ", ...";
    }
    text += (count == 1 ? "" : ", ") + excerpt(std::string_view(key).substr(0, kKeyShownMax));
  }
  return text;
}

/// The value as a T of the tree, or a failure and an empty T.
template <class T>
const T& take(JsonReading& reading, const Json& value, const JsonPlace& place,
              std::string_view expected) {
  static const T kNone{};
  const auto* found = value.get_ptr<const T*>();
  if (found == nullptr) {
    reading.refuse(value, place, expected);
    return kNone;
  }
  return *found;
}

}  // namespace

std::string JsonPlace::pointer() const {
  std::string text;
  for (const JsonPlace* place = this; place->parent != nullptr; place = place->parent) {
    if (text.size() > kPointerShownMax) {
      return "..." + text;
    }
    text.insert(0,
                "/" + (place->index ? std::to_string(*place->index) : pointer_token(place->key)));
  }
  return text;
}

void JsonReading::fail(const JsonPlace& place, std::string message) {
  fail({base::ErrorCode::kBadInput, std::move(message), place.pointer()});
}

void JsonReading::fail_missing(const Json& object, const JsonPlace& place, std::string_view key,
                               std::string_view expected) {
  std::string found = describe(object);
  for (const auto& [name, value] : object.items()) {
    if (near_miss(name, {&key, 1})) {
      found = excerpt(name) + ", " + did_you_mean(key);
    }
  }
  fail(place, fmt::format("key \"{}\" is missing{}{}; found {}", key,
                          expected.empty() ? "" : ", expected ", expected, found));
}

void JsonReading::refuse(const Json& value, const JsonPlace& place, std::string_view expected) {
  fail(place, fmt::format("expected {}, found {}", expected, describe(value)));
}

void JsonReading::note_unknown_key(const JsonPlace& place, Names known) {
  if (place.key.starts_with("x-")) {
    return;
  }
  const std::string what = fmt::format("the key {}", excerpt(place.key));
  note_unknown(what, place.key, known, "ignored", [&] { return place.pointer(); });
  if (!allows_unknown) {
    fail(place, fmt::format("{} is unknown, expected {} or a key of your own that begins with x-",
                            what, fmt::join(known, ", ")));
  }
}

const Json::object_t& JsonReading::members(const Json& value, const JsonPlace& place,
                                           std::string_view expected) {
  return take<Json::object_t>(*this, value, place, expected);
}

const Json::array_t& JsonReading::elements(const Json& value, const JsonPlace& place,
                                           std::string_view expected) {
  return take<Json::array_t>(*this, value, place, expected);
}

std::string JsonReading::string(const Json& value, const JsonPlace& place) {
  const auto& text = take<Json::string_t>(*this, value, place, "a string");
  if (const auto fault = find_string_fault(text)) {
    fail(place, fmt::format("the string {}", *fault));
  }
  return text;
}

bool JsonReading::boolean(const Json& value, const JsonPlace& place) {
  return take<Json::boolean_t>(*this, value, place, "true or false");
}

double JsonReading::number(const Json& value, const JsonPlace& place) {
  if (!value.is_number()) {
    refuse(value, place, "a number");
    return 0;
  }
  return value.get<double>() + 0.0;  // -0, which some write as an integer, is 0.
}

std::int32_t JsonReading::integer(const Json& value, const JsonPlace& place, IntegerRange range) {
  const double number =
      value.is_number() ? value.get<double>() : std::numeric_limits<double>::quiet_NaN();
  if (!range.contains(number) || number != std::trunc(number)) {
    refuse(value, place, fmt::format("an integer from {} to {}", range.lowest, range.highest));
    return 0;
  }
  return static_cast<std::int32_t>(number);
}

std::array<std::int32_t, 3> JsonReading::triple(const Json& value, const JsonPlace& place,
                                                IntegerRange range) {
  const Json::array_t& array = elements(value, place, "three integers, such as [0, 0, 1]");
  std::array<std::int32_t, 3> triple{};
  if (array.size() != triple.size()) {
    fail(place, fmt::format("expected three integers, found an array of {}", array.size()));
    return triple;
  }
  for (std::size_t i = 0; i < triple.size(); ++i) {
    triple[i] = integer(array[i], place.at(i), range);
  }
  return triple;
}

std::array<double, 3> JsonReading::vector(const Json& value, const JsonPlace& place,
                                          std::string_view expected) {
  const Json::array_t& array = elements(value, place, expected);
  std::array<double, 3> numbers{};
  if (array.size() != numbers.size()) {
    fail(place, fmt::format("expected three numbers, found an array of {}", array.size()));
    return numbers;
  }
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    numbers[i] = number(array[i], place.at(i));
  }
  return numbers;
}

base::Cell JsonReading::cell(const Json& value, const JsonPlace& place) {
  const auto [x, y, z] = triple(value, place, kCoordinateRange);
  return {x, y, z};
}

void JsonReading::expect_corners(const base::Cell& from, const base::Cell& to,
                                 const JsonPlace& place) {
  if (to.x < from.x || to.y < from.y || to.z < from.z) {
    fail(place, "no coordinate of \"to\" may be below that of \"from\"");
  }
}

Color JsonReading::color(const Json& value, const JsonPlace& place) {
  const auto [red, green, blue] = triple(value, place, kColorRange);
  return {red, green, blue};
}

Attributes JsonReading::attributes(const Json& value, const JsonPlace& place,
                                   bool (*is_reserved)(std::string_view name)) {
  Attributes attributes;
  for (const auto& [key, member] : members(value, place)) {
    const JsonPlace here = place.at(key);
    if (const auto fault = find_name_fault(key)) {
      fail(here, *fault);
    } else if (is_reserved(key)) {
      fail(here, fmt::format("{} has a key of its own in this format", excerpt(key)));
    }
    attributes.emplace_back(key, string(member, here));
  }
  return attributes;
}

Element JsonReading::element(const Json& value, const JsonPlace& place, int depth) {
  Element element;
  if (depth > kSceneryNestingMax) {
    fail(place, fmt::format("elements nested deeper than the {} allowed", kSceneryNestingMax));
    return element;
  }
  for (const auto& [key, member] : members(value, place)) {
    const JsonPlace here = place.at(key);
    if (key == "element") {
      element.name = string(member, here);
    } else if (key == "attributes") {
      element.attributes = attributes(member, here, [](std::string_view) { return false; });
    } else if (key == "text") {
      element.text = trimmed(string(member, here));
    } else if (key == "children") {
      element.children = element_list(member, here, depth + 1);
    } else {
      note_unknown_key(here, kElementKeys);
    }
  }
  if (value.is_object() && !value.contains("element")) {
    fail_missing(value, place, "element");
  } else if (const auto fault = find_name_fault(element.name)) {
    fail(place.at("element"), *fault);
  }
  return element;
}

std::vector<Element> JsonReading::element_list(const Json& value, const JsonPlace& place,
                                               int depth) {
  std::vector<Element> list;
  const Json::array_t& array = elements(value, place);
  for (std::size_t i = 0; i < array.size() && !has_failed(); ++i) {
    list.push_back(element(array[i], place.at(i), depth));
  }
  return list;
}

void expect_format(JsonReading& reading, const Json& value, const JsonPlace& place,
                   std::string_view format) {
  for (const auto& [key, expected] : {std::pair<const char*, Json>{"format", format},
                                      std::pair<const char*, Json>{"version", 1}}) {
    if (value.is_object() && (!value.contains(key) || value.at(key) != expected)) {
      reading.fail(place.at(key),
                   fmt::format("expected {}, found {}", expected.dump(),
                               value.contains(key) ? value.at(key).dump() : "no such key"));
    }
  }
}

}  // namespace holdfast::io
