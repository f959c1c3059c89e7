// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "connection_law.hpp"

#include "holdfast/base/double_double.hpp"

namespace holdfast::verdict {

ConnectionLaw::ConnectionLaw(const model::Material& material, base::Direction direction)
    : connector_(model::connector(material, base::connector_class(base::kCubic, direction))) {
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

base::Vec6<double> relative_motion(const model::Robot& robot, const model::Connection& pair,
                                   const std::vector<base::Vec6<double>>& high,
                                   const std::vector<base::Vec6<double>>& low) {
  base::Vec6<base::DoubleDouble> motion;
  base::Vec6<base::DoubleDouble> second;
  const auto a = static_cast<std::size_t>(pair.a);
  const auto b = static_cast<std::size_t>(pair.b);
  for (std::size_t k = 0; k < 6; ++k) {
    second[k] = {high[b][k], low[b][k]};
    motion[k] = base::DoubleDouble(high[a][k], low[a][k]) - second[k];
  }
  // The second turns about itself, and takes the first along on a lever of one pitch backwards.
  const std::size_t along = static_cast<std::size_t>(base::index(pair.direction)) / 2;
  const std::size_t next = (along + 1) % 3;
  const std::size_t last = (along + 2) % 3;
  const base::DoubleDouble pitch = robot.material().pitch_mm;
  motion[next] += pitch * second[3 + last];
  motion[last] -= pitch * second[3 + next];
  return base::converted<double>(motion);
}

}  // namespace holdfast::verdict
