// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
//
// The catalogue of robots: every entry has what a robot is computed from, or says that it was not
// found; every figure has a source; Blinky Blocks are Table I of [Piranda 2021].
#include "holdfast/model/robot_catalogue.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <string>

namespace holdfast::model {
namespace {

constexpr std::string_view kLawKeys[] = {"lever_mm", "shear_strength_n", "torsion_strength_nmm"};

TEST(RobotCatalogue, has_every_robot_once) {
  std::set<std::string_view> names;
  for (const CatalogueRobot& robot : robot_catalogue()) {
    EXPECT_TRUE(names.insert(robot.name).second) << robot.name;
    EXPECT_EQ(find_robot(robot.name), &robot);
    EXPECT_FALSE(robot.title.empty());
  }
  EXPECT_EQ(find_robot("blinky"), nullptr);
}

TEST(RobotCatalogue, says_of_every_parameter_what_it_is_or_that_it_was_not_found) {
  for (const CatalogueRobot& robot : robot_catalogue()) {
    SCOPED_TRACE(robot.name);
    for (double Material::*const required : kRobotParameters) {
      const auto* const parameter =
          std::ranges::find(kMaterialParameters, required, &MaterialParameter::value);
      EXPECT_EQ(std::ranges::count(robot.figures, parameter->key, &RobotFigure::key), 1)
          << parameter->key;
    }
  }
}

TEST(RobotCatalogue, has_a_source_and_an_allowed_value_of_every_figure) {
  for (const CatalogueRobot& robot : robot_catalogue()) {
    for (const RobotFigure& figure : robot.figures) {
      SCOPED_TRACE(std::string(robot.name) + " " + std::string(figure.key));
      EXPECT_FALSE(figure.source.empty());
      EXPECT_EQ(figure.value.has_value(), figure.certainty != Certainty::kNotFound);
      EXPECT_TRUE(find_parameter(figure.key) != nullptr ||
                  std::ranges::find(kLawKeys, figure.key) != std::end(kLawKeys));
      EXPECT_GT(figure.value.value_or(1), 0);
    }
  }
}

TEST(RobotCatalogue, makes_a_material_that_can_be_computed_once_nothing_is_open) {
  for (const CatalogueRobot& robot : robot_catalogue()) {
    SCOPED_TRACE(robot.name);
    Material material = catalogue_material(robot);
    for (double Material::*const required : kRobotParameters) {
      double& value = material.*required;
      value = std::isnan(value) ? 1 : value;
    }
    fill_section(material);
    EXPECT_EQ(find_material_fault(material), std::nullopt);
  }
}

TEST(RobotCatalogue, has_blinky_blocks_as_the_paper_has_them) {
  Material material = catalogue_material(*find_robot("blinky-blocks"));
  fill_section(material);
  EXPECT_EQ(material, Material{});
}

/// A square of 10 mm has 100 mm^2, 10^4 / 12 mm^4, and 2.25 times the fourth power of half its
/// side.
TEST(RobotCatalogue, fills_what_is_open_of_the_section_only) {
  Material material = catalogue_material(*find_robot("soldercubes"));
  material.pitch_mm = 10;
  material.facet_mm = 7;
  fill_section(material);
  EXPECT_EQ(material.facet_mm, 7);
  EXPECT_EQ(material.section_area_mm2, 100);
  EXPECT_EQ(material.moment_x_mm4, 10'000.0 / 12);
  EXPECT_EQ(material.torsion_mm4, 2.25 * 625);
  EXPECT_TRUE(std::isnan(material.mass_kg));
}

}  // namespace
}  // namespace holdfast::model
