// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include "ground_springs.hpp"
#include "level.hpp"
#include "spring_graph.hpp"

/// From a level of which each rank has a part to one that all ranks have whole.
namespace holdfast::solver {

/// All ranks' parts as one graph, nodes by colour and then along the Morton curve, the same at
/// every rank.
SpringGraph gathered_graph(const SpringGraph& part, Gathering& gathering,
                           std::vector<std::size_t>& colour_start);

/// All ranks' ground springs, ascending by node.
std::vector<GroundSpring> gathered_springs(const std::vector<GroundSpring>& part,
                                           const Gathering& gathering, host::Ranks& ranks);

}  // namespace holdfast::solver
