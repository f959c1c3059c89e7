// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
//
// What a reader does with names: keys of holdfast JSON that nobody knows, names of VisibleSim in
// any case, and the places that errors name.
#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "document_support.hpp"
#include "holdfast/base/rng.hpp"
#include "holdfast/model/material.hpp"

namespace holdfast::io {
namespace {

using Json = nlohmann::ordered_json;

/// Every object of the format.
const char* const kAll = R"({"format": "holdfast-structure", "version": 2, "name": "all",
  "lattice": "cubic", "floor": {"friction": 0.5}, "gravity_m_s2": [0, 0, -1.62],
  "material": {"mass_kg": 0.05, "strength_n": {"vertical": 12, "lateral": 11}, "friction": 0.4},
  "modules": [[0,0,0], {"cell": [0,0,1], "kind": "b", "fixed": false, "color": [1,2,3],
                        "attributes": {"id": "3"}}],
  "planned": [{"cell": [0,0,2], "mass_kg": 0.07}],
  "later_steps": [[[0,0,3]], [{"cell": [0,0,4]}]],
  "kinds": {"b": {"mass_kg": 0.06, "lever_mm": {"vertical": 15}}},
  "obstacles": [{"from": [3,0,0], "to": [4,1,1]}, {"cells": [[7,0,0]], "hold": "bonded"}],
  "loads": [{"cell": [0,0,1], "force_n": [0,0,-1]}],
  "steps": [{"attach": [[1,0,1]]}, {"move": [{"from": [1,0,1], "to": [1,0,0]}]}],
  "known_answer": {"verdict": "safe", "margin_mm": 20},
  "visiblesim": {"world": {"windowSize": "3"}, "block_list": {"blockSize": "40,40,40"},
    "scenery": [{"element": "camera", "attributes": {"zoom": "1"}, "children": [{"element": "a"}]}],
    "targets": [{"element": "target", "attributes": {"format": "csg"}}]}})";

Json schema() {
  std::ifstream file(HOLDFAST_DOCUMENT_DIR "/structure.schema.json");
  return Json::parse(file);
}

/// The parts of a schema that say what an object may have: what it refers to, and all cases.
void collect(const Json& whole, const Json& part, std::vector<const Json*>& found) {
  if (part.contains("$ref")) {
    const auto ref = part["$ref"].get<std::string>();
    collect(whole, whole.at(Json::json_pointer(ref.substr(1))), found);
  }
  for (const char* const several : {"oneOf", "allOf"}) {
    if (const auto cases = part.find(several); cases != part.end()) {
      for (const Json& one : *cases) {
        collect(whole, one, found);
      }
    }
  }
  found.push_back(&part);
}

/// Whether the schema lets an object of the document have this key.
bool schema_allows(const Json& whole, const std::vector<const Json*>& parts,
                   const std::string& key) {
  bool is_object = false;
  for (const Json* part : parts) {
    const bool is_one = part->contains("properties") || part->contains("additionalProperties");
    is_object = is_object || is_one;
    if (is_one &&
        ((part->contains("properties") && (*part)["properties"].contains(key)) ||
         ((*part).value("patternProperties", Json::object()).contains("^x-") &&
          key.starts_with("x-")) ||
         !(*part).contains("additionalProperties") || (*part)["additionalProperties"] != false)) {
      return true;
    }
  }
  return !is_object && whole.is_null();
}

struct Object {
  Json::json_pointer place;
  std::vector<const Json*> parts;
};

/// Every object in a value, with what the schema says of it.
void find_objects(const Json& whole, const Json& part, const Json& value,
                  const Json::json_pointer& place, std::vector<Object>& objects) {
  std::vector<const Json*> parts;
  collect(whole, part, parts);
  if (!value.is_structured()) {
    return;
  }
  if (value.is_object()) {
    objects.push_back({place, parts});
  }
  for (const auto& [key, member] : value.items()) {
    const Json* inner = nullptr;
    for (const Json* one : parts) {
      if (value.is_array() && one->contains("items")) {
        inner = &(*one)["items"];
      } else if (value.is_object() && one->contains("properties") &&
                 (*one)["properties"].contains(key)) {
        const Json& said = (*one)["properties"][key];
        inner = inner == nullptr || said.is_object() ? &said : inner;  // `true` says nothing.
      } else if (value.is_object() && inner == nullptr && one->contains("additionalProperties")) {
        inner = &(*one)["additionalProperties"];
      }
    }
    ASSERT_NE(inner, nullptr) << place.to_string() << "/" << key;
    const auto here = value.is_array() ? place / std::stoul(key) : place / key;
    find_objects(whole, *inner, member, here, objects);
  }
}

std::vector<Object> objects_of(const Json& whole, const Json& document) {
  std::vector<Object> objects;
  find_objects(whole, whole, document, Json::json_pointer(), objects);
  return objects;
}

TEST(KnownNames, unknown_keys_are_errors_wherever_the_schema_forbids_them) {
  const Json whole = schema();
  const Json document = Json::parse(kAll);
  const Document expected = document_test::accepted(read_json(document.dump())).document;
  base::Rng rng(1);
  std::size_t refused = 0;
  std::size_t free = 0;
  for (const Object& object : objects_of(whole, document)) {
    std::string key = "q";
    for (int i = 0; i < 9; ++i) {
      key += static_cast<char>('a' + static_cast<char>(rng.below(26)));
    }
    for (const std::string& added : {key, "x-" + key, std::string("weight"), std::string("add")}) {
      Json changed = document;
      // A text is allowed where keys are free, and what x- stands for may be anything.
      changed[object.place][added] =
          added.starts_with("x-") ? Json::array({1, Json::object()}) : Json("1");
      const bool is_allowed = schema_allows(whole, object.parts, added);
      const bool is_free = is_allowed && !added.starts_with("x-");
      if (is_free || schema_allows(whole, object.parts, key)) {
        ++free;  // Attributes and names of kinds, of which values decide.
        continue;
      }
      const auto result = read_json(changed.dump());
      EXPECT_EQ(result.has_value(), is_allowed) << object.place << " " << added;
      if (result) {
        EXPECT_EQ(result.value().document, expected) << object.place;
      } else {
        ++refused;
        EXPECT_EQ(result.error().where, (object.place / added).to_string());
        EXPECT_NE(result.error().message.find("is unknown"), std::string::npos);
        const auto on = read_json(changed.dump(), {.allow_unknown = true});
        ASSERT_TRUE(on) << on.error().where << ": " << on.error().message;
        EXPECT_EQ(on.value().document, expected);
        EXPECT_NE(on.value().warnings.front().find("is unknown and ignored"), std::string::npos);
      }
    }
  }
  EXPECT_GE(refused, 3 * 20U);
  EXPECT_GE(free, 4U);
}

/// Words in another order mean the same to people.
TEST(KnownNames, keys_with_words_in_another_order_are_slips) {
  const auto result = read_json(
      document_test::json(R"("modules": [[0,0,0]], "material": {"lateral_strength_n": 0.01})"));
  ASSERT_FALSE(result);
  EXPECT_EQ(result.error().message,
            "the key 'lateral_strength_n' is unknown: did you mean 'strength_lateral_n'?");
}

/// Numbers of the material are looked for where it is read, and numbers beside it are not read.
TEST(KnownNames, keys_of_the_material_beside_it_are_slips) {
  for (const auto& [key, meant] : std::to_array<std::pair<std::string, std::string>>(
           {{"mass_kg", "mass_kg"},
            {"lateral_strength_n", "strength_lateral_n"},
            {"pitch", "pitch_mm"}})) {
    const std::string text = document_test::json(R"("modules": [[0,0,0]], ")" + key + R"(": 1)");
    const auto result = read_json(text);
    ASSERT_FALSE(result) << key;
    EXPECT_EQ(result.error().message, "the key '" + key + "' is unknown here: did you mean '" +
                                          meant + "' in \"material\"?");
    EXPECT_EQ(result.error().where, '/' + key);
    EXPECT_TRUE(read_json(text, {.allow_unknown = true})) << key;
    const std::string own = document_test::json(R"("modules": [[0,0,0]], "x-)" + key + R"(": 1)");
    EXPECT_TRUE(read_json(own)) << key;
  }
}

/// Whether a pointer leads to something.
bool leads(const Json& document, const std::string& pointer) {
  try {
    return document.contains(Json::json_pointer(pointer));
  } catch (const nlohmann::detail::exception&) {
    return false;  // Such as an index that is no number.
  }
}

std::vector<Json::json_pointer> places_in(const Json& value, const Json::json_pointer& place) {
  std::vector<Json::json_pointer> all = {place};
  for (const auto& [key, member] : value.items()) {
    if (value.is_structured()) {
      const auto here = value.is_array() ? place / std::stoul(key) : place / key;
      const auto inner = places_in(member, here);
      all.insert(all.end(), inner.begin(), inner.end());
    }
  }
  return all;
}

/// Reads and makes a robot of a document. If that fails, the place that is named is one that is
/// there, and what is missing is not called null. Returns whether it failed.
bool fails_at_a_place(const Json& document) {
  const std::string text = document.dump();
  const auto result = read_json(text);
  base::Error error;
  if (!result) {
    error = result.error();
  } else if (const auto spec = make_spec(result.value().document); !spec) {
    error = spec.error();
  } else {
    return false;
  }
  if (error.where.starts_with("/")) {
    EXPECT_TRUE(leads(document, error.where)) << error.where << ": " << error.message << text;
  }
  if (error.message.ends_with(", found null")) {
    EXPECT_TRUE(document[Json::json_pointer(error.where)].is_null()) << error.where << text;
  }
  return true;
}

TEST(KnownNames, errors_name_places_that_are_in_the_document) {
  const Json whole = Json::parse(kAll);
  const Json values[] = {nullptr,
                         0,
                         -1,
                         1e300,
                         "",
                         "text",
                         true,
                         1e-300,
                         1e13,
                         1e-13,
                         2.5,
                         Json::array(),
                         Json::object(),
                         {0, 0, -1e15},
                         Json::array({1, 2}),
                         {{"cell", {0, 0, 0}}}};
  base::Rng rng(2);
  std::size_t failures = 0;
  const auto look_at = [&](const Json& document) {
    failures += fails_at_a_place(document) ? 1 : 0;
  };
  const auto places = places_in(whole, Json::json_pointer());
  for (const auto& place : places) {
    if (place.empty()) {
      continue;
    }
    for (const Json& value : values) {
      Json document = whole;
      document[place] = value;
      look_at(document);
      // Elsewhere as well.
      Json more = document;
      const auto& other = places[1 + rng.below(places.size() - 1)];
      if (leads(more, other.to_string())) {
        more[other] = values[rng.below(std::size(values))];
        look_at(more);
      }
    }
    Json without = whole;
    Json& parent = without[place.parent_pointer()];
    if (parent.is_object()) {
      parent.erase(place.back());
      look_at(without);
    }
  }
  EXPECT_GT(failures, 500U);
  // Of a robot of the catalogue, the section follows from the pitch.
  Json robot = Json::parse(R"({"format": "holdfast-structure", "version": 2,
    "modules": [[0,0,0]], "robot": "rofi", "material": {"pitch_mm": 1e11}})");
  look_at(robot);
  robot.erase("material");
  robot["robot"] = "smores-ep";
  look_at(robot);
}

TEST(KnownNames, a_key_that_is_missing_is_called_missing) {
  const char* const documents[] = {R"({"version": 1, "modules": []})",
                                   R"({"format": "holdfast-structure", "modules": []})",
                                   R"({"format": "holdfast-structure", "version": 1})"};
  const char* const keys[] = {"format", "version", "modules"};
  for (std::size_t i = 0; i < 3; ++i) {
    const auto result = read_json(documents[i]);
    ASSERT_FALSE(result);
    EXPECT_EQ(result.error().where, "");
    EXPECT_TRUE(result.error().message.starts_with("key \"" + std::string(keys[i]) +
                                                   "\" is missing, expected "))
        << result.error().message;
  }
}

/// A file with every name that the reader of VisibleSim XML knows and that goes together.
const char* const kVisibleSim = R"(<vs><parameters E="90" globalMass="0.07" globalL="40" a="39"
  A="1500" globalNu="0.3" globalGamma="0.0001" globalSupportZ="0" nofIterations="3"/>
 <world gridSize="9,9,9" windowSize="3,3" maxSimulationTime="1">
 <camera/><spotlight/>
 <blockList blockSize="1,5,1" color="1,2,3" ids="MANUAL">
  <block position="0,0,0" color="9,8,7" fixed="true" id="3" centroid="1" holdfastMass="0.08"/>
  <blocksLine line="0" plane="1" values="0110" color="1,1,1" orientation="2"/>
  <blockBox boxOrigin="0,0,2" boxSize="3,1,1" color="2,2,2"/></blockList>
 <targetList><target format="grid"><cell position="4,0,2" color="1,1,1"/>
  <targetLine line="0" plane="3" values="1"/></target></targetList>
 <obstacleList><obstacle position="7,0,0" color="3,3,3" hold="bonded" to="8,0,0"/></obstacleList>
 <holdfast name="n" description="d" gravity_m_s2="9.7" strength_lateral_n="15">
  <knownAnswer verdict="safe" margin_mm="3" source="s"/>
  <extension>{"floor": {"friction": 0.5}}</extension></holdfast></world></vs>)";

/// All names of elements and attributes, each with letters in any case, the same wherever it
/// stands; values stay, and so do the two names that only their case tells apart.
std::string in_any_case(const std::string& text, base::Rng& rng) {
  std::map<std::string, std::string> spelled = {{"a", "a"}, {"A", "A"}};
  const auto spell = [&](const std::string& name) {
    std::string any = name;
    for (char& c : any) {
      if ((c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z')) {
        c = static_cast<char>(rng.below(2) == 0 ? c | 0x20 : c & ~0x20);
      }
    }
    return spelled.emplace(name, any).first->second;
  };
  std::string out;
  std::string name;
  bool is_tag = false;
  bool is_value = false;
  for (const char c : text) {
    const bool is_letter = std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_';
    if (is_tag && !is_value && is_letter) {
      name += c;
      continue;
    }
    out += name.empty() ? "" : spell(name);
    name.clear();
    out += c;
    is_value = is_tag && (c == '"' ? !is_value : is_value);
    is_tag = is_value || (c == '<' || (is_tag && c != '>'));
  }
  return out;
}

TEST(KnownNames, names_of_visiblesim_are_read_in_any_case) {
  const ReadDocument expected = document_test::accepted(read_visiblesim(kVisibleSim));
  EXPECT_EQ(expected.document.extension.lattice, base::kHexagonal);
  EXPECT_EQ(expected.document.modules.size(), 6U);
  base::Rng rng(3);
  for (int i = 0; i < 300; ++i) {
    const std::string text = in_any_case(kVisibleSim, rng);
    const ReadDocument read = document_test::accepted(read_visiblesim(text));
    EXPECT_EQ(read.document, expected.document) << text;
    EXPECT_EQ(read.warnings, expected.warnings) << text;
  }
}

/// A robot with mass="61" would be as heavy as Blinky Blocks, whatever the file means.
TEST(KnownNames, a_number_of_the_material_is_not_lost_by_what_parameters_call_it) {
  const auto refusal = [](const std::string& name) {
    const auto read = read_visiblesim("<parameters " + name +
                                      "=\"1\"/><world><blockList><block position=\"0,0,0\"/>"
                                      "</blockList></world>");
    return read ? std::string("read") : read.error().message;
  };
  for (const model::MaterialParameter& parameter : model::kMaterialParameters) {
    const std::string key(parameter.key);
    const std::string meant = parameter.visiblesim != nullptr ? std::string(parameter.visiblesim)
                                                              : key + "' of '<holdfast>";
    std::string capitals = key;
    std::ranges::transform(capitals, capitals.begin(),
                           [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
    for (const std::string& name : {key, capitals, key + "_", "x" + key}) {
      EXPECT_NE(refusal(name).find("did you mean '" + meant + "'?"), std::string::npos)
          << name << ": " << refusal(name);
    }
  }
  for (const auto& [name, meant] :
       std::map<std::string, std::string>{{"mass", "globalMass"},
                                          {"pitch", "globalL"},
                                          {"torsion", "globalJ"},
                                          {"gravity", "gravity_m_s2' of '<holdfast>"}}) {
    EXPECT_NE(refusal(name).find("did you mean '" + meant + "'?"), std::string::npos)
        << refusal(name);
  }
  EXPECT_EQ(refusal("nofIterations"), "read");
  EXPECT_EQ(refusal("colour"), "read");
}

TEST(KnownNames, two_names_of_visiblesim_that_only_case_tells_apart_are_an_error) {
  const char* const doubles[][2] = {{"blockSize=\"1", "blocksize=\"1,5,1\" blockSize=\"1"},
                                    {"gridSize=", "GRIDSIZE=\"9,9,9\" gridSize="},
                                    {"globalMass=", "globalmass=\"1\" globalMass="},
                                    {"position=\"0", "Position=\"0,0,0\" position=\"0"},
                                    {"verdict=", "Verdict=\"safe\" verdict="},
                                    {"values=\"1\"", "values=\"1\" Values=\"1\""},
                                    {"hold=", "HOLD=\"bonded\" hold="}};
  for (const auto& [one, both] : doubles) {
    std::string text = kVisibleSim;
    text.replace(text.find(one), std::string_view(one).size(), both);
    const auto result = read_visiblesim(text);
    ASSERT_FALSE(result) << both;
    EXPECT_NE(result.error().message.find("is there twice"), std::string::npos) << both;
  }
  const auto json = read_json(document_test::json(
      R"("modules": [], "visiblesim": {"world": {"gridsize": "9,9,9", "gridSize": "9,9,9"}})"));
  ASSERT_FALSE(json);
  EXPECT_EQ(json.error().where, "/visiblesim/world");
}

/// Figures in another unit, by the factor between the two.
TEST(DoubtfulFigures, are_noted_where_a_unit_is_probably_another) {
  const auto notes = [](const std::string& members) {
    return document_test::accepted(read_json(document_test::json(members))).warnings;
  };
  const auto of_material = [&](const char* material) {
    return notes(R"("modules": [[0,0,0]], "material": {)" + std::string(material) + "}");
  };

  struct Case {
    const char* material;
    const char* note;  ///< Empty: none.
  };

  // 0.064 kg in a cube of 40 mm is 1 t/m3.
  const Case cases[] = {{R"("mass_kg": 61.06)", "density 954 t/m3"},
                        {R"("mass_kg": 1.407)", ""},
                        {R"("mass_kg": 1.409)", "density 22 t/m3"},
                        {R"("mass_kg": 0.00129)", ""},
                        {R"("mass_kg": 0.00127)", "density 0.0198 t/m3"},
                        {R"("pitch_mm": 0.04, "facet_mm": 0.04)", "pitch 0.04 mm"},
                        {R"("pitch_mm": 1, "facet_mm": 1, "mass_kg": 1e-6)", ""},
                        {R"("pitch_mm": 10001, "facet_mm": 40)", "pitch 10001 mm"},
                        {R"("elastic_modulus_mpa": 1e8)", "elastic modulus 100 TPa"},
                        {R"("elastic_modulus_mpa": 1.2e6)", ""}};
  for (const Case& one : cases) {
    const std::vector<std::string> found = of_material(one.material);
    if (*one.note == '\0') {
      EXPECT_TRUE(found.empty()) << one.material << ": " << found.front();
    } else {
      ASSERT_EQ(found.size(), 1U) << one.material;
      EXPECT_TRUE(found[0].starts_with(one.note)) << found[0];
    }
  }
  const auto flat = [&](const char* modules) {
    return notes(R"("modules": )" + std::string(modules)).size();
  };
  EXPECT_EQ(flat("[[0,0,0],[0,1,0],[0,2,0],[1,2,0],[2,2,0],[2,1,0],[2,0,0]]"), 1U);  // An arch.
  EXPECT_EQ(flat("[[0,0,0],[0,1,0],[0,2,0]]"), 0U);                                  // A bar.
  EXPECT_EQ(flat("[[0,0,0],[0,1,0],[0,2,0],[1,0,0],[1,1,0],[1,2,0]]"), 0U);          // A plate.
  EXPECT_EQ(flat("[[0,0,0],[0,1,0],[0,2,0],[1,2,0],[1,2,1]]"), 0U);
}

}  // namespace
}  // namespace holdfast::io
