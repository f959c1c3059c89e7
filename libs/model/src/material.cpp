// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "holdfast/model/material.hpp"

#include <fmt/format.h>

#include <cmath>

namespace holdfast::model {
mechanics::BeamSection<double> beam_section(const Material& material) {
  return {.elastic_modulus = material.elastic_modulus_mpa,
          .length = material.pitch_mm,
          .area = material.section_area_mm2,
          .moment_x = material.moment_x_mm4,
          .moment_y = material.moment_y_mm4,
          .torsion = material.torsion_mm4 / (2 * (1 + material.poisson_ratio))};
}

double module_weight_n(const Material& material) {
  return material.mass_kg * material.gravity_m_s2;
}

mechanics::Connector<double> connector(const Material& material, base::ConnectorClass kind) {
  return {.width = material.facet_mm,
          .strength = kind == base::ConnectorClass::kVertical ? material.strength_vertical_n
                                                              : material.strength_lateral_n};
}

std::optional<std::string> find_fault(const MaterialParameter& parameter, double value) {
  if (value >= parameter.lowest && value <= parameter.highest) {
    return std::nullopt;
  }
  const bool is_upwards = parameter.value == &Material::gravity_m_s2 && value < 0;
  return fmt::format("{} is {}, expected {} to {}{}", parameter.key, value, parameter.lowest,
                     parameter.highest,
                     is_upwards ? "; here it is a size, downwards; a vector such as [0, 0, -9.81] "
                                  "is a key of its own in version 2"
                                : "");
}

std::optional<std::string> find_material_fault(const Material& material) {
  for (const MaterialParameter& parameter : kMaterialParameters) {
    if (auto fault = find_fault(parameter, material.*parameter.value)) {
      return fault;
    }
  }
  return std::nullopt;
}

}  // namespace holdfast::model
