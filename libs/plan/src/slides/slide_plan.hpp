// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "slides/slide_planner.hpp"

namespace holdfast::plan {

/// Walks from the start to the target; or where none are found to where they lead.
struct SlidePlan {
  bool is_found = false;
  std::vector<SlideWalk> walks = {};
};

/// Plans from both ends in turns, the second of them backwards: `back` is asked of walks the other
/// way round.
SlidePlan plan_slides(SlideTask task, std::uint64_t seed, SlideJudge& forth, SlideJudge& back);

}  // namespace holdfast::plan
