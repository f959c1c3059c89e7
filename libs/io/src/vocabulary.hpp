// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <initializer_list>
#include <string_view>

#include "holdfast/model/material.hpp"

/// What things are called in files, once for all readers and writers.
namespace holdfast::io {

inline constexpr std::string_view kJsonFormatName = "holdfast-structure";
inline constexpr int kJsonVersion = 1;

struct MaterialParameter {
  const char* key;         ///< In holdfast JSON.
  const char* visiblesim;  ///< Attribute of <parameters>; nullptr: VisibleSim has no word for it.
  double model::Material::*value;
};

/// VisibleSim counts its moments the other way round: its Iy bends lateral beams in the vertical
/// plane, which is our Ix.
inline constexpr auto kMaterialParameters = std::to_array<MaterialParameter>({
    {"elastic_modulus_mpa", "E", &model::Material::elastic_modulus_mpa},
    {"pitch_mm", "globalL", &model::Material::pitch_mm},
    {"facet_mm", "a", &model::Material::facet_mm},
    {"section_area_mm2", "A", &model::Material::section_area_mm2},
    {"moment_x_mm4", "globalIy", &model::Material::moment_x_mm4},
    {"moment_y_mm4", "globalIz", &model::Material::moment_y_mm4},
    {"torsion_mm4", "globalJ", &model::Material::torsion_mm4},
    {"poisson_ratio", "globalNu", &model::Material::poisson_ratio},
    {"mass_kg", "globalMass", &model::Material::mass_kg},
    {"gravity_m_s2", nullptr, &model::Material::gravity_m_s2},
    {"strength_vertical_n", nullptr, &model::Material::strength_vertical_n},
    {"strength_lateral_n", nullptr, &model::Material::strength_lateral_n},
    {"contact_gamma", "globalGamma", &model::Material::contact_gamma},
});

/// The attribute of <parameters> that is Document::support_z.
inline constexpr const char* kSupportParameter = "globalSupportZ";

/// Our own child of <world>, for what VisibleSim has no word for.
inline constexpr const char* kOwnElement = "holdfast";

/// Its attribute `computed` with this value says that a writer had to make gridSize up.
inline constexpr const char* kGridSize = "gridSize";

constexpr bool is_one_of(std::string_view name, std::initializer_list<std::string_view> names) {
  return std::ranges::find(names, name) != names.end();
}

/// Attributes of <parameters> that are part of the material or the support level.
constexpr bool is_mechanical_parameter(std::string_view name) {
  return name == kSupportParameter ||
         std::ranges::any_of(kMaterialParameters, [&](const MaterialParameter& parameter) {
           return parameter.visiblesim != nullptr && parameter.visiblesim == name;
         });
}

/// Attributes of <parameters> that only VisibleSim's own solver has a use for.
constexpr bool is_solver_parameter(std::string_view name) {
  return is_one_of(name, {"nofIterations", "preconditioner", "globalBeta", "globalEps", "globalMu",
                          "globalOmega", "globalI"});
}

/// Attributes of <cell>, and those of <block>, that have members of their own in a Document.
constexpr bool is_planned_attribute(std::string_view name) {
  return is_one_of(name, {"position", "color"});
}

constexpr bool is_module_attribute(std::string_view name) {
  return is_planned_attribute(name) || name == "fixed";
}

/// Attributes of <block> that VisibleSim gives a meaning without one for mechanics.
constexpr bool is_simulation_attribute(std::string_view name) {
  return is_one_of(name, {"centroid", "solver", "stabilityCheck", "id", "master"});
}

/// Children of <world> that are not scenery.
constexpr bool is_structural_element(std::string_view name) {
  return is_one_of(name, {"blockList", "targetList", kOwnElement});
}

/// Children of <world> that may be there without a warning.
constexpr bool is_scenery_element(std::string_view name) {
  return is_one_of(name, {"camera", "spotlight", "customization"});
}

constexpr bool is_known_verdict(std::string_view name) {
  return is_one_of(name, {"safe", "overload", "unstable"});
}

}  // namespace holdfast::io
