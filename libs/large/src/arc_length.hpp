// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "equilibrium.hpp"

/// What happens where Newton's method finds no equilibrium for more load.
namespace holdfast::large {

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
