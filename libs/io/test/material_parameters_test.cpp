// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
//
// Every parameter of a material is read, written, refused and documented under the names and within
// the range that model::kMaterialParameters gives it: both formats, the JSON Schema and the table
// of docs/formats.md.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>
#include <string>
#include <string_view>

#include "document_support.hpp"

namespace holdfast::io {
namespace {

using model::kMaterialParameters;
using model::MaterialParameter;

std::string document_text(const std::string& name) {
  std::ifstream file(std::string(HOLDFAST_DOCUMENT_DIR) + "/" + name);
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

/// A value within the range that is no default.
double value_for(const MaterialParameter& parameter) {
  return std::clamp(0.0125, parameter.lowest, parameter.highest);
}

TEST(MaterialParameters, have_names_of_their_own) {
  std::set<std::string_view> keys;
  std::set<std::string> labels;
  for (const MaterialParameter& parameter : kMaterialParameters) {
    EXPECT_TRUE(keys.insert(parameter.key).second) << parameter.key;
    EXPECT_TRUE(labels.insert(parameter.label).second) << parameter.label;
  }
}

TEST(MaterialParameters, are_the_same_in_json_and_in_visiblesim) {
  for (const MaterialParameter& parameter : kMaterialParameters) {
    Document document;
    document.modules.emplace_back();
    document.material.*parameter.value = value_for(parameter);
    const auto from_json = read_json(write_json(document));
    const auto from_xml = read_visiblesim(write_visiblesim(document));
    ASSERT_TRUE(from_json && from_xml) << parameter.key;
    EXPECT_EQ(from_json.value().document.material, document.material) << parameter.key;
    EXPECT_EQ(from_xml.value().document.material, document.material) << parameter.key;
    EXPECT_NE(document.material, model::Material{}) << parameter.key;
  }
}

/// The schema's other keys are those of version 2 that nothing is computed with yet.
TEST(MaterialParameters, have_the_ranges_of_the_schema) {
  const auto schema = nlohmann::json::parse(document_text("structure.schema.json"));
  const auto& properties = schema["properties"]["material"]["properties"];
  const auto& not_yet = schema["then"]["properties"]["material"]["properties"];
  EXPECT_EQ(properties.size(), kMaterialParameters.size() + not_yet.size());
  for (const MaterialParameter& parameter : kMaterialParameters) {
    ASSERT_TRUE(properties.contains(parameter.key)) << parameter.key;
    EXPECT_FALSE(not_yet.contains(parameter.key)) << parameter.key;
    const auto& own = properties[parameter.key];
    const auto& entry = own.contains("anyOf") ? own["anyOf"][0] : own;  // A number, or a list.
    const auto& range =
        entry.contains("$ref")
            ? schema[nlohmann::json::json_pointer(entry["$ref"].get<std::string>().substr(1))]
            : entry;
    EXPECT_EQ(range["type"], "number") << parameter.key;
    EXPECT_EQ(range["minimum"].get<double>(), parameter.lowest) << parameter.key;
    EXPECT_EQ(range["maximum"].get<double>(), parameter.highest) << parameter.key;
  }
}

/// Whether version 2 of one module with one more member is read.
bool is_read(const std::string& key, const nlohmann::json& value,
             const nlohmann::json& gravity = nullptr) {
  nlohmann::json root = {{"format", "holdfast-structure"}, {"version", 2}};
  root["modules"] = nlohmann::json::parse("[[0, 0, 0]]");
  root[key] = value;
  if (!gravity.is_null()) {
    root["gravity_m_s2"] = gravity;
  }
  return read_json(root.dump()).has_value();
}

/// What the schema excludes the reader refuses: two strengths, of the material or of a kind, and
/// two gravities.
TEST(MaterialParameters, exclude_each_other_as_in_the_schema) {
  const auto schema = nlohmann::json::parse(document_text("structure.schema.json"));
  const nlohmann::json strengths = {{"$ref", "#/definitions/strength_twice"}};
  EXPECT_EQ(schema["properties"]["material"]["not"], strengths);
  EXPECT_EQ(schema["properties"]["kinds"]["additionalProperties"]["not"], strengths);
  const auto& excluded = schema["definitions"]["strength_twice"];
  const std::string one = excluded["required"][0];
  EXPECT_TRUE(is_read("material", {{one, 5}}));
  EXPECT_EQ(excluded["anyOf"].size(), 2U);
  for (const auto& other : excluded["anyOf"]) {
    const std::string two = other["required"][0];
    EXPECT_TRUE(is_read("material", {{two, 5}})) << two;
    EXPECT_FALSE(is_read("material", {{one, 5}, {two, 5}})) << two;
    EXPECT_FALSE(is_read("kinds", {{"heavy", {{one, 5}, {two, 5}}}})) << two;
  }
  EXPECT_EQ(schema["not"], nlohmann::json({{"$ref", "#/definitions/gravity_twice"}}));
  const std::string inner =
      schema["definitions"]["gravity_twice"]["properties"]["material"]["required"][0];
  EXPECT_TRUE(is_read("material", {{"mass_kg", 1}}, {0, 0, -1}));
  EXPECT_FALSE(is_read("material", {{inner, 1}}, {0, 0, -1}));
}

/// The row that docs/formats.md has to have; a failure shows it.
std::string row(const MaterialParameter& parameter) {
  const std::string visiblesim =
      parameter.visiblesim == nullptr ? "none" : fmt::format("`{}`", parameter.visiblesim);
  return fmt::format("| `{}` | {} | {} | {:g} to {:g} | {:.8g} | {} |\n", parameter.key,
                     parameter.label, parameter.unit, parameter.lowest, parameter.highest,
                     model::Material{}.*parameter.value, visiblesim);
}

TEST(MaterialParameters, are_the_rows_of_the_table_in_formats_md) {
  std::string rows;
  for (const MaterialParameter& parameter : kMaterialParameters) {
    rows += row(parameter);
  }
  EXPECT_NE(document_text("formats.md").find("|---|---|---|---|---|---|\n" + rows + "\n"),
            std::string::npos)
      << rows;
}

}  // namespace
}  // namespace holdfast::io
