// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "connection_law.hpp"

namespace holdfast::verdict {

ConnectionLaw::ConnectionLaw(const model::Material& material, base::Direction direction)
    : width_(material.facet_mm),
      strength_(base::is_vertical(direction) ? material.strength_vertical_n
                                             : material.strength_lateral_n) {
  const auto beam = mechanics::beam_stiffness(model::beam_section(material));
  for (std::size_t k = 0; k < 6; ++k) {
    Vec unit{};
    unit[k] = 1;
    const Vec force = mechanics::middle_force(beam, direction, unit, Vec{});
    const auto take = [&](Term& term, std::size_t row) {
      if (force[row] != 0) {
        term = {.index = k, .factor = force[row]};
      }
    };
    if (k < 3) {
      take(shear_x_, 0);
      take(shear_y_, 1);
      take(axial_, 2);
    } else {
      take(couple_x_, 0);
      take(couple_y_, 1);
      take(bend_x_, 3);
      take(bend_y_, 4);
      take(torsion_, 5);
    }
  }
}

}  // namespace holdfast::verdict
