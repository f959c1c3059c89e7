// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Dense>
#include <vector>

#include "holdfast/fall/fall.hpp"
#include "node_grid.hpp"

namespace holdfast::fall {

inline Eigen::Vector3d vector_of(const Point& point) { return {point[0], point[1], point[2]}; }

/// A body with its pose and its momentum.
class MovingBody {
 public:
  /// Modules have the inertia of cubes about their own centres, m a^2 / 6.
  MovingBody(const Body& body, const Scene& scene);

  /// Whether it has begun to move.
  bool is_moving() const { return is_moving_; }

  void begin_after(double seconds) { is_moving_ = seconds >= begin_s_; }

  /// Nodes from the centre of mass, in the body's frame.
  const NodeGrid& grid() const { return grid_; }

  /// Nodes with fewer neighbours than the enclosed ones have; others meet nothing.
  const std::vector<Eigen::Vector3d>& outer_nodes() const { return outer_; }

  /// The corners of modules, or centres of balls, with which it can lie on a plane.
  const std::vector<Eigen::Vector3d>& feet() const { return feet_; }

  double radius_mm() const { return radius_mm_; }

  const Eigen::Vector3d& centre() const { return centre_; }

  const Eigen::Vector3d& centre_at_rest() const { return centre_at_rest_; }

  const Eigen::Matrix3d& rotation() const { return rotation_; }

  Eigen::Vector3d global(const Eigen::Vector3d& own) const { return centre_ + rotation_ * own; }

  Eigen::Vector3d own(const Eigen::Vector3d& global) const {
    return rotation_.transpose() * (global - centre_);
  }

  Pose pose() const;

  Eigen::Vector3d velocity_at(const Eigen::Vector3d& point) const {
    return velocity_ + angular_.cross(point - centre_);
  }

  /// The largest speed of any of its points.
  double speed_max() const { return velocity_.norm() + angular_.norm() * radius_mm_; }

  /// Energy of motion, less what gravity has given, kg mm^2/s^2.
  double energy(const Eigen::Vector3d& gravity_mm_s2) const;

  /// 1 / mass, and the inverse of the inertia in the global frame; zero while it does not move.
  double inverse_mass() const { return is_moving_ ? 1 / mass_ : 0; }

  Eigen::Matrix3d inverse_inertia() const;

  /// Adds what weight and the other loads give within a step.
  void load(const Eigen::Vector3d& gravity_mm_s2, double seconds);

  void push(const Eigen::Vector3d& point, const Eigen::Vector3d& impulse);

  void shift(const Eigen::Vector3d& way) { centre_ += way; }

  /// Moves on with the velocities that it has; its angular momentum stays.
  void advance(double seconds);

 private:
  /// Turns it on by a small angle about the axis of a vector, rad.
  void turn_by(const Eigen::Vector3d& angle);

  Eigen::Vector3d centre_at_rest_;
  Eigen::Vector3d centre_;
  NodeGrid grid_;
  std::vector<Eigen::Vector3d> outer_;
  std::vector<Eigen::Vector3d> feet_;
  std::vector<Push> pushes_;
  double begin_s_;
  bool is_moving_ = false;
  double mass_ = 0;
  double radius_mm_ = 0;
  Eigen::Matrix3d inertia_ = Eigen::Matrix3d::Zero();  ///< In its own frame.
  Eigen::Matrix3d inverse_ = Eigen::Matrix3d::Zero();  ///< In its own frame.
  Eigen::Matrix3d turned_inverse_ = Eigen::Matrix3d::Zero();
  Eigen::Quaterniond turn_ = Eigen::Quaterniond::Identity();
  Eigen::Matrix3d rotation_ = Eigen::Matrix3d::Identity();
  Eigen::Vector3d velocity_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d angular_ = Eigen::Vector3d::Zero();
};

}  // namespace holdfast::fall
