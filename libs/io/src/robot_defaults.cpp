// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "robot_defaults.hpp"

#include <algorithm>
#include <cmath>

#include "holdfast/model/robot_catalogue.hpp"
#include "vocabulary.hpp"

namespace holdfast::io {

model::Material first_material(const std::string& robot) {
  const model::CatalogueRobot* const found = model::find_robot(robot);
  return found == nullptr ? model::Material() : model::catalogue_material(*found);
}

model::Material default_material(const Document& document) {
  model::Material material = first_material(document.extension.robot);
  const double pitch = material.pitch_mm;
  material.pitch_mm = document.material.pitch_mm;
  model::fill_section(material);
  material.pitch_mm = pitch;
  return material;
}

base::Lattice default_lattice(const std::string& robot) {
  const model::CatalogueRobot* const found = model::find_robot(robot);
  return found == nullptr ? base::kCubic : found->lattice;
}

Connectors robot_connectors(const std::string& robot) {
  Connectors connectors;
  if (const model::CatalogueRobot* const found = model::find_robot(robot)) {
    for (const model::RobotFigure& figure : found->figures) {
      const bool is_one = std::ranges::find(kConnectorKeys, figure.key) != kConnectorKeys.end();
      if (is_one && figure.value) {
        connectors.parameters.push_back({std::string(figure.key), Spread::kAll, {figure.value}});
      }
    }
  }
  return connectors;
}

std::vector<std::string> missing_keys(const model::Material& material) {
  std::vector<std::string> keys;
  for (double model::Material::*const required : model::kRobotParameters) {
    if (std::isnan(material.*required)) {
      keys.emplace_back(
          std::ranges::find(model::kMaterialParameters, required, &model::MaterialParameter::value)
              ->key);
    }
  }
  return keys;
}

}  // namespace holdfast::io
