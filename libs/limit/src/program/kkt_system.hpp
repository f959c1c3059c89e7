// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <vector>

#include "holdfast/solver/block_lu.hpp"
#include "program/cone.hpp"
#include "program/cone_program.hpp"

namespace holdfast::limit {

/// Forces and factor, velocities of groups, prices of the cones' rows.
struct KktVector {
  Eigen::VectorXd x;  ///< Six per joint, then the factor.
  Eigen::VectorXd y;  ///< Six per group.
  Eigen::VectorXd z;  ///< By row, then of the factor's bound.
};

/// The linear systems of the interior-point method,
///   [0 A' G'; A 0 0; G 0 -W^2] (x, y, z) = right side,
/// and what it does with vectors by cone. The prices are eliminated, then each joint's forces by
/// themselves; what is left is a matrix of 6x6 blocks, one per group and one per joint, bordered by
/// the loads: the stiffness of a frame of which each joint's compliance is G' W^-2 G.
class KktSystem {
 public:
  /// `softness` is the compliance that directions without limit are given, in units of the program;
  /// the refinement takes it back.
  KktSystem(const ConeProgram& program, double softness, int thread_count);

  Eigen::Index force_count() const { return 6 * joint_count() + 1; }

  std::size_t cone_count() const { return cones_.size(); }

  const Eigen::VectorXd& right_side() const { return h_; }  ///< h

  const Eigen::VectorXd& centre() const { return centre_; }

  Eigen::VectorXd balance(const Eigen::VectorXd& x) const;     ///< A x
  Eigen::VectorXd rows_times(const Eigen::VectorXd& x) const;  ///< G x
  Eigen::VectorXd transposed_times(const Eigen::VectorXd& y,
                                   const Eigen::VectorXd& z) const;  ///< A'y + G'z

  /// Factors the matrix for the scaling of s and z. False: rounding has left the cones, or the
  /// stiffness is singular.
  bool factor(const Eigen::VectorXd& s, const Eigen::VectorXd& z);
  KktVector solve(const KktVector& right_side);

  // By cone:
  Eigen::VectorXd scaled(const Eigen::VectorXd& u) const;          ///< W u
  Eigen::VectorXd inverse_scaled(const Eigen::VectorXd& u) const;  ///< W^-1 u
  Eigen::VectorXd product(const Eigen::VectorXd& u, const Eigen::VectorXd& v) const;
  /// What times lambda = W z is v, in the cones' Jordan algebra.
  Eigen::VectorXd quotient(const Eigen::VectorXd& v) const;
  double step(const Eigen::VectorXd& u, const Eigen::VectorXd& d, double most) const;
  /// How far outside its cone u is, and u's first component: by cone.
  Eigen::VectorXd outside(const Eigen::VectorXd& u) const;
  Eigen::VectorXd heads(const Eigen::VectorXd& u) const;

 private:
  Eigen::Index joint_count() const { return static_cast<Eigen::Index>(program_.joints.size()); }

  void make_compliances();
  bool factor_stiffness();
  void solve_stiffness(Eigen::VectorXd& x);
  void improve(KktVector& solution, const KktVector& rest);

  const ConeProgram& program_;
  double softness_;
  std::vector<ConeProgram::Cone> cones_;
  Eigen::VectorXd h_;
  Eigen::VectorXd centre_;
  std::vector<std::size_t> edge_of_joint_;
  std::vector<solver::Edge> edges_;
  solver::BlockLu stiffness_;
  int thread_count_;
  std::vector<Scaling> scalings_;  ///< By cone.
  Eigen::VectorXd lambda_;
  std::vector<Block> roots_;  ///< By joint: its compliance is inverse to root' root.
  Eigen::VectorXd loads_solved_;
  double border_ = 0;
};

/// Products of two blocks that factoring a program's matrix takes.
double factor_work(const ConeProgram& program);

}  // namespace holdfast::limit
