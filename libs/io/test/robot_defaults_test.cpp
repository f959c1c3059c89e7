// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
//
// "robot" in a file takes the figures of the catalogue for what the file does not say; what the
// catalogue does not know the file must say. Expected values are those of the catalogue's sources.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <fstream>
#include <sstream>
#include <string>

#include "document_support.hpp"
#include "holdfast/io/lattice_names.hpp"
#include "holdfast/model/robot_catalogue.hpp"

namespace holdfast::io {
namespace {

using document_test::accepted;

std::string document_text(const std::string& name) {
  std::ifstream file(std::string(HOLDFAST_DOCUMENT_DIR) + "/" + name);
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

std::string file(std::string_view members) {
  return R"({"format": "holdfast-structure", "version": 2, "modules": [[0,0,0], [0,0,1]], )" +
         std::string(members) + "}";
}

Document read(std::string_view members, const ReadOptions& options = {}) {
  return accepted(read_json(file(members), options)).document;
}

void expect_kept(const Document& document) {
  EXPECT_EQ(accepted(read_json(write_json(document))).document, document) << write_json(document);
  EXPECT_EQ(accepted(read_visiblesim(write_visiblesim(document))).document, document)
      << write_visiblesim(document);
}

TEST(RobotDefaults, are_table_1_for_blinky_blocks) {
  EXPECT_EQ(read(R"("robot": "blinky-blocks")").material, model::Material());
}

TEST(RobotDefaults, are_what_the_catalogue_has) {
  const Document document = read(R"("robot": "rofi", "material": {"mass_kg": 0.4})");
  EXPECT_EQ(document.material.pitch_mm, 100);
  EXPECT_EQ(document.material.facet_mm, 100);
  EXPECT_EQ(document.material.mass_kg, 0.4);
  EXPECT_EQ(document.material.strength_vertical_n, 110);
  EXPECT_EQ(document.material.gravity_m_s2, 9.81);
  const auto spec = make_spec(document);
  ASSERT_TRUE(spec) << spec.error().message;
  ASSERT_EQ(spec.value().kinds.size(), 1U);
  for (const model::ConnectorLaw& law : spec.value().kinds[0].connectors) {
    EXPECT_EQ(law.strength_n, 110);
    EXPECT_EQ(law.shear_strength_n, 50);
    EXPECT_EQ(law.lever_mm, 25);
  }
}

TEST(RobotDefaults, give_way_to_what_the_file_says_of_connections) {
  const auto spec =
      make_spec(read(R"("robot": "rofi", "material": {"shear_strength_n": null, "lever_mm": 7})"));
  ASSERT_TRUE(spec);
  EXPECT_EQ(spec.value().kinds[0].connectors[0].shear_strength_n, model::ConnectorLaw::kUnlimited);
  EXPECT_EQ(spec.value().kinds[0].connectors[0].lever_mm, 7);
}

/// The section is that of Blinky Blocks at a tenth of their size: areas are divided by 100, moments
/// by 10^4.
TEST(RobotDefaults, make_the_section_of_beams_as_wide_as_the_pitch) {
  const model::Material material =
      read(R"("robot": "soldercubes", "material": {"pitch_mm": 4, "mass_kg": 1})").material;
  EXPECT_DOUBLE_EQ(material.section_area_mm2, 16);
  EXPECT_DOUBLE_EQ(material.moment_x_mm4, model::Material().moment_x_mm4 / 1e4);
  EXPECT_DOUBLE_EQ(material.torsion_mm4, model::Material().torsion_mm4 / 1e4);
}

TEST(RobotDefaults, give_the_lattice) {
  const std::string_view catoms =
      R"("robot": "catoms-3d", "material": {"pitch_mm": 4, "mass_kg": 1e-5,
         "strength_vertical_n": 1, "strength_lateral_n": 1})";
  EXPECT_EQ(read(catoms).extension.lattice, base::kFaceCentred);
  EXPECT_EQ(read(std::string(catoms) + R"(, "lattice": "cubic")").extension.lattice, base::kCubic);
}

TEST(RobotDefaults, that_are_not_known_must_be_said) {
  const auto refused = read_json(file(R"("robot": "catoms-3d", "material": {"mass_kg": 1})"));
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().where, "/material");
  EXPECT_EQ(refused.error().message,
            "of the robot catoms-3d no pitch_mm, strength_vertical_n, strength_lateral_n is "
            "published: the structure must say it in its material");
  for (const model::CatalogueRobot& robot : model::robot_catalogue()) {
    bool is_known = true;
    for (const model::RobotFigure& figure : robot.figures) {
      is_known = is_known && figure.value;
    }
    EXPECT_EQ(bool(read_json(file("\"robot\": \"" + std::string(robot.name) + "\""))), is_known)
        << robot.name;
  }
}

TEST(RobotDefaults, are_kept_by_name_in_both_formats) {
  expect_kept(read(R"("robot": "blinky-blocks")"));
  expect_kept(read(R"("robot": "rofi")"));
  expect_kept(read(R"("robot": "rofi", "lattice": "hexagonal-prism", "material": {"pitch_mm": 50,
      "facet_mm": 40, "mass_kg": 0.06106, "strength_lateral_n": 14.97, "lever_mm": 3})"));
  expect_kept(read(R"("robot": "soldercubes", "material": {"pitch_mm": 40, "mass_kg": 0.06106})"));
  const std::string text = write_json(read(R"("robot": "rofi")"));
  EXPECT_EQ(text.find("material"), std::string::npos) << text;
}

TEST(RobotDefaults, are_those_of_the_robot_that_is_asked_for) {
  EXPECT_EQ(read(R"("name": "a")", {.robot = "rofi"}), read(R"("name": "a", "robot": "rofi")"));
  const Document old =
      accepted(read_json(document_test::json(R"("modules": [[0,0,0]])"), {.robot = "rofi"}))
          .document;
  EXPECT_EQ(old.material.pitch_mm, 100);
  const Document xml =
      accepted(read_visiblesim("<world><blockList><block position=\"0,0,0\"/></blockList></world>",
                               {.robot = "rofi"}))
          .document;
  EXPECT_EQ(xml.material.mass_kg, 0.35);
}

/// The page for people and the schema for editors say what the program has.
TEST(RobotDefaults, are_documented_with_every_source) {
  const std::string page = document_text("robots.md");
  const std::string schema = document_text("structure.schema.json");
  for (const model::CatalogueRobot& robot : model::robot_catalogue()) {
    EXPECT_NE(page.find(fmt::format("## `{}`: {}\n\nLattice `{}`.", robot.name, robot.title,
                                    lattice_name(robot.lattice))),
              std::string::npos)
        << robot.name;
    EXPECT_NE(page.find(robot.note), std::string::npos) << robot.note;
    EXPECT_NE(schema.find(fmt::format("\"{}\"", robot.name)), std::string::npos) << robot.name;
    for (const model::RobotFigure& figure : robot.figures) {
      const std::string value = figure.value ? fmt::format("{}", *figure.value) : "-";
      const std::string row = fmt::format("| `{}` | {} | {} | {} |\n", figure.key, value,
                                          model::name(figure.certainty), figure.source);
      EXPECT_NE(page.find(row), std::string::npos) << robot.name << ": " << row;
    }
  }
}

TEST(RobotDefaults, say_what_is_wrong) {
  const auto refused = [](std::string_view members, const ReadOptions& options,
                          std::string_view message) {
    const auto result = read_json(file(members), options);
    ASSERT_FALSE(result);
    EXPECT_EQ(result.error().where, "/robot");
    EXPECT_NE(result.error().message.find(message), std::string::npos) << result.error().message;
  };
  refused(R"("robot": "lego")", {}, "the catalogue has blinky-blocks, rofi, smores-ep");
  refused(R"("robot": "rofy")", {}, "unknown robot 'rofy'; did you mean 'rofi'?");
  refused(R"("robot": 7)", {}, "a string");
  refused(R"("robot": "")", {}, "the name of a robot");
  refused(R"("robot": "rofi")", {.robot = "smores-ep"}, "but 'smores-ep' is asked for");
}

}  // namespace
}  // namespace holdfast::io
