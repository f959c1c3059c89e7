// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "holdfast/base/lattice.hpp"
#include "holdfast/model/material.hpp"

/// Lists what is known of robots that have been built, each figure with its source.
namespace holdfast::model {

enum class Certainty : std::uint8_t {
  kPublished,    ///< Measured, in a paper.
  kProjectPage,  ///< Said by those who built it, without how it was measured.
  kSecondHand,   ///< Measured by those who built it, but quoted from others.
  kDerived,      ///< From other figures, or from a model.
  kNotFound,     ///< Not published as far as we know: whoever uses the robot says it.
};

/// Returns "published", "project page", "second hand", "derived" or "not found".
const char* name(Certainty certainty);

/// A number of a robot. A range is entered with the end that holds less.
struct RobotFigure {
  std::string_view key;  ///< As in the material of holdfast JSON, with the unit.
  std::optional<double> value;
  Certainty certainty = Certainty::kNotFound;
  std::string_view source;  ///< Where it comes from; what is known if there is no value.
};

struct CatalogueRobot {
  std::string_view name;   ///< As in files, such as "blinky-blocks".
  std::string_view title;  ///< For people.
  base::Lattice lattice;
  std::string_view note;  ///< What to know before the figures are used; may be empty.
  std::vector<RobotFigure> figures;

  /// The value of a figure; none if the robot has no such figure, or its value was not found.
  std::optional<double> value(std::string_view key) const;
};

/// All robots, in the order in which lists show them.
std::span<const CatalogueRobot> robot_catalogue();

/// The robot of that name; nullptr if there is none.
const CatalogueRobot* find_robot(std::string_view name);

/// The parameters of a material that every robot of the catalogue has a figure for, found or not.
inline constexpr double Material::*kRobotParameters[] = {&Material::pitch_mm, &Material::mass_kg,
                                                         &Material::strength_vertical_n,
                                                         &Material::strength_lateral_n};

/// The robot's material: its figures, not a number where none was found, and not a number for what
/// fill_section() finds.
Material catalogue_material(const CatalogueRobot& robot);

/// Gives what is not a number of the section of beams (facet, area, moments, torsion) the value of
/// a full cube as wide as the pitch, as Table I of [Piranda 2021] has it for Blinky Blocks.
void fill_section(Material& material);

}  // namespace holdfast::model
