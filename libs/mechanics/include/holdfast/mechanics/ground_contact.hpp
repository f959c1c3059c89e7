// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "holdfast/base/algebra.hpp"
#include "holdfast/mechanics/beam.hpp"

/// One facet on the ground: unilateral, without slip, free to tilt over its edges.
///
/// A resting module hangs on a beam to an immobile ground node one pitch below; the facet cuts
/// that beam in the middle. Seen from the facet centre the beam is diagonal: with
///   w = [ux - ty L/2, uy + tx L/2, uz, tx, ty, tz]       displacement of the facet centre
///   t = H w,  H = diag(12 E Ix/L^3, 12 E Iy/L^3, E A/L, E Iy/L, E Ix/L, E Jv/L)
/// t = [fx fy fz mx^ my^ mz] is the trial force of Eq. (9), its torques taken about the facet
/// centre: mx^ = mx - fy L/2 and my^ = my + fx L/2 are exactly those of Eqs. (7)-(8). fz < 0 is
/// compression, l = a/2 is half the facet's width. Two laws turn t into the force that acts:
///
/// kRegularised, the paper's predictor-corrector, Eqs. (10)-(12), with g~ = 1 - gamma:
///   fz >= 0                open:     every component times gamma
///   |mx^| >= -fz l         tilts:    mx^ := gamma mx^ - g~ sign(mx^) fz l     (same for my^)
/// It needs only the trial force, but its tangent is not symmetric and a consistent state may not
/// exist, because fz is not corrected when the facet rolls onto an edge.
///
/// kUnilateral, the problem behind it (Eqs. 6-8): the facet may leave the ground by a rigid motion
/// v with all four corners at or above it, and force and motion are complementary. In
///   s = [uz, tx l, ty l] of v      the admissible motions are the cone  s0 >= |s1| + |s2|,
/// and H is diagonal there too, k = [E A/L, E Iy/(L l^2), E Ix/(L l^2)]. Minimising the beam's
/// energy over v is the projection onto that cone in the metric k, in closed form:
///   closed   v = 0                  if |k1 s1| <= -k0 s0 and |k2 s2| <= -k0 s0
///   edge     v along [1, +-1, 0]    the facet stands on two corners
///   corner   two edges at once      it stands on one corner, p = -fz > 0 with
///                                   p (1 + k0/k1 + k0/k2) = k0 (|s1| + |s2| - s0)
///   open     v = w                  if s0 >= |s1| + |s2|; the force is zero
/// For given held facets the force is the gradient of a convex, once differentiable, piecewise
/// quadratic energy, so the tangent is symmetric and the equilibrium of a robot is unique. A weak
/// spring of gamma H acts beside the contact.
///
/// Over which edge: the robot tips about the edge that stays pressed. By mx = y fz - z fy, weight
/// beyond the +y edge makes mx^ negative: mx^ < 0 tips over +y, my^ > 0 tips over +x. (The
/// authors' published program has both signs the other way round, which mirrors the corner sets
/// of Sec. III-C within each facet.)
namespace holdfast::mechanics {

enum class ContactLaw : std::uint8_t { kRegularised, kUnilateral };

/// The part of a facet that presses: all of it, one edge, one corner, nothing.
struct ContactState {
  bool pressed = true;
  std::int8_t tilt_x = 0;  ///< Sign of mx^ while the facet tilts about x, else 0.
  std::int8_t tilt_y = 0;  ///< Sign of my^ while the facet tilts about y, else 0.

  /// The number of states; code() counts them from 0.
  static constexpr int kCodeCount = 10;

  /// A number for each state: 0 for a facet that does not press, 5 for one that presses all over.
  constexpr int code() const { return pressed ? 5 + 3 * tilt_x + tilt_y : 0; }

  /// The state of a code from 0 to kCodeCount - 1.
  static constexpr ContactState from_code(int code) {
    return code == 0 ? ContactState{.pressed = false}
                     : ContactState{.pressed = true,
                                    .tilt_x = static_cast<std::int8_t>((code - 1) / 3 - 1),
                                    .tilt_y = static_cast<std::int8_t>((code - 1) % 3 - 1)};
  }

  friend constexpr bool operator==(const ContactState&, const ContactState&) = default;
};

/// Presses all over, and is stuck sideways: where every search for states begins.
inline constexpr ContactState kStuck;

/// The diagonal H of one facet, and its geometry. Units: N/mm, N mm, mm.
template <class Real>
struct GroundFacet {
  base::Vec6<Real> stiffness{};  ///< H
  Real lever = 0;                ///< L/2, from the node down to the facet.
  Real half_width = 0;           ///< l = a/2
  Real gamma = 0;                ///< Weak spring that stays when the contact yields.
  ContactLaw law = ContactLaw::kRegularised;
};

template <class Real>
GroundFacet<Real> ground_facet(const BeamSection<Real>& section, Real facet_width, Real gamma,
                               ContactLaw law);

/// The facet of a beam whose stiffness is known already.
template <class Real>
GroundFacet<Real> ground_facet(const BeamStiffness<Real>& beam, Real length, Real facet_width,
                               Real gamma, ContactLaw law);

/// The trial force t for the displacement u of the node, torques about the facet centre (Eq. 9).
template <class Real>
base::Vec6<Real> trial_force(const GroundFacet<Real>& facet, const base::Vec6<Real>& u);

/// The state that the law prescribes for a trial force.
template <class Real>
ContactState contact_state(const GroundFacet<Real>& facet, const base::Vec6<Real>& trial);

/// d(force)/d(trial) in a state: the force on the facet is this matrix times the trial force.
/// For kUnilateral, `is_held` says whether the ground holds the facet against slip and twist; it
/// should if and only if the facet is pressed, which makes the law non-convex, so a solver decides
/// it in a loop of its own. kRegularised ignores it.
template <class Real>
base::Mat6<Real> corrector(const GroundFacet<Real>& facet, ContactState state, bool is_held);

/// F_pq of the support in the global frame at the node, in a given state.
template <class Real>
base::Vec6<Real> contact_force(const GroundFacet<Real>& facet, ContactState state, bool is_held,
                               const base::Vec6<Real>& u);

/// The tangent K11 of the support in the global frame at the node, in a given state.
template <class Real>
base::Mat6<Real> contact_tangent(const GroundFacet<Real>& facet, ContactState state, bool is_held);

/// A symmetric, positive definite stand-in for the tangent, for solvers that need one, times u.
/// For kUnilateral, and for a facet that does not tilt, it is the tangent itself. A facet that
/// tilts under kRegularised has fz = k uz while its torque follows fz; the stand-in puts the spring
/// k at the pressed edge or corner instead, fz = k (uz - sign_x l tx - sign_y l ty), where the
/// force of the regularised law acts as well. Correcting the difference in an outer loop converges.
template <class Real>
base::Vec6<Real> symmetric_product(const GroundFacet<Real>& facet, ContactState state, bool is_held,
                                   const base::Vec6<Real>& u);

/// The matrix that symmetric_product() multiplies with, global frame at the node.
template <class Real>
base::Mat6<Real> symmetric_tangent(const GroundFacet<Real>& facet, ContactState state,
                                   bool is_held);

}  // namespace holdfast::mechanics
