// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "holdfast/model/material.hpp"

#include <fmt/format.h>

#include <cmath>

namespace holdfast::model {
namespace {

/// Beyond these, products of parameters leave the range of double or lose all their digits.
constexpr double kParameterMin = 1e-12;
constexpr double kParameterMax = 1e12;

struct Range {
  const char* name;
  double value;
  double lowest;
  double highest;
};

}  // namespace

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

double load_ratio_per_energy_norm(const Material& material) {
  const auto weakest = mechanics::weaker(connector(material, base::ConnectorClass::kVertical),
                                         connector(material, base::ConnectorClass::kLateral));
  return std::sqrt(mechanics::load_ratio_squared_per_energy(
      mechanics::beam_stiffness(beam_section(material)), weakest.width, weakest.strength));
}

std::optional<std::string> find_material_fault(const Material& material) {
  const auto positive = [](const char* name, double value) {
    return Range{name, value, kParameterMin, kParameterMax};
  };
  const Range ranges[] = {positive("elastic_modulus_mpa", material.elastic_modulus_mpa),
                          positive("pitch_mm", material.pitch_mm),
                          positive("facet_mm", material.facet_mm),
                          positive("section_area_mm2", material.section_area_mm2),
                          positive("moment_x_mm4", material.moment_x_mm4),
                          positive("moment_y_mm4", material.moment_y_mm4),
                          positive("torsion_mm4", material.torsion_mm4),
                          {"poisson_ratio", material.poisson_ratio, -0.99, 0.5},
                          positive("mass_kg", material.mass_kg),
                          positive("gravity_m_s2", material.gravity_m_s2),
                          positive("strength_vertical_n", material.strength_vertical_n),
                          positive("strength_lateral_n", material.strength_lateral_n),
                          {"contact_gamma", material.contact_gamma, 1e-9, 0.1}};
  for (const Range& range : ranges) {
    if (!(range.value >= range.lowest && range.value <= range.highest)) {
      return fmt::format("{} is {}, allowed is {} to {}", range.name, range.value, range.lowest,
                         range.highest);
    }
  }
  return std::nullopt;
}

}  // namespace holdfast::model
