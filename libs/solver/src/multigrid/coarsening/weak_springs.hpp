// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "holdfast/host/team.hpp"
#include "multigrid/coarsening/spring_graph.hpp"

/// Strength of connection: what a neck holds must not become one rigid body with what is behind it.
///
/// A bump that grew on a solid and is held by a few modules has a soft motion of its own. If the
/// neck lies within one cell, the cluster around it is rigid, and no coarser level knows that
/// motion: smoothing alone must find it, which takes dozens of iterations, for each such bump.
/// A spring S is weak if there is a motion that it resists by less than a share of what all
/// springs of the node do: S - kWeakShare K_pp is not positive definite. In a solid the least
/// resistance of a spring between clusters is 0.03 of K_pp's, in a plate 0.01. A node that is held
/// by one spring alone has K_pp = S, so a bump joins its neck once it is a single node itself.
/// Frames of beams a dozen modules long are as weak as necks: where hardly anything would unite
/// without weak springs, they do unite.
namespace holdfast::solver {

/// 1 for every edge of the level whose spring is weak at both ends; empty if there is none. On the
/// finest level each spring is one beam, and none counts as weak. Ranks that share the level ask
/// together, by what keeps its `copies` up to date.
std::vector<std::uint8_t> weak_springs(const SpringGraph& graph, host::Team& team,
                                       host::Halo& copies);

}  // namespace holdfast::solver
