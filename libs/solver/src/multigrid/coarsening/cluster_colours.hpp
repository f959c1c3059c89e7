// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "holdfast/host/ranks.hpp"
#include "holdfast/host/team.hpp"
#include "multigrid/coarsening/spring_graph.hpp"

namespace holdfast::solver {

/// The clusters that a level's nodes have joined, numbered along the Morton curve.
struct Clusters {
  std::span<const std::int32_t> of_node;       ///< Node -> cluster.
  std::span<const std::int32_t> member;        ///< Nodes by cluster.
  std::span<const std::int32_t> member_start;  ///< Cluster -> its first member; and the end.
  unsigned shift = 0;  ///< A cluster's cell is its nodes' keys without so many bits.
};

/// Colours, below 64, so that neighbours have two: first fit along the curve, as which a robot in
/// parts has the colours of one machine. `halo` is that of the nodes' copies; none of a whole.
std::vector<std::uint8_t> colour_clusters(const SpringGraph& graph, const Clusters& clusters,
                                          host::Team& team, host::Halo& halo);

}  // namespace holdfast::solver
