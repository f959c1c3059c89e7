// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include "holdfast/mechanics/beam.hpp"

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

/// The section of every beam, with Jv from J and nu.
mechanics::BeamSection<double> beam_section(const Material& material);

/// Weight of one module in N.
double module_weight_n(const Material& material);

/// The most by which an error e of the displacements can change any load ratio, as a share of its
/// energy norm (e . K e)^(1/2); in (N mm)^(-1/2). See mechanics::load_ratio_squared_per_energy().
double load_ratio_per_energy_norm(const Material& material);

/// Why a material cannot be computed with (name, value found, values allowed), if it cannot.
std::optional<std::string> find_material_fault(const Material& material);

}  // namespace holdfast::model
