// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <optional>

#include "holdfast/base/algebra.hpp"
#include "holdfast/mechanics/beam.hpp"

/// When a connection breaks: its limits, and how near a load is to each of them.
///
/// In the middle of a connection act N axially (tension +), the bending moment M, V across and the
/// torsion T. Each limit makes a ratio, the factor by which all loads exceed it:
///   opens           (N + M / lever) / strength             M = max(|mx|, |my|), or their length
///   slides, turns   (N + V / mu + |T| / (mu r)) / strength magnets that press with their strength
///   slides          V / shear_strength                     latches
///   turns           |T| / torsion_strength                 latches
/// The largest is the load ratio. With friction the second takes the place of the first where it is
/// larger. Eq. (17) of [Piranda 2021] is the first with lever = a / 2.
///
/// Lengths of vectors are the caller's, length(x, y): the standard library's square root is not
/// freestanding.
namespace holdfast::mechanics {

enum class Limit : std::uint8_t { kOpens, kSlips, kShears, kTwists };

inline constexpr int kLimitCount = 4;

/// Returns "opens", "slips", "shears" or "twists".
const char* name(Limit limit);

enum class BendingLaw : std::uint8_t {
  kSquare,  ///< M = max(|mx|, |my|)
  kRound,   ///< M = the length of (mx, my)
};

struct ConnectorLaw {
  static constexpr double kUnlimited = std::numeric_limits<double>::infinity();

  double strength_n = kUnlimited;
  double lever_mm = 1;
  BendingLaw bending = BendingLaw::kSquare;
  double shear_strength_n = kUnlimited;
  double torsion_strength_nmm = kUnlimited;
  /// The coefficient of friction mu, more than 0; none if the connection does not slip.
  std::optional<double> friction = {};
  double torsion_radius_mm = kUnlimited;  ///< r; unlimited: does not turn.
  /// An opening of the facet's edge beyond which contacts of power and data part: a warning.
  double gap_limit_mm = kUnlimited;

  friend bool operator==(const ConnectorLaw&, const ConnectorLaw&) = default;
};

/// The law of a connection of two modules: of every number the one that holds less.
ConnectorLaw weaker(const ConnectorLaw& a, const ConnectorLaw& b);

/// The load of a connection as the numbers of its limits: N axially, M bending, V across, T
/// torsion; units N and N mm.
struct ConnectionForce {
  double axial_n = 0;
  double bending_nmm = 0;
  double shear_n = 0;
  double torsion_nmm = 0;
};

/// The bending moment M of a force in the middle, local frame (Eq. 16).
template <class Length>
double bending_moment(const ConnectorLaw& law, const base::Vec6<double>& middle_force,
                      const Length& length) {
  const double mx = middle_force[3];
  const double my = middle_force[4];
  if (law.bending == BendingLaw::kRound) {
    return length(mx, my);
  }
  const double size_x = base::absolute(mx);
  const double size_y = base::absolute(my);
  return size_x < size_y ? size_y : size_x;
}

/// The numbers of ConnectionForce for a force in the middle, local frame (Eq. 16).
template <class Length>
ConnectionForce connection_force(const ConnectorLaw& law, const base::Vec6<double>& middle_force,
                                 const Length& length) {
  return {.axial_n = middle_force[2],
          .bending_nmm = bending_moment(law, middle_force, length),
          .shear_n = length(middle_force[0], middle_force[1]),
          .torsion_nmm = middle_force[5]};
}

/// The width by which the facet's edge opens, for a force in the middle, local frame: N L / (E A)
/// and the angles of bending times the lever; 0 where it is pressed.
template <class Length>
double gap_mm(const ConnectorLaw& law, const BeamStiffness<double>& beam,
              const base::Vec6<double>& middle_force, const Length& length) {
  const double about_x = base::absolute(middle_force[3]) / (beam.bend_y / 4);
  const double about_y = base::absolute(middle_force[4]) / (beam.bend_x / 4);
  const double angle =
      law.bending == BendingLaw::kRound ? length(about_x, about_y) : about_x + about_y;
  const double gap = middle_force[2] / beam.axial + angle * law.lever_mm;
  return gap < 0 ? 0 : gap;
}

/// The ratio of every limit, by Limit; minus infinity for a limit that the law does not have.
std::array<double, kLimitCount> limit_ratios(const ConnectorLaw& law, const ConnectionForce& force);

/// The largest of the ratios, and whose it is; 0 where nothing is limited.
struct LimitRatio {
  Limit limit = Limit::kOpens;
  double ratio = 0;
};

LimitRatio load_ratio(const ConnectorLaw& law, const ConnectionForce& force);

}  // namespace holdfast::mechanics
