// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>

#include "holdfast/base/lattice.hpp"
#include "holdfast/mechanics/beam.hpp"
#include "holdfast/mechanics/connector.hpp"

namespace holdfast::model {

/// Everything that a structure's mechanics depend on besides its cells. The defaults are Table I
/// of [Piranda 2021], Blinky Blocks; every number is independent of the others.
struct Material {
  double elastic_modulus_mpa = 100;                       ///< E, arbitrary in the paper
  double pitch_mm = 40;                                   ///< L, from centre to centre
  double facet_mm = 40;                                   ///< a, width of a face
  double section_area_mm2 = 40.0 * 40.0;                  ///< A
  double moment_x_mm4 = 40.0 * 40.0 * 40.0 * 40.0 / 12;   ///< Ix, lateral beams: vertical plane
  double moment_y_mm4 = 40.0 * 40.0 * 40.0 * 40.0 / 12;   ///< Iy
  double torsion_mm4 = 2.25 * 20.0 * 20.0 * 20.0 * 20.0;  ///< J; Jv = J / (2 (1 + nu))
  double poisson_ratio = 0.3;                             ///< nu
  double mass_kg = 0.06106;                               ///< M, of one module
  double gravity_m_s2 = 9.81;
  double strength_vertical_n = 11.98;  ///< Fmax of top-bottom connections
  double strength_lateral_n = 14.97;   ///< Fmax of side connections
  double contact_gamma = 1e-4;         ///< gamma of Eqs. (10)-(12)

  friend bool operator==(const Material&, const Material&) = default;
};

/// The facts of one number of a material that files, forms and messages have to know.
struct MaterialParameter {
  std::string_view key;    ///< In holdfast JSON, with the unit.
  const char* visiblesim;  ///< Attribute of VisibleSim's <parameters>; nullptr: it has no word.
  double Material::*value;
  const char* label;  ///< For people.
  const char* unit;   ///< For people; empty for a ratio.
  double lowest = 1e-12;
  /// Products of parameters leave the range of double, or lose all their digits, beyond these two.
  double highest = 1e12;
};

/// Second moments of area of sections 10 m wide, and more.
inline constexpr double kMomentMax = 1e16;

/// The parameters in the order in which programs and documents list them. All that reads, writes,
/// checks or shows a material goes through this table. VisibleSim counts its moments the other way
/// round: its Iy bends lateral beams in the vertical plane, which is our Ix.
inline constexpr auto kMaterialParameters = std::to_array<MaterialParameter>({
    {"elastic_modulus_mpa", "E", &Material::elastic_modulus_mpa, "Elastic modulus E", "MPa"},
    {"pitch_mm", "globalL", &Material::pitch_mm, "Pitch L", "mm"},
    {"facet_mm", "a", &Material::facet_mm, "Width of a face a", "mm"},
    {"section_area_mm2", "A", &Material::section_area_mm2, "Section A", "mm²"},
    {"moment_x_mm4", "globalIy", &Material::moment_x_mm4, "Moment Ix", "mm⁴", 1e-12, kMomentMax},
    {"moment_y_mm4", "globalIz", &Material::moment_y_mm4, "Moment Iy", "mm⁴", 1e-12, kMomentMax},
    {"torsion_mm4", "globalJ", &Material::torsion_mm4, "Torsion J", "mm⁴", 1e-12, kMomentMax},
    {"poisson_ratio", "globalNu", &Material::poisson_ratio, "Poisson’s ratio", "", -0.99, 0.5},
    {"mass_kg", "globalMass", &Material::mass_kg, "Mass of a module", "kg"},
    {"gravity_m_s2", nullptr, &Material::gravity_m_s2, "Gravity", "m/s²"},
    {"strength_vertical_n", nullptr, &Material::strength_vertical_n, "Strength, vertical", "N"},
    {"strength_lateral_n", nullptr, &Material::strength_lateral_n, "Strength, lateral", "N"},
    {"contact_gamma", "globalGamma", &Material::contact_gamma, "Contact gamma", "", 1e-9, 0.1},
});

static_assert(sizeof(Material) == kMaterialParameters.size() * sizeof(double),
              "every number of a material has a row");

/// The parameter of this key; null if a material has none.
constexpr const MaterialParameter* find_parameter(std::string_view key) {
  for (const MaterialParameter& parameter : kMaterialParameters) {
    if (parameter.key == key) {
      return &parameter;
    }
  }
  return nullptr;
}

/// The section of every beam, with Jv from J and nu.
mechanics::BeamSection<double> beam_section(const Material& material);

/// Weight of one module in N.
double module_weight_n(const Material& material);

/// The connector between two modules of this material, by the class of their direction: Eq. (17)
/// with the width of a face and the strength of that class.
mechanics::Connector<double> connector(const Material& material, base::ConnectorClass kind);

/// Says why a parameter cannot have this value, if it cannot.
std::optional<std::string> find_fault(const MaterialParameter& parameter, double value);

/// Says why a material cannot be computed with (name, value found, values allowed), if it cannot.
std::optional<std::string> find_material_fault(const Material& material);

}  // namespace holdfast::model
