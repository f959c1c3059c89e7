// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "elimination.hpp"
#include "holdfast/base/algebra.hpp"
#include "holdfast/host/team.hpp"
#include "holdfast/model/robot.hpp"
#include "vectors.hpp"

/// What is left of a robot when everything is eliminated that can be eliminated by hand: static
/// condensation of substructures (condensation.hpp).
///
/// Hanging trees carry their own weight only: their load, with its lever, moves to where they hang.
/// A straight run of modules with two connections each is one longer beam: cubic displacements are
/// exact for a beam that is loaded at its ends, so its stiffness is Eqs. (1)-(2) with the longer
/// length, and a load in between moves to the ends by the same cubics [Przemieniecki 1968].
///
/// The rest are the nodes. They are sorted by colour, then along the Morton curve; no two nodes of
/// one colour share a beam, and a lattice needs two colours.
namespace holdfast::solver {

struct ReducedNetwork {
  std::size_t node_count = 0;
  std::vector<std::size_t> colour_start;  ///< First node of each colour, then node_count.
  std::vector<std::int32_t> module;       ///< Node -> module.
  std::vector<Others> other;
  std::vector<Kind> kind;  ///< A beam down to the ground or to a fixed module has no other node.
  std::vector<std::int32_t> order;  ///< Nodes along the Morton curve.
  std::vector<std::uint64_t> key;   ///< Their Morton keys, ascending.
  bool has_long_beams = false;
  std::int32_t extent = 0;  ///< Longest side of the box around the nodes, pitches.

  std::vector<HangingModule> hanging;  ///< In the order of elimination.
  std::vector<Run> runs;

  /// Whether anything was eliminated.
  bool is_reduced() const { return !hanging.empty() || !runs.empty(); }
};

ReducedNetwork make_reduced_network(const model::Robot& robot, host::Team& team);

}  // namespace holdfast::solver
