// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
//
// holdfast JSON is read as docs/formats.md describes it, and written for people to read.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include "document_support.hpp"

namespace holdfast::io {
namespace {

using base::Cell;
using document_test::json;

ReadDocument read(std::string_view text) { return document_test::accepted(read_json(text)); }

TEST(Json, defaults_stand_for_what_is_missing) {
  const ReadDocument result = read(json(R"("modules": [])"));
  EXPECT_EQ(result.document, Document{});
  EXPECT_TRUE(result.warnings.empty());
}

TEST(Json, is_read_whole) {
  const ReadDocument result = read(json(R"(
    "$schema": "../docs/structure.schema.json",
    "name": "tower", "description": "Two modules, one fixed.", "support_z": -1,
    "modules": [[0,0,-1], {"cell": [0,0,0], "fixed": true, "color": [1,2,3],
                           "attributes": {"id": "7", "centroid": "1"}}],
    "planned": [[1,0,0], {"cell": [0,1,0], "color": [4,5,6], "attributes": {"id": "8"}}],
    "later_steps": [[[2,0,0]]],
    "known_answer": {"verdict": "overload", "margin_mm": 1.5, "load_ratio_max": 2, "source": "me"},
    "visiblesim": {
      "parameters": {"nofIterations": "9"}, "world": {"windowSize": "1,1"},
      "block_list": {"ids": "MANUAL"},
      "scenery": [{"element": "camera", "attributes": {"angle": "45"}, "text": " t ",
                   "children": [{"element": "lens"}]}],
      "targets": [{"element": "target", "attributes": {"format": "surface"}}]})"));
  Document expected;
  expected.name = "tower";
  expected.description = "Two modules, one fixed.";
  expected.support_z = -1;
  expected.modules = {{{0, 0, -1}, false, std::nullopt, {}},
                      {{0, 0, 0}, true, Color{1, 2, 3}, {{"id", "7"}, {"centroid", "1"}}}};
  expected.steps = {{{{1, 0, 0}, std::nullopt, {}}, {{0, 1, 0}, Color{4, 5, 6}, {{"id", "8"}}}},
                    {{{2, 0, 0}, std::nullopt, {}}}};
  expected.known_answer = KnownAnswer{"overload", 1.5, 2.0, "me"};
  expected.parameters = {{"nofIterations", "9"}};
  expected.world = {{"windowSize", "1,1"}};
  expected.block_list = {{"ids", "MANUAL"}};
  expected.scenery = {{"camera", {{"angle", "45"}}, "t", {{"lens", {}, "", {}}}}};
  expected.targets = {{"target", {{"format", "surface"}}, "", {}}};
  EXPECT_EQ(result.document, expected);
  EXPECT_EQ(result.warnings.size(), 1U);  // Of the target.
}

TEST(Json, material_values_are_independent_of_each_other) {
  const std::pair<const char*, double model::Material::*> parameters[] = {
      {"elastic_modulus_mpa", &model::Material::elastic_modulus_mpa},
      {"pitch_mm", &model::Material::pitch_mm},
      {"facet_mm", &model::Material::facet_mm},
      {"section_area_mm2", &model::Material::section_area_mm2},
      {"moment_x_mm4", &model::Material::moment_x_mm4},
      {"moment_y_mm4", &model::Material::moment_y_mm4},
      {"torsion_mm4", &model::Material::torsion_mm4},
      {"poisson_ratio", &model::Material::poisson_ratio},
      {"mass_kg", &model::Material::mass_kg},
      {"gravity_m_s2", &model::Material::gravity_m_s2},
      {"strength_vertical_n", &model::Material::strength_vertical_n},
      {"strength_lateral_n", &model::Material::strength_lateral_n},
      {"contact_gamma", &model::Material::contact_gamma}};
  for (const auto& [key, value] : parameters) {
    Document expected;
    expected.material.*value = 0.125;
    const std::string material = R"("material": {")" + std::string(key) + R"(": 0.125})";
    EXPECT_EQ(read(json(material + R"(, "modules": [])")).document, expected) << key;
    // What is written names it, and no other.
    const std::string written = write_json(expected);
    EXPECT_NE(written.find(material), std::string::npos) << written;
  }
}

TEST(Json, whole_numbers_may_be_written_with_a_point) {
  EXPECT_EQ(read(json(R"("modules": [[1.0, 2, -3e0]])")).document.modules[0].cell,
            (Cell{1, 2, -3}));
}

TEST(Json, unknown_keys_are_named_by_their_pointer) {
  const std::string text = json(
      R"("modules": [[0,0,0], {"cell": [1,0,0], "paint": 1}, {"cell": [2,0,0], "paint": 2}],
         "material": {"m/a~s": 1}, "author": {"deep": []},
         "visiblesim": {"scenery": [{"element": "camera", "zoom": 1}]})");
  EXPECT_EQ(read_json(text).error().where, "/modules/1/paint");
  const ReadDocument result = document_test::accepted(read_json(text, {.allow_unknown = true}));
  EXPECT_EQ(result.warnings,
            (std::vector<std::string>{
                "/modules/1/paint: the key 'paint' is unknown and ignored (2 times, first here)",
                "/material/m~1a~0s: the key 'm/a~s' is unknown and ignored",
                "/author: the key 'author' is unknown and ignored",
                "/visiblesim/scenery/0/zoom: the key 'zoom' is unknown and ignored"}));
}

/// What a slip of one or two letters makes of a key loses what the key says, so it is an error.
TEST(Json, keys_that_look_like_known_ones_are_errors) {
  struct Slip {
    const char* members;
    const char* where;
    const char* meant;
  };

  const Slip slips[] = {
      {R"("modules": [], "planed": [])", "/planed", "'planned'"},
      {R"("modules": [], "Planned": [])", "/Planned", "'planned'"},
      {R"("modules": [], "later-steps": [])", "/later-steps", "'later_steps'"},
      {R"("modules": [], "materal": {})", "/materal", "'material'"},
      {R"("modules": [], "suport_z": 1)", "/suport_z", "'support_z'"},
      {R"("modules": [], "material": {"mass": 1})", "/material/mass", "'mass_kg'"},
      {R"("modules": [], "material": {"mass_g": 1})", "/material/mass_g", "'mass_kg'"},
      {R"("modules": [], "material": {"pitch_m": 1})", "/material/pitch_m", "'pitch_mm'"},
      {R"("modules": [{"cell": [0,0,0], "fixd": true}])", "/modules/0/fixd", "'fixed'"},
      {R"("modules": [{"cell": [0,0,0], "fiexd": true}])", "/modules/0/fiexd", "'fixed'"},
      {R"("modules": [{"cell": [0,0,0], "attributes": {"fixd": "1"}}])", "module (0,0,0)",
       "'fixed'"},
      {R"("modules": [], "visiblesim": {"parameters": {"globalmass": "1"}})", "", "'globalMass'"},
      {R"("modules": [], "known_answer": {"verdict": "safe", "margin": 1})", "/known_answer/margin",
       "'margin_mm'"}};
  for (const Slip& slip : slips) {
    const auto result = read_json(json(slip.members));
    ASSERT_FALSE(result) << slip.members;
    EXPECT_EQ(result.error().where, slip.where);
    EXPECT_NE(result.error().message.find("did you mean " + std::string(slip.meant) + "?"),
              std::string::npos)
        << result.error().message;
  }
}

TEST(Json, keys_of_others_are_noted_however_short) {
  const std::string text = json(
      R"("modules": [], "author": 1, "date": 1, "x": 1, "id": 1, "units": 1, "note": 1, "v": 2)");
  const ReadDocument result = document_test::accepted(read_json(text, {.allow_unknown = true}));
  EXPECT_EQ(result.warnings.size(), 7U);
}

TEST(Json, facets_wider_than_the_pitch_are_noted) {
  const auto warnings = [](const char* facet) {
    return read(json(R"("modules": [[0,0,0]], "material": {"facet_mm": )" + std::string(facet) +
                     "}"))
        .warnings;
  };
  EXPECT_TRUE(warnings("40").empty());
  EXPECT_TRUE(warnings("39.5").empty());
  ASSERT_EQ(warnings("40.5").size(), 1U);
  EXPECT_NE(warnings("40.5")[0].find("40.5 mm are wider than the pitch of 40 mm"),
            std::string::npos);
}

TEST(Json, many_different_warnings_end_in_a_count) {
  std::string members = R"("modules": [)";
  for (int i = 0; i < 150; ++i) {
    members +=
        R"({"cell": [0,0,)" + std::to_string(i) + R"(], "k)" + std::to_string(i) + R"(": 0},)";
  }
  members.back() = ']';
  const ReadDocument result =
      document_test::accepted(read_json(json(members), {.allow_unknown = true}));
  ASSERT_EQ(result.warnings.size(), 101U);
  EXPECT_EQ(result.warnings.back(), "50 further warnings are left out");
}

TEST(Json, is_written_for_people) {
  Document document;
  document.name = "gate \"north\"";
  document.material.mass_kg = 0.1;
  for (std::int32_t x = 0; x < 14; ++x) {
    document.modules.push_back({{x, 0, 0}, false, std::nullopt, {}});
  }
  document.modules.push_back({{0, 0, 1}, false, std::nullopt, {}});
  document.modules.push_back({{1, 0, 1}, true, Color{255, 0, 0}, {{"id", "4"}}});
  document.modules.push_back({{2, 0, 1}, false, std::nullopt, {}});
  document.steps = {{{{3, 0, 1}, std::nullopt, {}}, {{4, 0, 1}, std::nullopt, {}}}};
  document.world = {{"gridSize", "9,9,9"}};
  EXPECT_EQ(write_json(document), R"({
  "format": "holdfast-structure",
  "version": 1,
  "name": "gate \"north\"",
  "support_z": 0,
  "material": {"mass_kg": 0.1},
  "modules": [
    [0,0,0], [1,0,0], [2,0,0], [3,0,0], [4,0,0], [5,0,0], [6,0,0], [7,0,0], [8,0,0], [9,0,0],
    [10,0,0], [11,0,0], [12,0,0], [13,0,0],
    [0,0,1],
    {"cell": [1,0,1], "fixed": true, "color": [255,0,0], "attributes": {"id": "4"}},
    [2,0,1]
  ],
  "planned": [[3,0,1], [4,0,1]],
  "visiblesim": {
    "world": {"gridSize": "9,9,9"}
  }
}
)");
}

TEST(Json, scenarios_are_laid_out_as_the_writer_does) {
  std::size_t count = 0;
  for (const auto& file : std::filesystem::directory_iterator(HOLDFAST_SCENARIO_DIR)) {
    if (file.path().extension() != ".json") {
      continue;
    }
    SCOPED_TRACE(file.path().filename().string());
    std::ifstream stream(file.path(), std::ios::binary);
    const std::string text{std::istreambuf_iterator<char>(stream), {}};
    const ReadDocument result = read(text);
    EXPECT_TRUE(result.warnings.empty());
    EXPECT_TRUE(make_robot(result.document));
    EXPECT_EQ(write_json(result.document), text);
    ++count;
  }
  EXPECT_GE(count, 21U);
}

}  // namespace
}  // namespace holdfast::io
