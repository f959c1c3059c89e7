// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "program/cone_program.hpp"

#include <algorithm>
#include <cmath>

#include "program/wrench.hpp"

namespace holdfast::limit {
namespace {

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

/// The rows of one joint: what its law says of [fx fy N mx my T], units of force and length.
class JointRows {
 public:
  JointRows(const Joint& joint, double force_n, double length_mm)
      : law_(joint.law), strength_(joint.law.strength_n / force_n), length_(length_mm) {
    const bool carries_axial = (joint.carries & kCarriesAxial) != 0;
    const bool is_on_ice = rubs(joint) && *law_.friction == 0;
    carries_ << across(joint, is_on_ice), across(joint, is_on_ice), carries_axial, bends(joint),
        bends(joint), turns(joint, is_on_ice);
    if (has_strength(joint) && carries_axial) {
      add_opening(bends(joint));
    }
    if (carries_[0] && std::isfinite(law_.shear_strength_n)) {
      add_cone(axis(0) * 0, law_.shear_strength_n / force_n);
    }
    if (carries_[5] && std::isfinite(law_.torsion_strength_nmm)) {
      add_number(axis(5), law_.torsion_strength_nmm / (force_n * length_));
      add_number(-axis(5), law_.torsion_strength_nmm / (force_n * length_));
    }
    if (rubs(joint) && carries_[0]) {
      add_friction();
    }
  }

  /// The rows of G, h and the sizes of the cones.
  std::vector<Eigen::Matrix<double, 1, 6>> G;
  std::vector<double> h;
  std::vector<Eigen::Index> sizes;

  bool carries(Eigen::Index component) const { return carries_[component]; }

 private:
  using Row = Eigen::Matrix<double, 1, 6>;

  static bool across(const Joint& joint, bool is_on_ice) {
    return (joint.carries & kCarriesAcross) != 0 && !is_on_ice;
  }

  static bool bends(const Joint& joint) {
    constexpr int kBoth = kCarriesBending | kCarriesAxial;
    return (joint.carries & kBoth) == kBoth && (!has_strength(joint) || joint.law.lever_mm > 0);
  }

  static bool turns(const Joint& joint, bool is_on_ice) {
    return (joint.carries & kCarriesTorsion) != 0 &&
           !(is_on_ice && std::isfinite(joint.law.torsion_radius_mm));
  }

  static Row axis(Eigen::Index component) { return Row::Unit(6, component); }

  void add_row(const Row& row, double right_side) {
    G.push_back(row);
    h.push_back(right_side);
  }

  void add_number(const Row& row, double right_side) {
    add_row(row, right_side);
    sizes.push_back(1);
  }

  /// (right_side - row f, fx, fy) in a cone.
  void add_cone(const Row& row, double right_side) {
    add_row(row, right_side);
    add_row(-axis(0), 0);
    add_row(-axis(1), 0);
    sizes.push_back(3);
  }

  /// N + M / lever <= strength.
  void add_opening(bool is_bent) {
    const double lever = law_.lever_mm / length_;
    if (!is_bent) {
      add_number(axis(2), strength_);
    } else if (law_.bending == model::BendingLaw::kSquare) {
      for (const Eigen::Index component : {3, 4}) {
        for (const double sign : {-1.0, 1.0}) {
          add_number(axis(2) + sign / lever * axis(component), strength_);
        }
      }
    } else {
      add_row(axis(2), strength_);
      add_row(-axis(3) / lever, 0);
      add_row(-axis(4) / lever, 0);
      sizes.push_back(3);
    }
  }

  /// V <= mu (strength - N) - |T| / r.
  void add_friction() {
    const double mu = *law_.friction;
    if (!carries_[5] || !std::isfinite(law_.torsion_radius_mm)) {
      add_cone(mu * axis(2), mu * strength_);
      return;
    }
    for (const double sign : {-1.0, 1.0}) {
      add_cone(mu * axis(2) + sign * length_ / law_.torsion_radius_mm * axis(5), mu * strength_);
    }
  }

  const model::ConnectorLaw& law_;
  double strength_;
  double length_;
  Eigen::Array<bool, 6, 1> carries_;
};

/// The columns are by component of a joint's force: its wrench about a place, times `sign`.
Block wrenches(const Joint& joint, const JointRows& rows, const Vector3& about, double length,
               double sign) {
  Block result = Block::Zero();
  for (Eigen::Index component = 0; component < 6; ++component) {
    if (!rows.carries(component)) {
      continue;
    }
    base::Vec6<double> force = base::unit<double>(static_cast<int>(component));
    force[static_cast<std::size_t>(component)] = component < 3 ? 1 : length;
    const base::Vec6<double> there = moved(global_force(joint, force), joint.place_mm, about, sign);
    for (Eigen::Index i = 0; i < 6; ++i) {
      result(i, component) = there[static_cast<std::size_t>(i)] / (i < 3 ? 1 : length);
    }
  }
  return result;
}

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

ConeProgram::ConeProgram(const Structure& structure, const Part& part)
    : factor_max(part.factor_max), force_n(force_unit(part, structure.length_mm)) {
  const double length = structure.length_mm;
  const auto group_of = [&](std::int32_t body) {
    return body == Joint::kGround ? Part::kNone : part.group[base::at(body)];
  };
  std::vector<double> right_side;
  for (const std::size_t index : part.joints) {
    const Joint& joint = structure.joints[index];
    const JointRows rows(joint, force_n, length);
    JointPart one = {.a = group_of(joint.a), .b = group_of(joint.b)};
    if (one.a != Part::kNone) {
      one.on_a = wrenches(joint, rows, part.centres[base::at(one.a)], length, 1);
    }
    if (one.b != Part::kNone) {
      one.on_b = wrenches(joint, rows, part.centres[base::at(one.b)], length, -1);
    }
    one.row = static_cast<Eigen::Index>(right_side.size());
    one.cones_begin = cones.size();
    Eigen::Index row = one.row;
    for (const Eigen::Index size : rows.sizes) {
      cones.push_back({.row = row, .size = size});
      row += size;
    }
    one.cones_end = cones.size();
    one.rows.resize(static_cast<Eigen::Index>(rows.G.size()), 6);
    for (std::size_t i = 0; i < rows.G.size(); ++i) {
      one.rows.row(static_cast<Eigen::Index>(i)) = rows.G[i];
    }
    right_side.insert(right_side.end(), rows.h.begin(), rows.h.end());
    joints.push_back(one);
  }
  h = Eigen::Map<const Eigen::VectorXd>(right_side.data(),
                                        static_cast<Eigen::Index>(right_side.size()));
  loads.resize(6 * static_cast<Eigen::Index>(part.loads.size()));
  for (std::size_t group = 0; group < part.loads.size(); ++group) {
    for (std::size_t i = 0; i < 6; ++i) {
      loads[static_cast<Eigen::Index>(6 * group + i)] =
          part.loads[group][i] / (i < 3 ? force_n : force_n * length);
    }
  }
}

}  // namespace holdfast::limit
