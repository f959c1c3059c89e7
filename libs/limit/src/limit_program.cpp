// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "limit_program.hpp"

#include <algorithm>
#include <cmath>

#include "wrench.hpp"

namespace holdfast::limit {
namespace {

constexpr double kInfinite = LinearProgram::kInfinite;

/// The largest force on any group; moments count by the structure's length.
double force_unit(const Part& part, double length) {
  double largest = 0;
  for (const base::Vec6<double>& load : part.loads) {
    for (std::size_t i = 0; i < 6; ++i) {
      largest = std::max(largest, std::abs(load[i]) / (i < 3 ? 1 : length));
    }
  }
  return largest > 0 ? largest : 1;
}

bool has_strength(const Joint& joint) { return std::isfinite(joint.law.strength_n); }

bool rubs(const Joint& joint) { return has_strength(joint) && joint.law.friction.has_value(); }

}  // namespace

base::Vec6<double> global_force(const Joint& joint, const base::Vec6<double>& force) {
  base::Vec6<double> global{};
  for (std::size_t i = 0; i < 3; ++i) {
    global[i] =
        force[0] * joint.frame[0][i] + force[1] * joint.frame[1][i] - force[2] * joint.frame[2][i];
    global[i + 3] =
        force[3] * joint.frame[0][i] + force[4] * joint.frame[1][i] + force[5] * joint.frame[2][i];
  }
  return global;
}

LimitProgram::LimitProgram(const Structure& structure, const Part& part, Side side,
                           const std::map<std::size_t, JointDirections>& directions)
    : structure_(structure),
      part_(part),
      side_(side),
      force_n_(force_unit(part, structure.length_mm)) {
  program_.right_side.assign(6 * part.centres.size(), 0.0);
  static const JointDirections kFirst;
  for (const std::size_t index : part.joints) {
    const auto found = directions.find(index);
    add_joint(index, found != directions.end() ? found->second : kFirst);
  }
  for (std::size_t group = 0; group < part.loads.size(); ++group) {
    for (std::size_t i = 0; i < 6; ++i) {
      const double unit = i < 3 ? force_n_ : force_n_ * structure.length_mm;
      program_.add(static_cast<int>(6 * group + i), part.loads[group][i] / unit);
    }
  }
  factor_column_ = program_.end_column(0, part.factor_max, 1);
}

int LimitProgram::add_row(double right_side) {
  program_.right_side.push_back(right_side);
  return program_.row_count() - 1;
}

/// The entries of a force of a joint, in units, in the balances of its two bodies.
void LimitProgram::add_force(const Joint& joint, const Vec& force) {
  const Vec global = global_force(joint, force);
  for (const auto& [body, sign] : {std::pair{joint.a, 1.0}, std::pair{joint.b, -1.0}}) {
    const int group = body == Joint::kGround ? Part::kNone : part_.group[base::at(body)];
    if (group == Part::kNone) {
      continue;
    }
    Vec scaled = global;  // Moments times the length, as the lever is in mm.
    for (std::size_t i = 3; i < 6; ++i) {
      scaled[i] *= structure_.length_mm;
    }
    const Vec at_centre = moved(scaled, joint.place_mm, part_.centres[base::at(group)], sign);
    for (std::size_t i = 0; i < 6; ++i) {
      program_.add(6 * group + static_cast<int>(i),
                   at_centre[i] / (i < 3 ? 1 : structure_.length_mm));
    }
  }
}

void LimitProgram::add_free(const Joint& joint, std::size_t component) {
  add_force(joint, base::unit<double>(static_cast<int>(component)));
  program_.end_column(-kInfinite, kInfinite);
}

void LimitProgram::add_joint(std::size_t index, const JointDirections& directions) {
  const Joint& joint = structure_.joints[index];
  Rows rows;
  const bool carries_across = (joint.carries & kCarriesAcross) != 0;
  if (carries_across && std::isfinite(joint.law.shear_strength_n)) {
    rows.across = add_row(joint.law.shear_strength_n / force_n_);
    program_.add(rows.across, 1);
    program_.end_column(0, kInfinite);
  }
  if (rubs(joint) && *joint.law.friction > 0) {
    rows.friction = add_row(0);
    program_.add(rows.friction, -1);
    program_.end_column(0, kInfinite);
  }
  if ((joint.carries & kCarriesAxial) != 0) {
    add_pushes(index, directions, rows);
  }
  if (carries_across) {
    add_across(index, directions, rows);
  }
  if ((joint.carries & kCarriesTorsion) != 0) {
    add_torsion(index, rows);
  }
}

/// N = strength - pushes; what bends is where these push: N + M / lever <= strength.
void LimitProgram::add_pushes(std::size_t index, const JointDirections& directions,
                              const Rows& rows) {
  const Joint& joint = structure_.joints[index];
  const bool bends = (joint.carries & kCarriesBending) != 0;
  if (!has_strength(joint)) {
    add_free(joint, 2);
    for (std::size_t component = 3; component < 5 && bends; ++component) {
      add_free(joint, component);
    }
    return;
  }
  if (joint.law.strength_n != 0) {
    // As a column, taken back to the right side.
    const std::size_t begin = program_.rows.size();
    add_force(joint, {0, 0, joint.law.strength_n / force_n_, 0, 0, 0});
    for (std::size_t i = begin; i < program_.rows.size(); ++i) {
      program_.right_side[static_cast<std::size_t>(program_.rows[i])] -= program_.values[i];
    }
    program_.rows.resize(begin);
    program_.values.resize(begin);
  }
  const double lever = joint.law.lever_mm / structure_.length_mm;
  const auto push = [&](double x, double y) {
    add_force(joint, {0, 0, -1, lever * x, lever * y, 0});
    if (rows.friction >= 0) {
      program_.add(rows.friction, 1);
    }
    return program_.end_column(0, kInfinite);
  };
  if (!bends) {
    push(0, 0);
  } else if (joint.law.bending == model::BendingLaw::kSquare) {
    for (const double x : {-1.0, 1.0}) {
      for (const double y : {-1.0, 1.0}) {
        push(x, y);
      }
    }
  } else {
    has_cones_ = true;
    for (const Directions::Corner& corner : directions.bending.corners(side_)) {
      const double x = corner.radius * std::cos(corner.angle);
      const double y = corner.radius * std::sin(corner.angle);
      cone_columns_.push_back(
          {.joint = index, .column = push(x, y), .is_bending = true, .x = x, .y = y});
    }
  }
}

/// V within the shear strength, and within friction's share of the pushes.
void LimitProgram::add_across(std::size_t index, const JointDirections& directions,
                              const Rows& rows) {
  const Joint& joint = structure_.joints[index];
  if (rows.across < 0 && !rubs(joint)) {
    add_free(joint, 0);
    add_free(joint, 1);
    return;
  }
  if (rubs(joint) && rows.friction < 0) {
    return;  // As on ice.
  }
  has_cones_ = true;
  for (const Directions::Corner& corner : directions.across.corners(side_)) {
    const double x = corner.radius * std::cos(corner.angle);
    const double y = corner.radius * std::sin(corner.angle);
    add_force(joint, {x, y, 0, 0, 0, 0});
    if (rows.across >= 0) {
      program_.add(rows.across, 1);
    }
    if (rows.friction >= 0) {
      program_.add(rows.friction, -1 / *joint.law.friction);
    }
    cone_columns_.push_back(
        {.joint = index, .column = program_.end_column(0, kInfinite), .x = x, .y = y});
  }
}

void LimitProgram::add_torsion(std::size_t index, const Rows& rows) {
  const Joint& joint = structure_.joints[index];
  const double most = joint.law.torsion_strength_nmm / (force_n_ * structure_.length_mm);
  const Vec twist = base::unit<double>(5);
  if (!rubs(joint) || !std::isfinite(joint.law.torsion_radius_mm)) {
    add_force(joint, twist);
    program_.end_column(-most, most);
    return;
  }
  if (rows.friction < 0) {
    return;
  }
  for (const double sign : {-1.0, 1.0}) {
    add_force(joint, {0, 0, 0, 0, 0, sign});
    program_.add(rows.friction,
                 -structure_.length_mm / (*joint.law.friction * joint.law.torsion_radius_mm));
    program_.end_column(0, most);
  }
}

bool LimitProgram::solve(double seconds_max) {
  solution_ = limit::solve(program_, seconds_max);
  return solution_.is_optimal;
}

double LimitProgram::factor() const {
  return std::clamp(solution_.x[static_cast<std::size_t>(factor_column_)], 0.0, part_.factor_max);
}

std::vector<base::Vec6<double>> LimitProgram::velocities() const {
  double power = 0;
  for (std::size_t group = 0; group < part_.loads.size(); ++group) {
    for (std::size_t i = 0; i < 6; ++i) {
      power += solution_.prices[6 * group + i] * part_.loads[group][i] /
               (i < 3 ? 1 : structure_.length_mm);
    }
  }
  const double sign = power < 0 ? -1 : 1;  // Loads do work.
  std::vector<Vec> velocities(structure_.bodies.size(), Vec{});
  double largest = 0;
  for (std::size_t body = 0; body < velocities.size(); ++body) {
    if (part_.group[body] == Part::kNone) {
      continue;
    }
    const auto group = base::at(part_.group[body]);
    Vec velocity;
    for (std::size_t i = 0; i < 6; ++i) {
      velocity[i] = sign * solution_.prices[6 * group + i] / (i < 3 ? 1 : structure_.length_mm);
    }
    velocities[body] =
        velocity_at(velocity, part_.centres[group], structure_.bodies[body].centre_mm);
    for (std::size_t i = 0; i < 6; ++i) {
      largest =
          std::max(largest, std::abs(velocities[body][i]) * (i < 3 ? 1 : structure_.length_mm));
    }
  }
  constexpr double kNone = 1e-9;  // Of one over the unit of loads: no price but rounding.
  if (largest < kNone) {
    return {};
  }
  for (Vec& velocity : velocities) {
    for (double& component : velocity) {
      component /= largest;
    }
  }
  return velocities;
}

void LimitProgram::refine(std::map<std::size_t, JointDirections>& directions) const {
  struct Resultant {
    double x = 0;
    double y = 0;
  };

  std::map<std::pair<std::size_t, bool>, Resultant> resultants;
  for (const ConeColumn& column : cone_columns_) {
    const double share = solution_.x[static_cast<std::size_t>(column.column)];
    Resultant& sum = resultants[{column.joint, column.is_bending}];
    sum.x += share * column.x;
    sum.y += share * column.y;
  }
  constexpr double kSmall = 1e-7;
  for (const auto& [key, sum] : resultants) {
    if (std::hypot(sum.x, sum.y) > kSmall) {
      JointDirections& joint = directions[key.first];
      (key.second ? joint.bending : joint.across).add(std::atan2(sum.y, sum.x));
    }
  }
}

}  // namespace holdfast::limit
