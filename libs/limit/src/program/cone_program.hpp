// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "holdfast/limit/limit_load.hpp"
#include "program/cone.hpp"

namespace holdfast::limit {

using Block = Eigen::Matrix<double, 6, 6>;

/// What of a structure a program is about: bodies in groups that move as one, the joints whose
/// forces are unknown, and what grows with the factor on each group.
struct Part {
  static constexpr int kNone = -1;  ///< The ground, or a body that is left out.

  std::vector<int> group;                 ///< By body.
  std::vector<Vector3> centres;           ///< By group, mm: what moments are about.
  std::vector<base::Vec6<double>> loads;  ///< By group.
  std::vector<std::size_t> joints;
  double factor_max = kFactorMax;
};

/// All bodies, all joints.
Part whole(const Structure& structure);

/// Joints that are not free keep their known forces times the factor, which so is within reach: a
/// lower bound. Bodies without free joints are left out.
Part with_known_forces(const Structure& structure, const std::vector<char>& is_free,
                       std::span<const base::Vec6<double>> known_forces);

/// Joints that are not free hold whatever comes, so bodies move as one with their neighbours: an
/// upper bound.
Part with_rigid_groups(const Structure& structure, const std::vector<char>& is_free);

/// The force on body `a` of a joint, local frame, as force and moment at its place in the global
/// frame.
base::Vec6<double> global_force(const Joint& joint, const base::Vec6<double>& force);

/// The program of a part, in units of `force_n` and the structure's length:
///   maximise lambda   so that   A f + lambda a = 0,   h - G f in the cones,   lambda <= most.
/// f are the forces of all joints, six each, A their wrenches on the groups, a the loads.
struct ConeProgram {
  struct Cone {
    Eigen::Index row = 0;
    Eigen::Index size = 1;
  };

  /// What a joint holds: up to 15 rows of G, of its own six forces.
  using Rows = Eigen::Matrix<double, Eigen::Dynamic, 6, 0, 15, 6>;

  struct JointPart {
    int a = Part::kNone;  ///< Groups.
    int b = Part::kNone;
    Block on_a = Block::Zero();
    Block on_b = Block::Zero();
    Rows rows = {};
    Eigen::Index row = 0;  ///< The first of them.
    std::size_t cones_begin = 0;
    std::size_t cones_end = 0;
  };

  ConeProgram(const Structure& structure, const Part& part);

  std::vector<JointPart> joints;
  std::vector<Cone> cones;
  Eigen::VectorXd loads;
  Eigen::VectorXd h;
  double factor_max = kFactorMax;
  double force_n = 1;
};

}  // namespace holdfast::limit
