// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "slides/slide_plan.hpp"

#include <algorithm>
#include <utility>

namespace holdfast::plan {
namespace {

/// Attempts, in turns from both ends; the first two of them get stuck sooner.
constexpr std::size_t kAttempts = 20;
constexpr std::size_t kUnlockBase = 40;

}  // namespace

SlidePlan plan_slides(SlideTask task, std::uint64_t seed, SlideJudge& forth, SlideJudge& back) {
  SlidePlan plan;
  std::vector<SlideWalk> last;  // Backwards, from the target.
  for (std::size_t attempt = 0; attempt < kAttempts && !forth.is_over(); ++attempt) {
    const bool is_forth = attempt % 2 == 0;
    SlidePlanner planner(task, seed + attempt, is_forth ? forth : back);
    plan.is_found = planner.run(attempt < 2 ? 0 : kUnlockBase + task.start.size());
    std::vector<SlideWalk>& made = is_forth ? plan.walks : last;
    made.insert(made.end(), planner.walks().begin(), planner.walks().end());
    task.start = planner.cubes();
    if (plan.is_found) {
      break;
    }
    std::swap(task.start, task.target);
  }
  if (plan.is_found) {
    std::for_each(last.rbegin(), last.rend(), [&](SlideWalk& walk) {
      std::ranges::reverse(walk);
      plan.walks.push_back(std::move(walk));
    });
  }
  return plan;
}

}  // namespace holdfast::plan
