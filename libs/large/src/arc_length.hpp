// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "equilibrium.hpp"

/// What happens where Newton's method finds no equilibrium for more load.
namespace holdfast::large {

/// A direction of a path: displacements by node and lambda.
struct Tangent {
  std::vector<Vec> u;
  double factor = 0;
};

/// The product of directions in which a pitch counts as much as 1 rad, and the whole robot as one
/// module.
double product(const System& system, const Tangent& a, const Tangent& b);

void scale(Tangent& tangent, double factor);

/// The direction of the path at an equilibrium, of length 1, on the side of `towards`, or with
/// lambda growing. None where the tangent stiffness is singular.
std::optional<Tangent> tangent_at(const System& system, const Found& found, const Tangent* towards);

/// The equilibrium in the plane across a direction, a step away from another one; none where
/// Newton's method does not get there: then `tried` are the states on the way.
std::optional<Configuration> correct(System& system, Configuration here, const Tangent& tangent,
                                     double length, std::vector<FacetStates>* tried = nullptr);

struct Turn {
  bool does_turn = false;  ///< Whether lambda grows less from here on: a limit point.
  /// An equilibrium for more load than that which failed, where it goes on after all.
  std::optional<Found> beyond = {};
};

/// Goes on from an equilibrium by arc length [Riks 1979] until lambda shrinks or exceeds
/// `failed_at`; neither where it finds nothing.
Turn turn_at(System& system, const Found& from, double failed_at);

/// The displacements that the tangent of an equilibrium, made again, resists least, by node:
/// inverse iteration.
std::vector<Vec> softest_mode(System& system, const Found& from);

}  // namespace holdfast::large
