// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "judges/stage_parts.hpp"

#include <algorithm>
#include <cstdint>
#include <utility>

#include "bounds/batch_bound.hpp"
#include "bounds/run_judge.hpp"
#include "holdfast/plan/part_of.hpp"
#include "judges/stage_judge.hpp"
#include "own_solution.hpp"

namespace holdfast::plan {
namespace {

const std::vector<base::Cell>& batch_of(const model::Step& step) {
  return step.attach.empty() ? step.detach : step.attach;
}

/// The step with these of its modules. Of one that detaches they are those that have not gone.
model::Step step_of_part(const model::Step& step, const std::vector<base::Cell>& there) {
  const auto is_there = [&](const base::Cell& cell) {
    return std::ranges::find(there, cell) != there.end();
  };
  model::Step part = step;
  std::erase_if(part.detach, is_there);
  const auto is_absent = [&](const auto& of_cell) { return !is_there(of_cell.cell); };
  std::erase_if(part.attach, [&](const base::Cell& cell) { return !is_there(cell); });
  std::erase_if(part.own_kinds, is_absent);
  std::erase_if(part.own_masses, is_absent);
  std::erase_if(part.payloads, is_absent);
  return part;
}

/// The proper parts that are checked, by which of the modules are there: all, or where these are
/// too many those with one module or all but one.
std::vector<std::vector<base::Cell>> checked_parts(const std::vector<base::Cell>& batch) {
  const std::size_t count = batch.size();
  std::vector<std::vector<base::Cell>> parts;
  if (count <= kCheckedPartsMax) {
    for (std::uint32_t bits = 1; bits + 1 < std::uint32_t{1} << count; ++bits) {
      std::vector<base::Cell>& part = parts.emplace_back();
      for (std::size_t i = 0; i < count; ++i) {
        if ((bits >> i & 1U) != 0) {
          part.push_back(batch[i]);
        }
      }
    }
    return parts;
  }
  for (const base::Cell& cell : batch) {
    parts.push_back({cell});
    parts.push_back(batch);
    std::erase(parts.back(), cell);
  }
  return parts;
}

/// The robot with all modules of the step.
base::Result<RobotState> with_all_of(const RobotState& before, const model::Step& step) {
  RobotState robot = before;
  if (!step.attach.empty()) {
    const auto transition = find_transition(robot, step);
    if (!transition) {
      return transition.error();
    }
    apply(step, transition.value(), robot);
  }
  return robot;
}

/// What a bound says of all parts, if it does.
std::optional<Judgement> certify_parts(const RobotState& whole,
                                       const std::vector<base::Cell>& batch,
                                       const solver::EquilibriumOptions& options) {
  const model::RobotSpec spec = whole.spec();
  const auto target = model::Robot::create(spec, options.thread_count);
  if (!target || needs_own_solution(target.value()) || options.is_bonded) {
    return std::nullopt;
  }
  ElementSet core(spec.existing.size());
  std::vector<Element> coming;
  for (std::size_t i = 0; i < spec.existing.size(); ++i) {
    const auto element = static_cast<Element>(i);
    if (std::ranges::find(batch, spec.existing[i]) == batch.end()) {
      core.insert(element);
    } else {
      coming.push_back(element);
    }
  }
  const auto is_beside = [&](Element element) {
    return std::ranges::any_of(target.value().connected()[base::at(element)],
                               [&](std::int32_t other) {
                                 return other != model::Robot::kNoNeighbour && core.contains(other);
                               });
  };
  if (core.size() == 0 || !std::ranges::all_of(coming, is_beside)) {
    return std::nullopt;
  }
  RunJudge judge(spec, target.value(), options.thread_count, options);
  const LocalAdjoints nearby(target.value());
  BatchBound bound(spec, target.value(), nearby);
  if (!bound.begin(core, judge.assess(core))) {
    return std::nullopt;
  }
  bound.prepare(coming);
  std::optional<Judgement> judgement;
  for (const Element element : coming) {
    judgement = bound.add(element);
    if (!judgement) {
      return std::nullopt;
    }
  }
  return judgement;
}

void add_judged_part(StageJudgement& all, const StageJudgement& part,
                     const std::vector<base::Cell>& there, std::size_t batch_count) {
  const auto ratio = larger(all.load_ratio_max, part.load_ratio_max);
  const auto margin = smaller(all.margin_mm, part.margin_mm);
  if (all.reasons.empty() || is_worse(all, part)) {
    all = part;
    all.reasons.push_back({.reason = {.code = verdict::ReasonCode::kPartHasCome,
                                      .numbers = {static_cast<double>(there.size()),
                                                  static_cast<double>(batch_count)}},
                           .cells = there});
  }
  all.load_ratio_max = ratio;
  all.margin_mm = margin;
}

}  // namespace

Stage stage_of_parts(const model::Step& step) {
  return step.attach.empty() ? Stage::kShift : Stage::kConnect;
}

base::Result<StageJudgement> judge_parts(const RobotState& before, const model::Step& step,
                                         const solver::EquilibriumOptions& options,
                                         const JudgePart& judge_part) {
  const std::vector<base::Cell>& batch = batch_of(step);
  const auto whole = with_all_of(before, step);
  if (!whole) {
    return whole.error();
  }
  StageJudgement all;
  if (const auto certified = certify_parts(whole.value(), batch, options)) {
    static_cast<Judgement&>(all) = *certified;
    return all;
  }
  all.verdict = verdict::Verdict::kSafe;
  for (const std::vector<base::Cell>& there : checked_parts(batch)) {
    const auto part = judge_part(step_of_part(step, there));
    if (!part) {
      return base::Error{.code = part.error().code,
                         .message = part.error().message +
                                    "; in any order each module has to be "
                                    "able to come, or go, first",
                         .where = part.error().where};
    }
    add_judged_part(all, part.value(), there, batch.size());
  }
  if (batch.size() > kCheckedPartsMax && !is_unsafe(all.verdict)) {
    all.verdict = verdict::Verdict::kUndecided;
    all.reasons.insert(all.reasons.begin(),
                       {.reason = {.code = verdict::ReasonCode::kPartsNotKnown,
                                   .numbers = {static_cast<double>(batch.size())}},
                        .cells = {}});
  }
  return all;
}

}  // namespace holdfast::plan
