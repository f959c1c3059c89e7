// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "holdfast/model/robot_catalogue.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace holdfast::model {
namespace {

constexpr double kOpen = std::numeric_limits<double>::quiet_NaN();

constexpr std::string_view kPaper =
    "Piranda, Chodkiewicz, Holobut, Bordas, Bourgeois and Lengiewicz 2021, Table I";
constexpr std::string_view kRofiPage = "ro.fi.muni.cz/hardware/connector";
constexpr std::string_view kPebblesPaper =
    "Gilpin, Knaian and Rus, ICRA 2010, doi 10.1109/ROBOT.2010.5509817";
constexpr std::string_view kSolderPage = "jonasneubert.com/projects/modularrobotics";

CatalogueRobot blinky_blocks() {
  return {"blinky-blocks",
          "Blinky Blocks",
          base::kCubic,
          "The default of every file that names no robot.",
          {{"pitch_mm", 40, Certainty::kPublished, kPaper},
           {"mass_kg", 0.06106, Certainty::kPublished, kPaper},
           {"strength_vertical_n", 11.98, Certainty::kPublished, kPaper},
           {"strength_lateral_n", 14.97, Certainty::kPublished, kPaper}}};
}

CatalogueRobot rofi() {
  constexpr std::string_view kMassSource =
      "half of 0.70 kg, the sum of the masses in the simulation model of paradise-fi/RoFI "
      "(data/gazebo/models/universalModule), which its authors have not checked";
  return {
      "rofi",
      "RoFI universal module",
      base::kCubic,
      "A universal module fills two cells, so that each cell here is half of it; its own joints "
      "are taken to be as strong as its connectors.",
      {{"pitch_mm", 100, Certainty::kDerived,
        "places of connectors in the simulation model of paradise-fi/RoFI"},
       {"mass_kg", 0.35, Certainty::kDerived, kMassSource},
       {"strength_vertical_n", 110, Certainty::kProjectPage, kRofiPage},
       {"strength_lateral_n", 110, Certainty::kProjectPage, kRofiPage},
       {"shear_strength_n", 50, Certainty::kProjectPage, kRofiPage},
       {"lever_mm", 25, Certainty::kDerived,
        "radius of the connector, which is 50 mm wide: its page"}}};
}

CatalogueRobot smores_ep() {
  constexpr std::string_view kHold =
      "jpralves.net/post/2018/11/01/smores-ep.html, after the University of Pennsylvania";
  return {"smores-ep",
          "SMORES-EP",
          base::kCubic,
          "",
          {{"pitch_mm", 80, Certainty::kDerived, "constants in the programs of MOD-ASL"},
           {"mass_kg", {}, Certainty::kNotFound, "no source could be read"},
           {"strength_vertical_n", 89, Certainty::kSecondHand, kHold},
           {"strength_lateral_n", 89, Certainty::kSecondHand, kHold}}};
}

CatalogueRobot robot_pebbles() {
  constexpr std::string_view kHold =
      "the lower end of 2.06 to 3.18 N, after Gilpin, Knaian and Rus, ICRA 2010";
  return {"robot-pebbles",
          "Robot Pebbles",
          base::kCubic,
          "Pebbles have connectors on four sides and make flat shapes.",
          {{"pitch_mm", 12, Certainty::kPublished, kPebblesPaper},
           {"mass_kg", 0.0038, Certainty::kDerived,
            "at most: 3.18 N are said to be over 85 times the weight of a module"},
           {"strength_vertical_n", 2.06, Certainty::kSecondHand, kHold},
           {"strength_lateral_n", 2.06, Certainty::kSecondHand, kHold}}};
}

CatalogueRobot soldercubes() {
  return {"soldercubes",
          "Soldercubes",
          base::kCubic,
          "",
          {{"pitch_mm", {}, Certainty::kNotFound, "no source could be read"},
           {"mass_kg", {}, Certainty::kNotFound, "no source could be read"},
           {"strength_vertical_n", 173, Certainty::kPublished, kSolderPage},
           {"strength_lateral_n", 173, Certainty::kPublished, kSolderPage}}};
}

CatalogueRobot catoms_3d() {
  constexpr std::string_view kNothing = "no measured figure could be read";
  return {"catoms-3d",
          "3D catoms",
          base::kFaceCentred,
          "A template: the lattice only.",
          {{"pitch_mm", {}, Certainty::kNotFound, kNothing},
           {"mass_kg", {}, Certainty::kNotFound, kNothing},
           {"strength_vertical_n", {}, Certainty::kNotFound, kNothing},
           {"strength_lateral_n", {}, Certainty::kNotFound, kNothing}}};
}

}  // namespace

const char* name(Certainty certainty) {
  static constexpr std::array<const char*, 5> kNames = {"published", "project page", "second hand",
                                                        "derived", "not found"};
  return kNames[static_cast<std::size_t>(certainty)];
}

std::optional<double> CatalogueRobot::value(std::string_view key) const {
  const auto found = std::ranges::find(figures, key, &RobotFigure::key);
  return found == figures.end() ? std::nullopt : found->value;
}

std::span<const CatalogueRobot> robot_catalogue() {
  static const std::array<CatalogueRobot, 6> robots = {blinky_blocks(), rofi(),        smores_ep(),
                                                       robot_pebbles(), soldercubes(), catoms_3d()};
  return robots;
}

const CatalogueRobot* find_robot(std::string_view name) {
  const std::span<const CatalogueRobot> robots = robot_catalogue();
  const auto found = std::ranges::find(robots, name, &CatalogueRobot::name);
  return found == robots.end() ? nullptr : &*found;
}

Material catalogue_material(const CatalogueRobot& robot) {
  Material material{.facet_mm = kOpen,
                    .section_area_mm2 = kOpen,
                    .moment_x_mm4 = kOpen,
                    .moment_y_mm4 = kOpen,
                    .torsion_mm4 = kOpen};
  for (double Material::*const required : kRobotParameters) {
    material.*required = kOpen;
  }
  for (const MaterialParameter& parameter : kMaterialParameters) {
    if (const auto value = robot.value(parameter.key)) {
      material.*parameter.value = *value;
    }
  }
  return material;
}

void fill_section(Material& material) {
  const double width = material.pitch_mm;
  const double half = width / 2;
  const auto fill = [](double& number, double value) {
    number = std::isnan(number) ? value : number;
  };
  fill(material.facet_mm, width);
  fill(material.section_area_mm2, width * width);
  fill(material.moment_x_mm4, width * width * width * width / 12);
  fill(material.moment_y_mm4, width * width * width * width / 12);
  fill(material.torsion_mm4, 2.25 * half * half * half * half);
}

}  // namespace holdfast::model
