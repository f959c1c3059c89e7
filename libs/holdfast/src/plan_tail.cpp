// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "plan_tail.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace holdfast {
namespace {

/// Steps of the plan are given up one by one, and faster once this number of tails has failed.
constexpr std::size_t kTriedOneByOne = 8;

/// Whether all of a step is safe, in one piece.
bool is_safe_step(const plan::StepJudgement& step) {
  return std::ranges::all_of(step.stages, [](const plan::StageJudgement& stage) {
    return stage.is_safe() && stage.piece_count == 1;
  });
}

}  // namespace

base::Error error_of_plan(std::string message) {
  return {.code = base::ErrorCode::kBadInput, .message = std::move(message), .where = kAtPlan};
}

base::Error error_of_done_steps(std::size_t step_count, std::size_t done_count) {
  return error_of_plan(
      fmt::format("it has {} steps, of which {} cannot be done", step_count, done_count));
}

double PlanTime::seconds_passed() const {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin_).count();
}

double PlanTime::seconds_left() const { return std::max(0.0, seconds_max_ - seconds_passed()); }

base::Result<KeptTail> judge_tail(const PlanTail& tail, std::size_t begin,
                                  const plan::SequenceOptions& options) {
  const std::size_t count = tail.step_count();
  KeptTail kept{.first = count};
  for (std::size_t first = begin; first < count && !options.is_interrupted();) {
    const auto sequence = tail.steps_from(first);
    if (!sequence) {
      return sequence.error();
    }
    auto judged = plan::judge_sequence(sequence.value().start, sequence.value().steps, options);
    if (!judged) {
      const std::string& where = judged.error().where;
      first += where.empty() ? 1 : 1 + std::stoul(where);
      continue;
    }
    std::vector<plan::StepJudgement> found = std::move(judged).value().steps;
    std::size_t lost = found.size();
    if (found.size() == count - first) {
      while (lost > 0 && is_safe_step(found[lost - 1]) && tail.is_allowed(first + lost - 1)) {
        --lost;
      }
      kept.first = first + lost;
    }
    found.erase(found.begin(), found.begin() + static_cast<std::ptrdiff_t>(lost));
    kept.judged = std::move(found);
    break;
  }
  return kept;
}

bool lead_to_tail(std::size_t first, std::size_t step_count, const std::function<bool()>& is_over,
                  const std::function<bool(std::size_t)>& leads_to) {
  for (std::size_t tried_count = 0; first < step_count && !is_over();
       first += 1 + tried_count / kTriedOneByOne) {
    ++tried_count;
    if (leads_to(first)) {
      return true;
    }
  }
  return false;
}

}  // namespace holdfast
