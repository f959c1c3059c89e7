// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "holdfast/base/algebra.hpp"
#include "holdfast/base/cell.hpp"

/// One connection between face neighbours: a linear-elastic beam from node to node.
///
/// Eqs. (1)-(4) of [Piranda 2021]. p is the module, q its neighbour; in the local frame z points
/// from q to p. With Delta = u_p - u_q and the half rotations added, the force that the beam
/// takes from p is
///   fx = sx (ux_p - ux_q) - cx (ty_p + ty_q)        sx = 12 E Ix / L^3    cx = 6 E Ix / L^2
///   fy = sy (uy_p - uy_q) + cy (tx_p + tx_q)        sy = 12 E Iy / L^3    cy = 6 E Iy / L^2
///   fz = a  (uz_p - uz_q)                           a  = E A / L
///   mx = cy (uy_p - uy_q) + by tx_p + by/2 tx_q     by = 4 E Iy / L
///   my = -cx (ux_p - ux_q) + bx ty_p + bx/2 ty_q    bx = 4 E Ix / L
///   mz = w  (tz_p - tz_q)                           w  = E Jv / L
/// In the middle of the beam (Eq. 16, the mean of F_pq and -F_qp) fx, fy, fz, mz are the same and
///   mx = by/4 (tx_p - tx_q),   my = bx/4 (ty_p - ty_q).
/// Forces of a beam whose ends move as one rigid body are zero.
///
/// Local axes: on a vertical beam local x is the global x axis; on a lateral beam local x points
/// up. So Ix bends lateral beams in the vertical plane (it is VisibleSim's globalIy).
namespace holdfast::mechanics {

/// The section and material of a beam. Units: MPa, mm, mm^2, mm^4.
template <class Real>
struct BeamSection {
  Real elastic_modulus = 0;  ///< E
  Real length = 0;           ///< L, from node to node
  Real area = 0;             ///< A
  Real moment_x = 0;         ///< Ix
  Real moment_y = 0;         ///< Iy
  Real torsion = 0;          ///< Jv = J / (2 (1 + nu)), the scaled torsion constant
};

/// The eight different numbers of Eqs. (1)-(2). Units: N/mm, N, N mm.
template <class Real>
struct BeamStiffness {
  Real shear_x = 0;   ///< sx
  Real shear_y = 0;   ///< sy
  Real axial = 0;     ///< a
  Real couple_x = 0;  ///< cx
  Real couple_y = 0;  ///< cy
  Real bend_x = 0;    ///< bx
  Real bend_y = 0;    ///< by
  Real twist = 0;     ///< w
};

template <class Real>
BeamStiffness<Real> beam_stiffness(const BeamSection<Real>& section);

/// Rotates a global vector into the local frame of the beam from a module to its neighbour in
/// `direction`, and back: multiplication by R^T and R of Eqs. (3)-(4), by permutation and sign.
template <class Real>
base::Vec6<Real> to_local(base::Direction direction, const base::Vec6<Real>& global);

template <class Real>
base::Vec6<Real> to_global(base::Direction direction, const base::Vec6<Real>& local);

/// F_pq = K11 u_p + K12 u_q in the global frame; q is the neighbour of p in `direction`.
template <class Real>
base::Vec6<Real> end_force(const BeamStiffness<Real>& beam, base::Direction direction,
                           const base::Vec6<Real>& u_p, const base::Vec6<Real>& u_q);

/// Eq. (16): force and torque in the middle of the connection, in its local frame; fz > 0 is
/// tension, mx and my bend, mz twists.
template <class Real>
base::Vec6<Real> middle_force(const BeamStiffness<Real>& beam, base::Direction direction,
                              const base::Vec6<Real>& u_p, const base::Vec6<Real>& u_q);

/// K11_pq and K12_pq as matrices, global frame, for solvers that assemble. 10 nonzeros each.
template <class Real>
base::Mat6<Real> block_11(const BeamStiffness<Real>& beam, base::Direction direction);

template <class Real>
base::Mat6<Real> block_12(const BeamStiffness<Real>& beam, base::Direction direction);

}  // namespace holdfast::mechanics
