// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "holdfast/verdict/connection_law.hpp"

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

ConnectionLaws::ConnectionLaws(const model::Robot& robot)
    : robot_(robot),
      is_plain_(robot.lattice() == base::kCubic && robot.has_default_connectors()),
      beam_(model::beam_section(robot.material()), robot.lattice()) {
  if (is_plain_) {
    for (const auto direction :
         {base::Direction::kPlusX, base::Direction::kPlusY, base::Direction::kPlusZ}) {
      plain_.emplace_back(robot.material(), direction);
    }
  }
  for (const base::Direction direction : base::directions(robot.lattice())) {
    auto step = base::heading<base::DoubleDouble>(robot.lattice(), direction);
    for (base::DoubleDouble& part : step) {
      part = part * base::DoubleDouble(base::step_length(robot.lattice(), direction));
    }
    steps_.push_back(step);
  }
}

ConnectionResult ConnectionLaws::general_result(const model::Connection& pair, const Vec& p,
                                                const Vec& q) const {
  const model::ConnectorLaw& law = robot_.connector(pair);
  const auto force = model::connection_force(law, beam_.middle_force(pair.direction, p, q));
  return {.load_ratio = model::load_ratio(law, force).ratio,
          .axial_n = force.axial_n,
          .bending_nmm = force.bending_nmm,
          .shear_n = force.shear_n,
          .torsion_nmm = force.torsion_nmm};
}

double ConnectionLaws::gap_mm(const model::Connection& pair, const Vecs& high,
                              const Vecs& low) const {
  const Vec force =
      low.empty()
          ? beam_.middle_force(pair.direction, high[base::at(pair.a)], high[base::at(pair.b)])
          : beam_.middle_force(pair.direction, relative_motion(pair, high, low), Vec{});
  return mechanics::gap_mm(robot_.connector(pair), beam_.stiffness(pair.direction), force,
                           [](double x, double y) { return std::hypot(x, y); });
}

base::Vec6<double> ConnectionLaws::relative_motion(const model::Connection& pair, const Vecs& high,
                                                   const Vecs& low) const {
  base::Vec6<base::DoubleDouble> motion;
  base::Vec6<base::DoubleDouble> second;
  const std::size_t a = base::at(pair.a);
  const std::size_t b = base::at(pair.b);
  for (std::size_t k = 0; k < 6; ++k) {
    second[k] = {high[b][k], low[b][k]};
    motion[k] = base::DoubleDouble(high[a][k], low[a][k]) - second[k];
  }
  // The second turns about itself, and takes the first along on a lever of the beam's length
  // backwards.
  const auto& step = steps_[static_cast<std::size_t>(base::index(pair.direction))];
  const base::DoubleDouble pitch = robot_.material().pitch_mm;
  for (std::size_t k = 0; k < 3; ++k) {
    const std::size_t next = (k + 1) % 3;
    const std::size_t last = (k + 2) % 3;
    motion[k] += pitch * (second[3 + next] * step[last] - second[3 + last] * step[next]);
  }
  return base::converted<double>(motion);
}

}  // namespace holdfast::verdict
