// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "watch.hpp"

/// What is behind the first loss of stability.
namespace holdfast::large {

/// The place at which stability is lost, and how.
struct LossPlace {
  const Stop* last = nullptr;  ///< The last stable equilibrium.
  /// The states that facets go into, in which it is not stable: it tips over these facets.
  std::optional<FacetStates> tipping = {};
  bool lets_go = false;  ///< A facet opens and lets go sideways.
};

/// Follows the equilibria behind the loss that is noted in `path`, into its branches. Equilibria
/// are judged by the tangent and a millionth of the loads' stiffness, as a branch may turn about
/// itself at no force: so does a leaning tower of square sections.
void follow_behind(System& system, const Watch& watch, const Options& options,
                   const LossPlace& place, Path& path);

}  // namespace holdfast::large
