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

/// Read or made into a robot, whichever refuses it.
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
    const std::string name = is_simulated ? parameter.visiblesim : parameter.key;
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
    expect_named(file_with("", "", "", fmt::format("position=\"0,{},0\"", value)), "position",
                 "block", 5);
  }
}

/// Such as the section of a robot of which none is published: it is out of its range first.
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

}  // namespace
}  // namespace holdfast::io
