// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "holdfast/limit/rigid_stability.hpp"

/// The wrenches that contacts can exert on a rigid body, as a convex cone.
///
/// A wrench is the force and the moment about the centre of mass divided by the radius of gyration;
/// a twist the velocity of the centre of mass and the angular velocity times that radius. So their
/// product is a power, and lengths of both are those of the body's mass matrix.
namespace holdfast::limit {

using Eigen::Vector3d;
using Vector6d = Eigen::Matrix<double, 6, 1>;

inline Vector3d vector(const Vector3& values) { return {values[0], values[1], values[2]}; }

/// One corner of a facet.
struct ContactPoint {
  Vector3d place = Vector3d::Zero();  ///< mm, from the centre of mass.
  Vector3d normal = Vector3d::Zero();
  std::array<Vector3d, 2> across;
  std::optional<double> friction;
};

/// All corners of the facets, less those that add nothing: within the hull of others in the same
/// plane with the same friction.
std::vector<ContactPoint> contact_points(std::span<const ContactFacet> facets,
                                         const Vector3d& centre_of_mass);

class ContactCone {
 public:
  ContactCone(const std::vector<ContactPoint>& points, double gyration_mm);

  /// What remains of a load when the contacts do their best: the shortest of load + cone.
  struct Remainder {
    Vector6d wrench;
    /// Whether it separates what can be balanced from what cannot: of the pushes none is opposed to
    /// it by a larger share than it is of the load.
    bool is_settled = true;
  };

  /// Non-negative least squares [Lawson 1974]; of every friction cone, the generators it needs.
  Remainder remainder(const Vector6d& load) const;

  /// Whether what remains of a load is rounding.
  static bool is_nothing(const Vector6d& remainder, const Vector6d& load);

  /// Where a ray of loads leaves what the contacts can balance: at from + distance * along, on the
  /// plane normal . load = 0, with all that can be balanced on its negative side.
  struct Exit {
    double distance = 0;  ///< Infinite if it never does; 0 if it is outside from the start.
    Vector6d normal = Vector6d::Zero();
    bool is_settled = true;
  };

  Exit leave(const Vector6d& from, const Vector6d& along) const;

 private:
  using Reduced = Eigen::VectorXd;

  /// Pushes n + mu (cos a t1 + sin a t2) for every angle a; without friction one push.
  struct Generator {
    Reduced normal;
    std::array<Reduced, 2> across;  ///< Times mu; empty without friction.
  };

  Reduced most_opposed(const Reduced& remainder, double& product) const;

  Eigen::MatrixXd basis_;  ///< Of the wrenches that no-slip forces across do not reach, by columns.
  std::vector<Generator> generators_;
};

}  // namespace holdfast::limit
