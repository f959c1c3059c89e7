// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "moves/move_judge.hpp"
#include "slides/slide_planner.hpp"

namespace holdfast::plan {

/// The task of a SlidePlanner between two shapes; none for robots that it does not know: lattices
/// other than the cubic one, cubes with motions of their own, of several kinds or more than 3,000,
/// shapes too far apart.
std::optional<SlideTask> slide_task(const ShapeSpace& space, const MoveRule& rule);

/// Moves of sliding cubes from one shape to another; if none are found, to where they lead.
struct SlideMoves {
  bool is_found = false;
  std::vector<model::Move> moves = {};
  /// The judgement of each move, as judge_sequence() would say; empty where mechanics is ignored.
  std::vector<StepJudgement> judged = {};
};

/// Seeks moves of many cubes by a SlidePlanner, each safe as the judge says. None for robots that
/// it does not know.
std::optional<SlideMoves> find_slides(const ShapeSpace& space, const MoveRule& rule,
                                      std::uint64_t seed, MoveJudge& judge);

}  // namespace holdfast::plan
