// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

#include "holdfast/base/algebra.hpp"
#include "holdfast/base/lattice.hpp"
#include "holdfast/host/team.hpp"
#include "holdfast/model/robot.hpp"
#include "multigrid/coarsening/elimination.hpp"
#include "multigrid/kernels/vectors.hpp"

/// What is left of a robot when everything is eliminated that can be eliminated by hand: static
/// condensation of substructures (condensation.hpp).
///
/// Hanging trees carry their own weight only: their load, with its lever, moves to where they hang.
/// A straight run of modules with two connections each is one longer beam: cubic displacements are
/// exact for a beam that is loaded at its ends, so its stiffness is Eqs. (1)-(2) with the longer
/// length, and a load in between moves to the ends by the same cubics [Przemieniecki 1968].
///
/// The rest are the nodes. They are sorted by colour, then along the Morton curve; no two nodes of
/// one colour share a beam. A cubic lattice needs two colours, a hexagonal one three, a
/// face-centred one four.
namespace holdfast::solver {

/// A beam from a node to what does not move: to a fixed module, or through a facet to what that
/// touches.
struct GroundBeam {
  std::int32_t node = 0;
  std::uint8_t direction = 0;
  std::uint8_t length = 0;        ///< Pitches.
  std::uint8_t contact = 0;       ///< The number of the facet's state, 0 if it is stuck.
  std::int32_t facet = kNoFacet;  ///< Index in Robot::facets().

  static constexpr std::int32_t kNoFacet = -1;
};

/// What connects the nodes, direction by direction.
struct LatticeBeams {
  std::vector<std::int32_t> other;  ///< By node, as many as directions; node_count for none.
  std::size_t end_count = 0;        ///< Two for each beam between own nodes, one to a copy.
  std::vector<std::uint32_t> kind;  ///< Node -> lengths
  std::vector<BeamLengths> lengths;
};

/// The nodes and what connects and holds them.
///
/// Of a part of a robot the nodes are this rank's own, and after them the copies of other ranks'.
struct ReducedNetwork {
  base::Lattice lattice;
  bool is_along_axes = false;  ///< Whether all beams are, as those of cubes.
  std::size_t node_count = 0;
  std::size_t own_count = 0;       ///< node_count where there are no copies.
  std::size_t all_count = 0;       ///< All ranks' own ones together.
  std::vector<host::Copy> copies;  ///< By node.
  std::reference_wrapper<host::Ranks> ranks = host::single_rank();  ///< Who owns the originals.
  std::vector<std::size_t> colour_start;  ///< First node of each colour, then own_count.
  std::vector<std::int32_t> module;       ///< Node -> module.
  LatticeBeams beams;
  std::vector<GroundBeam> ground_beams;  ///< By node, then by direction.
  std::vector<std::int32_t> order;       ///< Nodes along the Morton curve; copies after them.
  std::vector<std::uint64_t> key;        ///< Their Morton keys, ascending.
  base::Cell low;                        ///< The robot's lowest corner, where keys count from.
  bool has_long_beams = false;
  std::int32_t extent = 0;  ///< Longest side of the box around the nodes, pitches.

  std::vector<HangingModule> hanging;    ///< In the order of elimination.
  std::vector<std::size_t> round_start;  ///< In it, as in an Elimination.
  std::vector<Run> runs;
  bool is_reduced = false;  ///< Whether anything was eliminated, by any rank.
};

ReducedNetwork make_reduced_network(const model::Robot& robot, host::Team& team);

/// Finds a whole robot's order and keys again if a hierarchy took them.
void find_order(const model::Robot& robot, ReducedNetwork& network);

}  // namespace holdfast::solver
