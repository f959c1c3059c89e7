// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "judges/certified_run.hpp"

#include <algorithm>
#include <optional>
#include <utility>

#include "holdfast/plan/part_of.hpp"
#include "judges/stage_judge.hpp"
#include "own_solution.hpp"

namespace holdfast::plan {
namespace {

/// Pieces of runs begin with states that are solved; shorter runs are solved altogether.
constexpr std::size_t kStepMin = 8;

std::optional<Sense> sense_of(const model::Step& step) {
  if (step.is_any_order || step.is_apart || !step.moves.empty() || !step.release.empty() ||
      !step.connect.empty() || step.attach.empty() == step.detach.empty()) {
    return std::nullopt;
  }
  return step.detach.empty() ? Sense::kGrowing : Sense::kShrinking;
}

/// The modules of a growing robot, batch by batch as they come.
struct Growth {
  ElementSet begin;
  std::vector<Element> order;
  std::vector<std::size_t> ends;  ///< By batch: how many have come with it and those before.
};

/// Adds a batch so that each module is beside one that is there. False if there is no such way.
bool add_batch(const model::Robot& target, std::vector<Element> batch, ElementSet& state,
               std::vector<Element>& order) {
  const auto is_beside = [&](Element element) {
    return std::ranges::any_of(target.connected()[base::at(element)], [&](std::int32_t other) {
      return other != model::Robot::kNoNeighbour && state.contains(other);
    });
  };
  while (!batch.empty()) {
    const auto next = std::ranges::find_if(batch, is_beside);
    if (next == batch.end()) {
      return false;
    }
    state.insert(*next);
    order.push_back(*next);
    batch.erase(next);
  }
  return true;
}

/// How the largest robot of a run grows; none if it is in pieces at some time.
std::optional<Growth> find_growth(const model::RobotSpec& largest, const model::Robot& target,
                                  std::span<const model::Step> steps, Sense sense) {
  model::CellIndex index(largest.existing.size());
  ElementSet state(largest.existing.size());
  for (std::size_t i = 0; i < largest.existing.size(); ++i) {
    index.insert(largest.existing[i], static_cast<std::int32_t>(i));
    state.insert(static_cast<Element>(i));
  }
  std::vector<std::vector<Element>> batches;
  for (const model::Step& step : steps) {
    std::vector<Element>& batch = batches.emplace_back();
    for (const base::Cell& cell : sense == Sense::kGrowing ? step.attach : step.detach) {
      batch.push_back(index.find(cell));
      state.erase(batch.back());
    }
  }
  if (sense == Sense::kShrinking) {
    std::ranges::reverse(batches);
  }
  Growth growth{.begin = state, .order = {}, .ends = {}};
  for (std::vector<Element>& batch : batches) {
    if (!add_batch(target, std::move(batch), state, growth.order)) {
      return std::nullopt;
    }
    growth.ends.push_back(growth.order.size());
  }
  return growth;
}

StageJudgement solved_stage(const model::Robot& robot, const verdict::Assessment& solved) {
  StageJudgement judged = stage_judgement_of(robot, solved);
  judged.load_ratio_high = plan::judgement_of(solved).load_ratio_high;
  return judged;
}

/// The robot at the largest of a run.
RobotState largest_of(const RobotState& before, std::span<const model::Step> steps, Sense sense) {
  RobotState robot = before;
  for (const model::Step& step : steps) {
    if (sense == Sense::kGrowing) {
      apply(step, find_transition(robot, step).value(), robot);
    }
  }
  return robot;
}

}  // namespace

struct CertifiedRun::Parts {
  Parts(model::RobotSpec whole, model::Robot robot, Sense way, Growth grown,
        const solver::EquilibriumOptions& options)
      : spec(std::move(whole)),
        target(std::move(robot)),
        sense(way),
        growth(std::move(grown)),
        run_judge(spec, target, options.thread_count, options) {}

  std::vector<StageJudgement> judge_batches(std::size_t first, std::size_t end);

  model::RobotSpec spec;  ///< Of the largest robot; its modules are the elements.
  model::Robot target;
  Sense sense;
  Growth growth;
  RunJudge run_judge;
  ElementSet state{0};  ///< Before the batch that is judged next.
};

std::vector<GrowthRun> find_growth_runs(std::span<const model::Step> steps) {
  std::vector<GrowthRun> runs;
  for (std::size_t begin = 0; begin < steps.size();) {
    const auto sense = sense_of(steps[begin]);
    std::size_t end = begin + 1;
    while (sense && end < steps.size() && sense_of(steps[end]) == sense) {
      ++end;
    }
    if (sense && end - begin >= kStepMin) {
      runs.push_back({.begin = begin, .end = end, .sense = *sense});
    }
    begin = end;
  }
  return runs;
}

CertifiedRun::CertifiedRun(std::unique_ptr<Parts> parts) : parts_(std::move(parts)) {}

CertifiedRun::~CertifiedRun() = default;

std::unique_ptr<CertifiedRun> CertifiedRun::make(const RobotState& before,
                                                 std::span<const model::Step> steps, Sense sense,
                                                 std::size_t solved_count_max,
                                                 const solver::EquilibriumOptions& options) {
  const RobotState largest = largest_of(before, steps, sense);
  if (largest.module_count() <= solved_count_max) {
    return nullptr;
  }
  model::RobotSpec spec = largest.spec();
  auto target = model::Robot::create(spec, options.thread_count);
  if (!target || needs_own_solution(target.value())) {
    return nullptr;
  }
  auto growth = find_growth(spec, target.value(), steps, sense);
  if (!growth || !model::Robot::create(part_of(spec, growth->begin), options.thread_count)) {
    return nullptr;
  }
  return std::unique_ptr<CertifiedRun>(new CertifiedRun(std::make_unique<Parts>(
      std::move(spec), std::move(target).value(), sense, *std::move(growth), options)));
}

/// The judgements after some batches, from the state that was reached.
std::vector<StageJudgement> CertifiedRun::Parts::judge_batches(std::size_t first, std::size_t end) {
  const std::size_t begin = first == 0 ? 0 : growth.ends[first - 1];
  const std::span run = std::span(growth.order).subspan(begin, growth.ends[end - 1] - begin);
  std::vector<StageJudgement> judged(end - first);
  const auto batch_of = [&](std::size_t place) {
    return static_cast<std::size_t>(std::ranges::upper_bound(growth.ends, begin + place) -
                                    growth.ends.begin());
  };
  const auto judgements = run_judge.judge(
      state, Sense::kGrowing, run,
      {.is_late = [] { return false; },
       .goes_on = true,
       .is_asked =
           [&](std::size_t place) { return growth.ends[batch_of(place)] == begin + place + 1; },
       .take_solved =
           [&](std::size_t place, const model::Robot& robot, const verdict::Assessment& solved) {
             judged[batch_of(place) - first] = solved_stage(robot, solved);
           }});
  for (std::size_t i = first; i < end; ++i) {
    const Judgement& judgement = judgements[growth.ends[i] - begin - 1];
    if (judgement.is_bound) {
      static_cast<Judgement&>(judged[i - first]) = judgement;
    }
  }
  state = changed(std::move(state), Sense::kGrowing, run);
  return judged;
}

std::vector<StageJudgement> CertifiedRun::judge(
    const std::function<bool(std::span<const StageJudgement>)>& goes_on) {
  Parts& all = *parts_;
  all.state = all.growth.begin;
  const model::Robot first = model::Robot::create(part_of(all.spec, all.state), 1).value();
  std::vector<StageJudgement> judged = {solved_stage(first, all.run_judge.assess(all.state))};
  const std::size_t count = all.growth.ends.size();
  while (judged.size() <= count && (judged.size() == 1 || goes_on(judged))) {
    const std::size_t begin = judged.size() - 1;
    const std::size_t elements = begin == 0 ? 0 : all.growth.ends[begin - 1];
    const auto last = std::ranges::upper_bound(all.growth.ends, elements + RunJudge::kRunLength);
    const auto end =
        std::max<std::size_t>(begin + 1, static_cast<std::size_t>(last - all.growth.ends.begin()));
    std::ranges::move(all.judge_batches(begin, end), std::back_inserter(judged));
  }
  if (all.sense == Sense::kShrinking) {
    std::ranges::reverse(judged);
  }
  return judged;
}

}  // namespace holdfast::plan
