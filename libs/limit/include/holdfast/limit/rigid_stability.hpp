// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>

/// Does a rigid body stay where it is, held by contacts that can only push, wherever they are?
///
/// The contacts' forces are a convex cone of wrenches: at every corner of a facet a push, and
/// across it any force (no slip) or one within the cone of friction. The body stays if this cone
/// holds minus the load, with something to spare on every side. Friction cones are taken as they
/// are, not as pyramids. Derivation: docs/limit.md.
namespace holdfast::limit {

using Vector3 = std::array<double, 3>;

/// A square facet with which the body touches its environment.
struct ContactFacet {
  Vector3 centre_mm{};
  /// x', y' along the facet, z' into the body, each of length one.
  std::array<Vector3, 3> frame{};
  double half_width_mm = 0;             ///< 0 is a point.
  bool is_bonded = false;               ///< Holds whatever the load is.
  std::optional<double> friction = {};  ///< Coefficient, 0 or more. None: no slip.
};

/// What the body carries, global frame. Weight turns with gravity, the payload does not.
struct BodyLoad {
  Vector3 weight_n{};
  Vector3 centre_of_mass_mm{};
  Vector3 payload_n{};
  Vector3 payload_nmm{};   ///< Moment about the centre of mass.
  double gyration_mm = 1;  ///< Radius that moments are compared with forces by; more than 0.
};

enum class RigidAnswer : std::uint8_t {
  kHolds,
  kNothingToSpare,  ///< Balanced, but some disturbance, however small, moves it.
  kFalls,           ///< No contact forces balance the load.
  kUndecided,       ///< The iteration did not settle.
};

/// The first instant of the fall: the acceleration that Gauss's principle of least constraint gives
/// a body whose masses lie at the radius of gyration, scaled so that the larger of |velocity| and
/// |angular| times that radius is 1 mm.
struct Motion {
  enum class Kind : std::uint8_t {
    kTips,    ///< Over the edge from `from` to `to`, or the corner where both are one.
    kSlides,  ///< All but without turning, along what it touches.
    kTurns,   ///< About the axis through `from` along `angular`.
    kLeaves,  ///< All but without turning, away from what it touches.
  };

  Kind kind = Kind::kLeaves;
  Vector3 velocity{};  ///< Of the centre of mass.
  Vector3 angular{};   ///< rad.
  Vector3 from_mm{};
  Vector3 to_mm{};
};

struct RigidStability {
  RigidAnswer answer = RigidAnswer::kUndecided;
  /// The largest share of the load that may be added as a force at the centre of mass along any
  /// axis, or, times `gyration_mm`, as a moment about any axis, before it moves; below 0: how far
  /// the load is from what contacts can balance, as a share of it. None: bonded, clamped from all
  /// sides, or no load. Right within kMarginTie and 1e-8 of it, and above neither for what moves.
  std::optional<double> margin = {};
  /// The smallest coefficient with which it holds at all contact facets, for the best contact
  /// forces, rounded up: with this one it holds, and one that is smaller by more than
  /// kFrictionAccuracy of it does not balance the load. 0: none is needed to balance it.
  /// kFrictionLeast where less would do, such as between two things that it can wedge apart. The
  /// elastic forces may take more. None: none does, nobody asked for it, or nobody needs to as a
  /// facet is bonded.
  std::optional<double> friction_needed = {};
  /// The smallest angle by which gravity can turn, in any direction, before it moves, rounded down
  /// by at most kTiltAccuracy of it; 0 where it does not hold as it is. None: it holds whatever the
  /// direction, there is no weight, or nobody asked for it.
  std::optional<double> tilt_margin_deg = {};
  /// The first instant of the fall. None where the body holds, or where nothing says in which
  /// direction it would go.
  std::optional<Motion> motion = {};

  bool holds() const { return answer == RigidAnswer::kHolds; }
};

/// Margins below this count as none: rounding.
inline constexpr double kMarginTie = 1e-9;

/// The accuracy of the friction needed and of the tilt, as shares of them. Both are bounds from the
/// safe side.
inline constexpr double kFrictionAccuracy = 1e-3;
inline constexpr double kTiltAccuracy = 2e-4;

/// Coefficients of friction below this are not distinguished from it, except 0.
inline constexpr double kFrictionLeast = 1e-2;

/// Coefficients of friction beyond this are not looked at.
inline constexpr double kFrictionMax = 1000;

/// Decides whether the body stays. `has_figures` adds the friction needed and the tilt, which takes
/// as long as a hundred of the rest where contacts have friction.
RigidStability assess_rigid(std::span<const ContactFacet> facets, const BodyLoad& load,
                            bool has_figures = true);

/// "holds", "nothing to spare", "falls", "undecided".
const char* name(RigidAnswer answer);

/// A few words: "tips over the edge from (20, -20, 0) to (20, 20, 0)", places in mm.
std::string text(const Motion& motion);

}  // namespace holdfast::limit
