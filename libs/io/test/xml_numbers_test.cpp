// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
// Whatever number of a file for VisibleSim is out of its range is named as it stands there: the
// attribute, its element and the line; never by a JSON pointer, which is not in the file.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "holdfast/io/document.hpp"
#include "holdfast/model/material.hpp"
#include "holdfast/model/robot_catalogue.hpp"

namespace holdfast::io {
namespace {

/// Line 2 is <parameters>, 5 <block>, 6 <holdfast>, 7 <knownAnswer>.
std::string file_with(const std::string& parameters, const std::string& own,
                      const std::string& answer, const std::string& block = "position=\"0,0,0\"") {
  return fmt::format(
      "<vs>\n<parameters {}/>\n<world gridSize=\"9,9,9\">\n<blockList blockSize=\"40,40,40\">\n"
      "<block {}/></blockList>\n<holdfast {}>\n<knownAnswer verdict=\"safe\" {}/>\n"
      "<extension>{{}}</extension></holdfast></world></vs>",
      parameters, block, own, answer);
}

/// The error of reading a file, or else of making a robot of it.
base::Error error_of(const std::string& file) {
  const auto read = read_visiblesim(file);
  if (!read) {
    return read.error();
  }
  const auto robot = make_robot(read.value().document);
  return robot ? base::Error{} : robot.error();
}

void expect_named(const std::string& file, const std::string& attribute, const std::string& element,
                  int line) {
  const base::Error error = error_of(file);
  EXPECT_EQ(error.where, fmt::format("line {}", line)) << error.message << file;
  EXPECT_NE(error.message.find(attribute + " of <" + element + ">"), std::string::npos)
      << error.message;
}

const std::vector<std::string> kNoNumbers = {"",      "nan", "inf", "-inf",
                                             "1e999", "two", "1,5", "1 1"};

TEST(XmlNumbers, of_the_material_are_named_by_element_attribute_and_line) {
  for (const model::MaterialParameter& parameter : model::kMaterialParameters) {
    const bool is_simulated = parameter.visiblesim != nullptr;
    const std::string name(is_simulated ? parameter.visiblesim : parameter.key);
    std::vector<std::string> values = kNoNumbers;
    for (const double value : {parameter.lowest - 0.5, parameter.lowest / 2 - 1, -1e300, 1e300,
                               parameter.highest * 1.001}) {
      values.push_back(fmt::format("{}", value));
    }
    for (const std::string& value : values) {
      const std::string attribute = fmt::format("{}=\"{}\"", name, value);
      expect_named(is_simulated ? file_with(attribute, "", "") : file_with("", attribute, ""), name,
                   is_simulated ? "parameters" : "holdfast", is_simulated ? 2 : 6);
    }
  }
}

TEST(XmlNumbers, of_all_other_attributes_are_named_too) {
  for (const std::string& value : kNoNumbers) {
    for (const char* const name : {"margin_mm", "load_ratio_max"}) {
      expect_named(file_with("", "", fmt::format("{}=\"{}\"", name, value)), name, "knownAnswer",
                   7);
    }
  }
  for (const char* const value : {"", "nan", "0.5", "1e300", "5000000000", "two", "-2000000"}) {
    expect_named(file_with(fmt::format("globalSupportZ=\"{}\"", value), "", ""), "globalSupportZ",
                 "parameters", 2);
    expect_named(file_with("", fmt::format("shift=\"0,{},0\"", value), ""), "shift", "holdfast", 6);
    // Of a position the whole part is taken.
    if (std::string_view(value) != "0.5") {
      expect_named(file_with("", "", "", fmt::format("position=\"0,{},0\"", value)), "position",
                   "block", 5);
    }
  }
}

/// A figure that follows from the pitch, such as a section that is not published, is out of its
/// range first.
TEST(XmlNumbers, that_follow_from_the_pitch_say_so) {
  int count = 0;
  for (const model::CatalogueRobot& robot : model::robot_catalogue()) {
    const base::Error error =
        error_of(file_with("globalL=\"1e9\" globalMass=\"1\"",
                           fmt::format("robot=\"{}\" strength_vertical_n=\"1\" "
                                       "strength_lateral_n=\"1\"",
                                       robot.name),
                           ""));
    if (error.message.find("follows from globalL, is ") != std::string::npos) {
      EXPECT_EQ(error.where, "line 2");
      ++count;
    }
  }
  EXPECT_GT(count, 0);
}

/// The text of the extension is JSON, so a pointer within its element is right for what is wrong
/// there; what else is wrong with the file is in its attributes.
TEST(XmlNumbers, of_the_extension_are_named_within_it) {
  const std::string extension = R"({"floor": {"friction": 1}, "gravity_m_s2": [0, 1, -9],
      "material": {"strength_n": 1, "lever_mm": [1, 2, 3], "friction": {"vertical": 1}},
      "kinds": {"b": {"mass_kg": 1, "shear_strength_n": 1}},
      "obstacles": [{"from": [3, 0, 0], "to": [4, 1, 1], "friction": 1}],
      "loads": [{"cell": [0, 0, 0], "force_n": [1, 0, 0]}],
      "steps": [{"attach": [[0, 0, 1]]}]})";
  std::size_t count = 0;
  for (std::size_t i = 0; i < extension.size(); ++i) {
    if (extension[i] < '0' || extension[i] > '9' || extension[i - 1] == 's') {
      continue;
    }
    for (const char* const value : {"-1e300", "-1", "0", "1e-13", "1e300", "\"1\"", "null", "{}"}) {
      std::string changed = extension;
      changed.replace(i, 1, value);
      std::string file = file_with("", "", "");
      file.replace(file.find("{}"), 2, changed);
      const auto read = read_visiblesim(file);
      const auto spec = read ? make_sequence(read.value().document) : read.error();
      if (spec) {
        continue;
      }
      ++count;
      EXPECT_EQ(spec.error().where, "line 8") << spec.error().message << changed;
      EXPECT_NE(spec.error().message.find("in <extension>: "), std::string::npos)
          << spec.error().message;
    }
  }
  EXPECT_GT(count, 100U);
}

TEST(XmlNumbers, kinds_that_are_none_are_named_by_the_attribute) {
  const base::Error error =
      error_of(file_with("", "", "", "position=\"0,0,1\" holdfastKind=\"q\""));
  EXPECT_EQ(error.where, "line 8");
  EXPECT_EQ(error.message.find("holdfastKind of <block> at (0,0,1): the kind 'q' is not in "), 0U)
      << error.message;
}

/// The steps of one document by the file's words, whichever it is read from.
TEST(XmlNumbers, steps_are_named_as_the_file_writes_them) {
  Document document;
  document.modules.push_back({{0, 0, 0}, false, std::nullopt, {}});
  document.steps = {{{{0, 0, 1}, std::nullopt, {}}}, {{{0, 0, 2}, std::nullopt, {}}}};
  document.extension.plan = {{.detach = {{0, 0, 2}}}};
  const auto names = [](const base::Result<ReadDocument>& read) {
    std::vector<std::string> list;
    for (std::size_t i = 0; i < step_count(read.value().document); ++i) {
      list.push_back(step_pointer(read.value().document, i));
    }
    return list;
  };
  EXPECT_EQ(names(read_json(write_json(document))),
            (std::vector<std::string>{"/planned", "/later_steps/0", "/steps/0"}));
  EXPECT_EQ(
      names(read_visiblesim(write_visiblesim(document))),
      (std::vector<std::string>{"<target format=\"grid\">, number 1",
                                "<target format=\"grid\">, number 2", "/steps/0 in <extension>"}));
}

/// VisibleSim's files may end with steps without cells, which say nothing there.
TEST(XmlNumbers, a_step_without_cells_before_another_is_refused_at_its_line) {
  const auto read = [](const std::string& targets) {
    std::string file = file_with("", "", "");
    file.replace(file.find("\n<holdfast"), 1, "\n<targetList>" + targets + "</targetList>");
    return read_visiblesim(file);
  };
  const std::string full = "<target format=\"grid\"><cell position=\"1,0,0\"/></target>\n";
  const std::string empty = "<target format=\"grid\"/>\n";
  EXPECT_TRUE(read(full + empty + empty));
  EXPECT_TRUE(read(empty + full));
  const auto refused = read(full + empty + full);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().where, "line 7");
}

}  // namespace
}  // namespace holdfast::io
