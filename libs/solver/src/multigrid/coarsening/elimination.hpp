// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "holdfast/host/team.hpp"
#include "holdfast/model/robot.hpp"

namespace holdfast::solver {

/// A module with one connection, to its host. Of a part of a robot it, or its host, may be a copy.
struct HangingModule {
  std::int32_t module = 0;
  std::uint8_t direction = 0;  ///< To its host.
};

/// A straight run of modules between two others.
struct Run {
  std::int32_t from = 0;       ///< Module before the first.
  std::uint8_t direction = 0;  ///< From there onwards.
  std::int32_t length = 0;     ///< Pitches to the module after the last.
};

/// The modules of a robot that need not be nodes: those of hanging trees, and those inside straight
/// runs, that is, with two connections each that lie opposite.
struct Elimination {
  std::vector<std::uint8_t> is_gone;  ///< By module: eliminated, or fixed.
  /// The axis, that is half of a direction, of the run that each module lies in, else kNoAxis;
  /// empty if nothing is eliminated, and there are no copies.
  std::vector<std::uint8_t> run_axis;
  std::vector<HangingModule> hanging;  ///< In the order of elimination.
  /// Where each round of all ranks begins in `hanging`, then its end. Before a round they exchange
  /// what has gone. As many at all of them; without ranks one, or none if `hanging` is empty.
  std::vector<std::size_t> round_start;
  std::vector<Run> runs;

  static constexpr std::uint8_t kNoAxis = 255;

  bool is_empty() const { return run_axis.empty(); }
};

/// Finds the elimination. Runs of a part of a robot are eliminated across ranks, by all that have
/// some of their modules, as far as all of these are here (passages.hpp); hanging trees by turns.
Elimination eliminate(const model::Robot& robot, host::Team& team);

}  // namespace holdfast::solver
