// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "holdfast/agent/algebra/branch.hpp"
#include "holdfast/base/algebra.hpp"

/// Rigid clusters: one module's part in the exact solve on a tree of clusters.
///
/// A cluster is a set of near modules that moves as one rigid body. In a tree of modules whose
/// clusters are subtrees, the module of a cluster nearest to the root is its top. All beams between
/// a cluster and its parent cluster together are a joint, and so this is the elimination of
/// branch.hpp with other joints: within a cluster nothing gives,
///   S' = T^t S T                 h' = T^t h          u = T u_p
/// and at a top the joint does, with F its flexibility there:
///   S' = T^t (1 + S F)^-1 S T    h' = T^t (1 + S F)^-1 h    u = (1 + F S)^-1 (T u_p + F h)
/// S is what the ground does to everything from here down, h the forces on it, T the motion of the
/// parent seen here. A cluster with a fixed module stands still: S = infinity.
///
/// Rigid clusters are stiffer than what they stand for, as all that gives are the beams between
/// them: a row of n beams has become one. So a joint is made kReach times as flexible.
namespace holdfast::agent {

class Cluster {
 public:
  /// How many beams in a row one beam of a joint stands for. Clusters are 8 modules long where they
  /// are whole; of 2 to 8 all from 4 on are nearly as good.
  static constexpr double kReach = 6;

  /// A symmetric matrix in vectors, as Branch has it.
  using Parts = std::array<base::Vec6<float>, Branch::kPartCount>;

  // ---- The joint to the parent's cluster, once the clusters are known.

  /// A beam to the parent's cluster.
  void add_to_joint(const base::Mat6<double>& block);

  /// What a child in the same cluster has found.
  void add_to_joint(int part, const base::Vec6<float>& vector);

  /// The joint as the parent sees it, which is in the same cluster.
  void find_joint_up(const Joint& to_parent, Parts& parts) const;

  /// Called at the top, when all are added up.
  void close_joint();

  // ---- Stiffness and load, for every solve anew.

  void clear();

  /// The cluster stands still.
  void hold() { is_held_ = true; }

  bool is_held() const { return is_held_; }

  void add_stiffness(const base::Mat6<double>& block);
  void add_stiffness(int part, const base::Vec6<float>& vector);

  void add_load(const base::Vec6<double>& load) { base::add_to(load_, load); }

  /// Does the ground touch anything from here down?
  bool is_free() const;

  /// S', if not free; not for members of a held cluster but its top.
  void find_stiffness_up(const Joint& to_parent, bool is_top, Parts& parts) const;

  /// h'
  void find_load_up(const Joint& to_parent, bool is_top, base::Vec6<double>& load) const;

  /// The displacement instead of the parent's.
  void find_displacement(const Joint& to_parent, bool is_top, base::Vec6<double>& u) const;

  /// The motion of the root's cluster; zero if nothing holds the robot.
  void find_displacement_of_root(base::Vec6<double>& u) const;

 private:
  base::Mat6<float> stiffness_{};  // S
  base::Mat6<float> joint_{};      // F, while it is added up its inverse.
  base::Vec6<double> load_{};      // h
  bool is_held_ = false;
};

/// T^t S T: what holds a module, seen from the other end of the joint if nothing gives.
base::Mat6<double> carried(const Joint& joint, const base::Mat6<double>& stiffness);

}  // namespace holdfast::agent
