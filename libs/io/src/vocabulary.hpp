// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <initializer_list>
#include <string_view>
#include <vector>

#include "holdfast/io/extension.hpp"
#include "holdfast/model/material.hpp"

/// Names things in files, once for all readers and writers.
namespace holdfast::io {

inline constexpr std::string_view kJsonFormatName = "holdfast-structure";
inline constexpr int kJsonVersionMax = 2;

/// The root element of VisibleSim's newer files, around all others.
inline constexpr const char* kRootElement = "vs";

/// The reason why a structure of datoms cannot be read.
inline constexpr const char* kNoDatoms =
    "datoms sit in a skewed face-centred lattice and change their shape, which this program does "
    "not know";

/// The attribute that datoms have, and no others.
inline constexpr const char* kDatomAttribute = "piston";

/// The attribute of <parameters> that is Document::support_z.
inline constexpr const char* kSupportParameter = "globalSupportZ";

/// Our own child of <world>, for what VisibleSim has no word for.
inline constexpr const char* kOwnElement = "holdfast";

/// VisibleSim's element of cells that no module can take; attributes of its children of ours.
inline constexpr const char* kObstacleListElement = "obstacleList";
inline constexpr const char* kObstacleElement = "obstacle";
inline constexpr auto kObstacleAttributes =
    std::to_array<std::string_view>({"position", "color", "hold", "friction", "to"});

/// The attribute for how a module is turned in its cell, of VisibleSim's catoms and hexanodes.
inline constexpr const char* kOrientation = "orientation";

/// Attributes of ours for what a module has of its own, and the child of <holdfast> with what else
/// only version 2 of holdfast JSON says.
inline constexpr const char* kOwnKindAttribute = "holdfastKind";
inline constexpr const char* kOwnMassAttribute = "holdfastMass";
inline constexpr const char* kExtensionElement = "extension";

/// The value of the attribute `computed` of <holdfast> that says that a writer had to make gridSize
/// up.
inline constexpr const char* kGridSize = "gridSize";

/// The attribute of <holdfast>, and its only value, that says that targets list planned modules
/// though they look like a shape to reach. A structure with such planned modules is no robot, but
/// it is read as it was written.
inline constexpr const char* kTargets = "targets";
inline constexpr const char* kPlannedTargets = "planned";

/// The attribute of <holdfast> that says what a writer has added to every cell and to the support
/// level.
inline constexpr const char* kShift = "shift";

constexpr bool is_one_of(std::string_view name, std::initializer_list<std::string_view> names) {
  return std::ranges::find(names, name) != names.end();
}

/// Attributes of <parameters> that are part of the material or the support level.
constexpr bool is_mechanical_parameter(std::string_view name) {
  return name == kSupportParameter ||
         std::ranges::any_of(
             model::kMaterialParameters, [&](const model::MaterialParameter& parameter) {
               return parameter.visiblesim != nullptr && parameter.visiblesim == name;
             });
}

template <std::size_t A, std::size_t B>
constexpr std::array<std::string_view, A + B> joined(const std::array<std::string_view, A>& a,
                                                     const std::array<std::string_view, B>& b) {
  std::array<std::string_view, A + B> all;
  std::copy(b.begin(), b.end(), std::copy(a.begin(), a.end(), all.begin()));
  return all;
}

// All the names that may stand in one place, those included that only VisibleSim's own reader or
// its shipped examples have a use for: what is like one of them, but none, is a slip.

inline constexpr auto kModuleKeys =
    std::to_array<std::string_view>({"cell", "fixed", "color", "attributes"});
inline constexpr auto kTopKeys = std::to_array<std::string_view>(
    {"$schema", "format", "version", "name", "description", "support_z", "material", "modules",
     "planned", "later_steps", "known_answer", "visiblesim"});

inline constexpr std::string_view kSafetyFactorKey = "safety_factor";

/// The keys that only version 2 has.
inline constexpr auto kExtensionKeys = std::to_array<std::string_view>(
    {"robot", "lattice", kSafetyFactorKey, "floor", "gravity_m_s2", "kinds", "joined", "open",
     "connections", "bodies", "obstacles", "loads", "steps"});
inline constexpr auto kAllTopKeys = joined(kTopKeys, kExtensionKeys);
inline constexpr auto kOwnParameterKeys = std::to_array<std::string_view>({"kind", "mass_kg"});
/// The keys of many modules in one entry.
inline constexpr auto kShapeKeys = std::to_array<std::string_view>({"from", "to", "layers", "at"});
inline constexpr auto kAllModuleKeys = joined(joined(kModuleKeys, kOwnParameterKeys), kShapeKeys);

/// Parameters of connections that only version 2 has, of the material and of kinds of modules.
inline constexpr std::string_view kBendingKey = "bending";
inline constexpr std::string_view kStrengthKey = "strength_n";  ///< Instead of kClassStrengthKeys.
inline constexpr auto kConnectorKeys = std::to_array<std::string_view>(
    {kStrengthKey, "lever_mm", "shear_strength_n", "torsion_strength_nmm", "friction",
     "torsion_radius_mm", "gap_limit_mm", kBendingKey});

/// The strengths of Table I, by base::ConnectorClass, and the keys of a value for each class.
inline constexpr auto kClassStrengthKeys =
    std::to_array<std::string_view>({"strength_vertical_n", "strength_lateral_n"});
inline constexpr auto kClassKeys = std::to_array<std::string_view>({"vertical", "lateral"});

/// Whether a parameter of connections is a strength, which safety factors divide.
constexpr bool is_strength_key(std::string_view key) {
  return is_one_of(key, {kStrengthKey, kClassStrengthKeys[0], kClassStrengthKeys[1],
                         "shear_strength_n", "torsion_strength_nmm"});
}

/// How strengths and masses scatter: keys of the material, some of kinds and of connections.
inline constexpr auto kScatterKeys =
    std::to_array<std::string_view>({"strength_cv", "mass_cv", "strength_distribution"});
inline constexpr auto kKindScatterKeys =
    std::to_array<std::string_view>({kScatterKeys[0], kScatterKeys[1]});
inline constexpr auto kConnectionScatterKeys =
    std::to_array<std::string_view>({kScatterKeys[0], kScatterKeys[2]});

/// The key of the material for the width of the facets of modules that are no cubes.
inline constexpr std::string_view kFootKey = "foot_mm";

/// A number of the material; a list of three by direction is part of the extension.
inline constexpr std::string_view kPitchKey = "pitch_mm";

/// The parameters in which a kind of modules may differ from the material.
inline constexpr auto kKindKeys =
    joined(joined(joined(std::to_array<std::string_view>({"mass_kg"}), kClassStrengthKeys),
                  kConnectorKeys),
           kKindScatterKeys);

/// Names of how bending moments about two axes count together, by model::BendingLaw.
inline constexpr auto kBendingNames = std::to_array<std::string_view>({"square", "round"});
/// The keys of a connection that a file names.
inline constexpr std::string_view kBetweenKey = "between";
inline constexpr auto kConnectionKeys = joined(
    joined(std::to_array<std::string_view>({kBetweenKey}), kConnectorKeys), kConnectionScatterKeys);
/// Names of which neighbours are joined: all but the open ones, or those that "connections" lists.
inline constexpr auto kJoinedNames = std::to_array<std::string_view>({"all", "listed"});
inline constexpr auto kFloorKeys = std::to_array<std::string_view>({"friction"});
inline constexpr auto kObstacleKeys =
    std::to_array<std::string_view>({"from", "to", "cells", "hold", "friction", "color"});
inline constexpr auto kLoadKeys =
    std::to_array<std::string_view>({"cell", "force_n", "torque_nmm"});
inline constexpr std::string_view kAnyOrderKey = "any_order";
inline constexpr std::string_view kApartKey = "apart";
inline constexpr auto kStepLists =
    std::to_array<std::string_view>({"attach", "detach", "move", "release", "connect"});
inline constexpr auto kStepKeys =
    joined(kStepLists, std::to_array<std::string_view>({kAnyOrderKey, kApartKey}));
inline constexpr auto kMoveKeys = std::to_array<std::string_view>({"from", "to", "carrier"});

/// Names of what an obstacle does, by model::Hold.
inline constexpr auto kHoldNames = std::to_array<std::string_view>({"contact", "bonded"});

inline constexpr auto kKnownAnswerKeys =
    std::to_array<std::string_view>({"verdict", "margin_mm", "load_ratio_max", "source"});
inline constexpr auto kVisibleSimKeys = std::to_array<std::string_view>(
    {"parameters", "world", "block_list", "obstacle_list", "scenery", "targets"});
inline constexpr auto kPlannedKeys =
    std::to_array<std::string_view>({"cell", "color", "attributes"});
inline constexpr auto kAllPlannedKeys = joined(joined(kPlannedKeys, kOwnParameterKeys), kShapeKeys);
inline constexpr auto kElementKeys =
    std::to_array<std::string_view>({"element", "attributes", "text", "children"});

inline constexpr auto kWorldAttributes = std::to_array<std::string_view>(
    {kGridSize, "windowSize", "maxSimulationTime", "separatorPlane"});
inline constexpr auto kBlockListAttributes = std::to_array<std::string_view>(
    {"blockSize", "color", "orientation", "size", "ids", "idseed", "seed", "step", "format"});
inline constexpr auto kBlockAttributes = std::to_array<std::string_view>(
    {"position", "color", "fixed", "centroid", "solver", "stabilityCheck", "id", "master", "leader",
     "alive", "angle", "orientation", "rotation", kDatomAttribute, "isTarget", "isWall",
     kOwnKindAttribute, kOwnMassAttribute});
inline constexpr auto kCellAttributes =
    std::to_array<std::string_view>({"position", "color", kOwnKindAttribute, kOwnMassAttribute});
inline constexpr auto kRowAttributes =
    std::to_array<std::string_view>({"line", "plane", "values", "color", kOrientation, "isTarget"});
inline constexpr auto kBoxAttributes =
    std::to_array<std::string_view>({"boxOrigin", "boxSize", "color", kOrientation});
inline constexpr auto kSolidAttributes =
    std::to_array<std::string_view>({"content", "boundingBox", "offset", "color", kOrientation});
inline constexpr auto kTargetFormats =
    std::to_array<std::string_view>({"grid", "csg", "relativeGrid", "surface"});

inline constexpr auto kRootElements = std::to_array<std::string_view>(
    {kRootElement, "parameters", "world", "visuals", "vm", "capabilities", "scenario"});
/// The element of meta modules, several modules each, that a program for VisibleSim expands.
inline constexpr const char* kMetaModules = "MMBlockList";
inline constexpr auto kWorldElements = std::to_array<std::string_view>(
    {"blockList", "targetList", kOwnElement, kObstacleListElement, "camera", "spotlight",
     "customization", "capabilities", "targetGrid", "trash", "scenario", kMetaModules,
     "MMTargetList"});
inline constexpr auto kBlockListElements =
    std::to_array<std::string_view>({"block", "blocksLine", "blockBox", "csg", "mesh"});
inline constexpr auto kTargetListElements = std::to_array<std::string_view>({"target"});
inline constexpr auto kTargetAttributes = std::to_array<std::string_view>({"format"});
inline constexpr auto kObstacleListElements = std::to_array<std::string_view>({kObstacleElement});
inline constexpr auto kOwnElements =
    std::to_array<std::string_view>({"knownAnswer", kExtensionElement});
inline constexpr auto kTargetElements =
    std::to_array<std::string_view>({"cell", "targetLine", "csg", "method"});

/// Attributes of <parameters> that only VisibleSim's own solver has a use for.
inline constexpr auto kSolverParameters =
    std::to_array<std::string_view>({"nofIterations", "preconditioner", "globalBeta", "globalEps",
                                     "globalMu", "globalOmega", "globalI"});

constexpr bool is_solver_parameter(std::string_view name) {
  return std::ranges::find(kSolverParameters, name) != kSolverParameters.end();
}

/// All attributes of <parameters>.
inline const std::vector<std::string_view>& parameter_names() {
  static const std::vector<std::string_view> names = [] {
    std::vector<std::string_view> list(kSolverParameters.begin(), kSolverParameters.end());
    list.emplace_back(kSupportParameter);
    for (const model::MaterialParameter& parameter : model::kMaterialParameters) {
      if (parameter.visiblesim != nullptr) {
        list.emplace_back(parameter.visiblesim);
      }
    }
    return list;
  }();
  return names;
}

/// All attributes of <holdfast>.
inline const std::vector<std::string_view>& own_element_names() {
  static const std::vector<std::string_view> names = [] {
    std::vector<std::string_view> list = {"name",     "description", "robot", "lattice",
                                          "computed", kTargets,      kShift};
    for (const model::MaterialParameter& parameter : model::kMaterialParameters) {
      if (parameter.visiblesim == nullptr) {
        list.emplace_back(parameter.key);
      }
    }
    return list;
  }();
  return names;
}

/// All keys of a material that version 1 has, and with those of version 2.
inline const std::vector<std::string_view>& material_keys(bool is_extended) {
  static const auto list_of = [](bool with_extension) {
    std::vector<std::string_view> list;
    for (const model::MaterialParameter& parameter : model::kMaterialParameters) {
      list.emplace_back(parameter.key);
    }
    if (with_extension) {
      list.insert(list.end(), kConnectorKeys.begin(), kConnectorKeys.end());
      list.push_back(kFootKey);
      list.insert(list.end(), kScatterKeys.begin(), kScatterKeys.end());
    }
    return list;
  };
  static const std::vector<std::string_view> keys = list_of(false);
  static const std::vector<std::string_view> all_keys = list_of(true);
  return is_extended ? all_keys : keys;
}

/// Attributes of <cell>, and those of <block>, that have members of their own in a Document.
constexpr bool is_planned_attribute(std::string_view name) {
  return is_one_of(name, {"position", "color", kOwnKindAttribute, kOwnMassAttribute});
}

constexpr bool is_module_attribute(std::string_view name) {
  return is_planned_attribute(name) || name == "fixed";
}

/// Attributes of <block> that VisibleSim gives a meaning without one for mechanics.
constexpr bool is_simulation_attribute(std::string_view name) {
  return is_one_of(name, {"centroid", "solver", "stabilityCheck", "id", "master", kOrientation,
                          "angle", "rotation"});
}

/// Whether a child of <world> is not scenery.
constexpr bool is_structural_element(std::string_view name) {
  return is_one_of(name, {"blockList", "targetList", kObstacleListElement, kOwnElement});
}

/// Whether a child of <world> may be there without a warning.
constexpr bool is_scenery_element(std::string_view name) {
  return is_one_of(name, {"camera", "spotlight", "customization"});
}

constexpr bool is_known_verdict(std::string_view name) {
  return is_one_of(name, {"safe", "overload", "unstable"});
}

}  // namespace holdfast::io
