// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "holdfast/base/algebra.hpp"
#include "holdfast/mechanics/beam.hpp"
#include "holdfast/mechanics/lattice_beam.hpp"

/// A connection at large displacements and rotations: the beam of beam.hpp, carried over to frames.
///
/// Each module is a frame: centre x and rotation R, at rest R = 1. All below is in the local frame
/// (x', y', z') of the connection, fixed in the body of p; at rest the vector from p to q is
/// (0, 0, -L). From the relative motion of the two frames, the logarithm in SE(3):
///   a   = R_p^T (x_q - x_p)        psi = log(R_p^T R_q)       t = |psi|
///   rho = V(psi)^-1 a = a - psi x a / 2 + c psi x (psi x a)   c = (1 - (t/2) cot(t/2)) / t^2
/// come six strains, in the order and with the signs of a force in the middle (Eq. 16):
///   e = [-rho_x, -rho_y, -rho_z - L + 3 (rho_x^2 + rho_y^2) / (5 L), -psi_x, -psi_y, -psi_z]
/// and with linear stresses s = k e, k = (sx, sy, a, by/4, bx/4, w) of BeamStiffness, the energy
/// 1/2 sum k e^2. Its second derivative at rest is the 12 x 12 matrix of Eqs. (1)-(2). Bending
/// alone is an arc of a circle, exactly; nothing depends on which end is p, nor on rigid motions.
/// The term 3/5 makes the stiffness that an axial force adds that of Hermite's cubics
/// [Przemieniecki 1968], so that columns buckle as they should with few beams.
///
/// Virtual rotations are spatial spins: R becomes exp(w) R. The gradient of the energy, with
/// g = de/drho^T s, h = de/dpsi^T s and E = drho/dpsi:
///   F_q = R_p V^-T g     M_q = R_p V^-T (h + E^T g)
///   F_p = -F_q           M_p = -M_q - (x_q - x_p) x F_q
///
/// No trigonometric function of a library is called: logarithm and exponential are series of
/// rational functions and square roots, so that all machines have the same bits.
namespace holdfast::mechanics {

/// A vector of three: mm, rad, N or N mm.
using Vector3 = std::array<double, 3>;

/// Where a module is: its displacement (mm, global frame) and its rotation from rest as a unit
/// quaternion [w, x, y, z].
struct Pose {
  Vector3 displacement{};
  std::array<double, 4> rotation = {1, 0, 0, 0};

  friend bool operator==(const Pose&, const Pose&) = default;
};

/// The pose after a step [ux uy uz wx wy wz]: displaced further, and turned by the rotation vector
/// w (global frame, at most pi long) after the rotation that it has.
Pose moved(const Pose& pose, const base::Vec6<double>& step);

/// A vector fixed in the body of a module, global frame, after its rotation.
Vector3 rotated(const std::array<double, 4>& rotation, const Vector3& vector);

/// The rotation vector of a rotation, of length 0 to pi, global frame.
Vector3 rotation_vector(const std::array<double, 4>& rotation);

/// The strains of a connection, and what its forces and tangents are made from.
struct BeamDeformation {
  base::Vec6<double> strain{};  ///< e, in the order of a force in the middle: mm and rad.
  Vector3 offset{};             ///< a, local frame.
  Vector3 turn{};               ///< psi, local frame.
  Vector3 half_turn{};          ///< tan(t/4) psi / t
  Vector3 rho{};
  std::array<Vector3, 3> axes{};  ///< x', y', z' turned with p, global frame.
};

/// Forces and moments on the two ends of a connection, [fx fy fz mx my mz], global frame: what the
/// beam takes from the modules, as mechanics::end_force().
struct EndForces {
  base::Vec6<double> p{};
  base::Vec6<double> q{};
};

/// The derivative of EndForces by steps of the two ends (see moved()), global frame.
struct EndTangent {
  base::Mat6<double> pp{};
  base::Mat6<double> pq{};
  base::Mat6<double> qp{};
  base::Mat6<double> qq{};
};

/// One beam from p to its neighbour q, in a direction of any lattice. Forces follow from stresses
/// s, one for each strain; of a connection they are k e, of a facet what its law says.
class LargeBeam {
 public:
  LargeBeam() = default;

  LargeBeam(const BeamStiffness<double>& beam, double length, const Rotation<double>& axes);

  /// k, by strain.
  const base::Vec6<double>& stiffness() const { return stiffness_; }

  double length() const { return length_; }

  const Rotation<double>& axes() const { return axes_; }

  BeamDeformation deformation(const Pose& p, const Pose& q) const;

  /// k e.
  base::Vec6<double> stress(const BeamDeformation& beam) const;

  /// 1/2 sum k e^2, N mm.
  double energy(const BeamDeformation& beam) const;

  /// The gradient of the energy whose derivatives by the strains are the stresses.
  EndForces end_forces(const BeamDeformation& beam, const base::Vec6<double>& stress) const;

  /// The exact derivative of end_forces(), given the derivative of the stresses by the strains,
  /// which is symmetric. Only its diagonal blocks are not symmetric: their unsymmetric parts are
  /// those of half the moments, which cancel at a module without a torque in equilibrium.
  EndTangent tangent(const BeamDeformation& beam, const base::Vec6<double>& stress,
                     const base::Mat6<double>& stiffness) const;

  /// The tangent with stresses k e.
  EndTangent tangent(const BeamDeformation& beam) const;

  /// The force in the middle of the connection by statics, in the local frame there, which is p's
  /// moved by half of the screw: as Eq. (16), fz > 0 is tension.
  base::Vec6<double> middle_force(const BeamDeformation& beam,
                                  const base::Vec6<double>& stress) const;

  /// The derivative of the forces at rest, B^T s, with the stresses s fixed, made symmetric: K_G of
  /// a linear buckling problem K + mu K_G. The stresses of a linear solution are its force in the
  /// middle, Eq. (16), local frame.
  EndTangent geometric_stiffness(const base::Vec6<double>& stress) const;

  /// geometric_stiffness(stress) times a motion, its rotation vectors in the last three numbers:
  /// the same without making the matrices, in a tenth of the time.
  EndForces geometric_forces(const base::Vec6<double>& stress, const base::Vec6<double>& u_p,
                             const base::Vec6<double>& u_q) const;

  /// The terms of second order of the forces at u_p, u_q, rotation vectors in their last three:
  /// end_forces() at h u is h K u + h^2 second_order_forces(u) + O(h^3).
  EndForces second_order_forces(const base::Vec6<double>& u_p, const base::Vec6<double>& u_q) const;

  /// The terms of second order of the stresses k e in the same motion.
  base::Vec6<double> second_order_stress(const base::Vec6<double>& u_p,
                                         const base::Vec6<double>& u_q) const;

  /// The term of second order of middle_force() in a motion that begins with h u_p, h u_q, from the
  /// forces on q of first and second order, global frame.
  base::Vec6<double> second_order_middle_force(const base::Vec6<double>& u_p,
                                               const base::Vec6<double>& u_q,
                                               const base::Vec6<double>& first_on_q,
                                               const base::Vec6<double>& second_on_q) const;

 private:
  base::Vec6<double> stiffness_{};
  double length_ = 0;
  Rotation<double> axes_{};
};

}  // namespace holdfast::mechanics
