// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include "multigrid/coarsening/ground_springs.hpp"
#include "multigrid/coarsening/level.hpp"
#include "multigrid/coarsening/spring_graph.hpp"

/// Makes of a level of which each rank has a part one that all ranks have whole.
namespace holdfast::solver {

/// Levels of so many nodes are gathered: that costs a few messages and, at each rank, what a tenth
/// of a million modules' cycle does. Less, and levels of a few nodes a rank wait for messages.
inline constexpr std::size_t kGatheredCount = 6000;

/// All ranks' parts as one graph, nodes by colour and then along the Morton curve, the same at
/// every rank.
SpringGraph gathered_graph(const SpringGraph& part, Gathering& gathering,
                           std::vector<std::size_t>& colour_start);

/// All ranks' ground springs, ascending by node.
std::vector<GroundSpring> gathered_springs(const std::vector<GroundSpring>& part,
                                           const Gathering& gathering, host::Ranks& ranks);

}  // namespace holdfast::solver
