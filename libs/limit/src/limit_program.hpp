// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <map>
#include <span>
#include <vector>

#include "directions.hpp"
#include "holdfast/limit/limit_load.hpp"
#include "linear_program.hpp"

namespace holdfast::limit {

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

/// The directions in which the cones of one joint are cut.
struct JointDirections {
  Directions across;
  Directions bending;
};

/// The linear program of a part. Its variables are the shares of forces that span what a joint
/// holds: pushes at the corners of a facet against the pull of its full strength, and so on.
class LimitProgram {
 public:
  /// `directions` by joint of the structure, as far as they are not the first eight.
  LimitProgram(const Structure& structure, const Part& part, Side side,
               const std::map<std::size_t, JointDirections>& directions);

  bool has_cones() const { return has_cones_; }

  int row_count() const { return program_.row_count(); }

  /// False: no solution.
  bool solve(double seconds_max);

  double factor() const;

  /// Of every body that is not left out, from the prices of its balance; the largest is 1 mm. Empty
  /// if there is none.
  std::vector<base::Vec6<double>> velocities() const;

  /// Adds the directions of the solution's forces across and bending moments.
  void refine(std::map<std::size_t, JointDirections>& directions) const;

 private:
  using Vec = base::Vec6<double>;

  struct Rows {
    int across = -1;    ///< Forces across within the shear strength.
    int friction = -1;  ///< Forces across within what the pushes allow.
  };

  /// A column whose share is a force across or a bending moment in some direction.
  struct ConeColumn {
    std::size_t joint = 0;
    int column = 0;
    bool is_bending = false;
    double x = 0;
    double y = 0;
  };

  void add_joint(std::size_t index, const JointDirections& directions);
  void add_pushes(std::size_t index, const JointDirections& directions, const Rows& rows);
  void add_across(std::size_t index, const JointDirections& directions, const Rows& rows);
  void add_torsion(std::size_t index, const Rows& rows);
  void add_force(const Joint& joint, const Vec& force);
  void add_free(const Joint& joint, std::size_t component);
  int add_row(double right_side);

  const Structure& structure_;
  const Part& part_;
  Side side_;
  double force_n_ = 1;  ///< The unit of forces.
  bool has_cones_ = false;
  int factor_column_ = 0;
  std::vector<ConeColumn> cone_columns_;
  LinearProgram program_;
  LinearSolution solution_;
};

/// The force on body `a` of a joint, local frame, as force and moment at its place in the global
/// frame.
base::Vec6<double> global_force(const Joint& joint, const base::Vec6<double>& force);

}  // namespace holdfast::limit
