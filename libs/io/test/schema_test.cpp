// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
//
// Every object and every list of the format, with some of its members only, or with none: the
// reader refuses what the JSON Schema refuses, at a place that holds it, and reads what the schema
// allows.
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "holdfast/io/document.hpp"

namespace holdfast::io {
namespace {

using Json = nlohmann::ordered_json;

/// A validator of what the schema of structures uses of draft 7, but for patterns of texts.
class Schema {
 public:
  explicit Schema(Json root) : root_(std::move(root)) {}

  bool allows(const Json& value) const { return allows(root_, value); }

 private:
  bool allows(const Json& rule, const Json& value) const;
  bool allows_members(const Json& rule, const Json& value) const;
  bool allows_number(const Json& rule, const Json& value) const;
  bool allows_count(const Json& rule, const Json& value) const;

  auto is_met(const Json& value) const {
    return [this, &value](const Json& one) { return allows(one, value); };
  }

  Json root_;
};

bool is_of_type(const std::string& type, const Json& value) {
  const bool is_whole =
      value.is_number() && value.get<double>() == static_cast<double>(value.get<long long>());
  return type == "integer"  ? is_whole
         : type == "number" ? value.is_number()
                            : value.type_name() == type;
}

bool Schema::allows_number(const Json& rule, const Json& value) const {
  return !value.is_number() || (value >= rule.value("minimum", Json(-1e300)) &&
                                value <= rule.value("maximum", Json(1e300)));
}

bool Schema::allows_count(const Json& rule, const Json& value) const {
  const std::size_t size = value.size();
  return (!value.is_array() || (size >= rule.value("minItems", 0U) &&
                                size <= rule.value("maxItems", std::size_t{1} << 20U))) &&
         (!value.is_object() || size >= rule.value("minProperties", 0U));
}

bool Schema::allows_members(const Json& rule, const Json& value) const {
  const Json known = rule.value("properties", Json::object());
  const Json others = rule.value("additionalProperties", Json(true));
  const bool is_extensible = rule.contains("patternProperties");
  return std::ranges::all_of(value.items(), [&](const auto& member) {
    return known.contains(member.key()) ? allows(known[member.key()], member.value())
                                        : (is_extensible && member.key().starts_with("x-")) ||
                                              allows(others, member.value());
  });
}

bool Schema::allows(const Json& rule, const Json& value) const {
  if (rule.is_boolean()) {
    return rule.get<bool>();
  }
  if (rule.contains("$ref")) {
    return allows(root_.at(Json::json_pointer(rule["$ref"].get<std::string>().substr(1))), value);
  }
  const auto has = [&](const char* key) { return rule.contains(key); };
  const auto met = is_met(value);
  const bool is_second = has("if") && !allows(rule["if"], value);
  return (!has("type") || is_of_type(rule["type"], value)) &&
         (!has("const") || rule["const"] == value) &&
         (!has("enum") || std::ranges::count(rule["enum"], value) > 0) &&
         (!has("not") || !allows(rule["not"], value)) &&
         (!has("oneOf") || std::ranges::count_if(rule["oneOf"], met) == 1) &&
         (!has("anyOf") || std::ranges::any_of(rule["anyOf"], met)) &&
         (!has("allOf") || std::ranges::all_of(rule["allOf"], met)) &&
         (!has("then") || is_second || allows(rule["then"], value)) &&
         (!has("required") || std::ranges::all_of(rule["required"],
                                                  [&](const Json& key) {
                                                    return !value.is_object() ||
                                                           value.contains(key.get<std::string>());
                                                  })) &&
         (!has("items") || !value.is_array() ||
          std::ranges::all_of(value,
                              [&](const Json& one) { return allows(rule["items"], one); })) &&
         (!value.is_object() || allows_members(rule, value)) && allows_number(rule, value) &&
         allows_count(rule, value);
}

/// Every object of the format, with every member that goes together.
const char* const kDocument = R"({"format": "holdfast-structure", "version": 2, "name": "all",
  "description": "d", "lattice": "cubic", "safety_factor": 2, "support_z": 0,
  "floor": {"friction": 0.5},
  "gravity_m_s2": [0, 1, -1.62],
  "material": {"mass_kg": 0.05, "strength_n": {"vertical": 12, "lateral": 11}, "friction": 0.4,
               "lever_mm": [1, 2, 3], "bending": "round", "foot_mm": 3},
  "modules": [[0,0,0], {"cell": [0,0,1], "fixed": false, "color": [1,2,3], "mass_kg": 0.1,
                        "attributes": {"id": "3"}},
              {"from": [1,0,0], "to": [2,0,1], "fixed": false, "color": [1,2,3], "mass_kg": 0.1},
              {"layers": [["##", "#."], [".#"]], "at": [0,1,0], "fixed": false, "mass_kg": 0.1}],
  "planned": [{"cell": [0,0,2], "mass_kg": 0.07, "color": [1,2,3]},
              {"from": [0,0,5], "to": [0,0,6], "mass_kg": 0.07}],
  "later_steps": [[[0,0,3]], [{"cell": [0,0,4], "attributes": {"id": "3"}}]],
  "kinds": {"b": {"mass_kg": 0.06, "strength_vertical_n": 3, "lever_mm": {"vertical": 15}}},
  "bodies": [[[0,0,0], {"from": [1,0,0], "to": [2,0,1], "x-note": 1}],
             [{"layers": [["##", "#."], [".#"]], "at": [0,1,0]}]],
  "obstacles": [{"from": [3,0,0], "to": [4,1,1], "hold": "contact", "friction": 1},
                {"cells": [[7,0,0]], "hold": "bonded", "color": [1,2,3]}],
  "loads": [{"cell": [0,0,1], "force_n": [0,0,-1], "torque_nmm": [0,0,0]}],
  "steps": [{"attach": [[1,0,1]], "detach": [[0,0,4]], "release": [[[0,0,0],[0,0,1]]]},
            {"move": [{"from": [1,0,1], "to": [1,0,0], "carrier": [0,0,1]}]},
            {"connect": [[[0,0,0],[0,0,1]]]}],
  "known_answer": {"verdict": "safe", "margin_mm": 20, "load_ratio_max": 1, "source": "s"},
  "visiblesim": {"parameters": {"nofIterations": "3"}, "world": {"windowSize": "3"},
    "block_list": {"ids": "3"}, "obstacle_list": {"q": "1"},
    "scenery": [{"element": "camera", "attributes": {"zoom": "1"}, "text": "t",
                 "children": [{"element": "a"}]}],
    "targets": [{"element": "target", "attributes": {"format": "csg"}}]}})";

void find_structured(const Json& value, const Json::json_pointer& place,
                     std::vector<Json::json_pointer>& found) {
  found.push_back(place);
  for (const auto& [key, member] : value.items()) {
    if (member.is_structured()) {
      find_structured(member, value.is_array() ? place / std::stoul(key) : place / key, found);
    }
  }
}

/// The members that a number has the bits of.
Json some_of(const Json& whole, std::size_t chosen) {
  Json part = whole.is_array() ? Json::array() : Json::object();
  std::size_t i = 0;
  for (const auto& [key, member] : whole.items()) {
    if ((chosen >> i++ & 1U) == 0) {
      continue;
    }
    if (whole.is_array()) {
      part.push_back(member);
    } else {
      part[key] = member;
    }
  }
  return part;
}

/// The members to choose of so many: if there are few, all choices but all of them; if there are
/// many, none, each alone and each left out.
std::vector<std::size_t> choices(std::size_t count) {
  const std::size_t all = (std::size_t{1} << count) - 1;
  std::vector<std::size_t> list;
  if (count <= 6) {
    for (std::size_t chosen = 0; chosen < all; ++chosen) {
      list.push_back(chosen);
    }
    return list;
  }
  list.push_back(0);
  for (std::size_t i = 0; i < count; ++i) {
    list.push_back(std::size_t{1} << i);
    list.push_back(all ^ (std::size_t{1} << i));
  }
  return list;
}

TEST(Schema, excludes_what_the_reader_refuses_of_objects_and_lists_with_some_or_no_members) {
  std::ifstream file(HOLDFAST_DOCUMENT_DIR "/structure.schema.json");
  const Schema schema(Json::parse(file));
  const Json document = Json::parse(kDocument);
  ASSERT_TRUE(schema.allows(document));
  ASSERT_TRUE(read_json(kDocument)) << read_json(kDocument).error().message;
  std::vector<Json::json_pointer> places;
  find_structured(document, Json::json_pointer(), places);
  std::size_t allowed = 0;
  std::size_t refused = 0;
  for (const Json::json_pointer& place : places) {
    for (const std::size_t chosen : choices(document[place].size())) {
      Json changed = document;
      changed[place] = some_of(document[place], chosen);
      const auto read = read_json(changed.dump());
      EXPECT_EQ(read.has_value(), schema.allows(changed))
          << place << " is " << changed[place] << (read ? "" : ": " + read.error().message);
      (read ? allowed : refused) += 1;
      if (!read) {
        const std::string& where = read.error().where;
        EXPECT_TRUE(where.starts_with(place.to_string()) || place.to_string().starts_with(where))
            << where;
      }
    }
  }
  EXPECT_GT(allowed, 100U);
  EXPECT_GT(refused, 100U);
}

/// A step that does nothing is a slip, whatever else it has.
TEST(Schema, has_no_step_that_does_nothing) {
  std::ifstream file(HOLDFAST_DOCUMENT_DIR "/structure.schema.json");
  const Schema schema(Json::parse(file));
  const char* const lists[] = {"attach", "detach", "move", "release", "connect"};
  for (std::size_t chosen = 0; chosen < 32; ++chosen) {
    Json step = {{"x-note", 1}};
    for (std::size_t i = 0; i < 5; ++i) {
      if ((chosen >> i & 1U) != 0) {
        step[lists[i]] = Json::array();
      }
    }
    Json document = Json::parse(kDocument);
    document["steps"].push_back(step);
    EXPECT_FALSE(schema.allows(document)) << step;
    const auto read = read_json(document.dump());
    ASSERT_FALSE(read) << step;
    EXPECT_EQ(read.error().where, "/steps/3");
    EXPECT_EQ(read.error().message,
              "expected an entry in at least one of \"attach\", \"detach\", "
              "\"move\", \"release\", \"connect\", found none");
  }
}

}  // namespace
}  // namespace holdfast::io
