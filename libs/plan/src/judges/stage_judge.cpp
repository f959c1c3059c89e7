// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "judges/stage_judge.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>

#include "judges/core_assessment.hpp"
#include "judges/stage_parts.hpp"
#include "own_solution.hpp"

namespace holdfast::plan {
namespace {

using verdict::Verdict;

/// Larger robots are left to multigrid.
constexpr std::size_t kCoreCountMax = 2000;

/// Takes over what is worse in `next`, and the extremes of both.
void add(StageJudgement& stage, StageJudgement next) {
  const auto ratio = plan::larger(stage.load_ratio_max, next.load_ratio_max);
  const auto margin = plan::smaller(stage.margin_mm, next.margin_mm);
  const bool is_worst_connection = next.worst && (!stage.worst || ratio != stage.load_ratio_max);
  const auto worst = is_worst_connection ? next.worst : stage.worst;
  if (is_worse(stage, next)) {
    stage = std::move(next);
  }
  stage.load_ratio_max = ratio;
  stage.margin_mm = margin;
  stage.worst = worst;
}

/// The connection between a group and its carrier, which no equilibrium knows.
void add_hanging(const Hanging& hanging, StageJudgement& judged) {
  const bool breaks = verdict::breaks(hanging.load_ratio);
  const bool is_worst = hanging.load_ratio > judged.load_ratio_max.value_or(0);
  StageReason reason;
  reason.reason.code =
      breaks ? verdict::ReasonCode::kCarrierBreaks : verdict::ReasonCode::kCarrierHolds;
  reason.reason.numbers = {hanging.load_ratio};
  reason.cells = {hanging.carrier, hanging.module};
  if (breaks && verdict::severity(judged.verdict) < verdict::severity(Verdict::kOverload)) {
    judged.verdict = Verdict::kOverload;
    judged.reasons.insert(judged.reasons.begin(), reason);
  } else if (breaks || is_worst) {
    judged.reasons.push_back(reason);
  }
  if (is_worst) {
    judged.worst = {hanging.carrier, hanging.module};
  }
  judged.load_ratio_max = larger(judged.load_ratio_max, hanging.load_ratio);
}

/// Whether a stage finds the robot as the stage before it has left it, the first one as the step
/// before.
bool is_unchanged(const RobotState& before, const model::Step& step, const Transition& transition,
                  Stage stage) {
  switch (stage) {
    case Stage::kRelease:
      return step.release.empty() &&
             std::ranges::all_of(transition.groups,
                                 [&](const Group& group) { return let_go(before, group).empty(); });
    case Stage::kShift:
      return transition.left.empty();
    case Stage::kConnect:
      break;
  }
  return transition.groups.empty() && step.attach.empty() && step.connect.empty();
}

/// Whether two robots with the same surroundings are the same.
bool is_same(const model::RobotSpec& a, const model::RobotSpec& b) {
  return a.existing == b.existing && a.fixed == b.fixed && a.released == b.released &&
         a.own_kinds == b.own_kinds && a.own_masses == b.own_masses &&
         a.own_connectors == b.own_connectors && a.payloads == b.payloads;
}

}  // namespace

bool is_worse(const Judgement& a, const Judgement& b) {
  constexpr double kNone = std::numeric_limits<double>::infinity();
  if (a.verdict != b.verdict) {
    return verdict::severity(b.verdict) > verdict::severity(a.verdict);
  }
  return a.verdict == Verdict::kUnstable
             ? b.margin_mm.value_or(kNone) < a.margin_mm.value_or(kNone)
             : b.load_ratio_max.value_or(-kNone) > a.load_ratio_max.value_or(-kNone);
}

bool is_unsafe(Verdict verdict) {
  return verdict::severity(verdict) >= verdict::severity(Verdict::kOverload);
}

StageJudgement stage_judgement_of(const model::Robot& robot,
                                  const verdict::Assessment& assessment) {
  StageJudgement judged;
  judged.verdict = assessment.verdict;
  judged.load_ratio_max = assessment.load_ratio_max;
  judged.margin_mm = assessment.simplified.margin_mm;
  for (const verdict::Reason& reason : assessment.reasons) {
    judged.reasons.push_back({reason, verdict::cells_of(robot, reason)});
  }
  if (assessment.worst) {
    const auto [a, b] = model::ends(robot, *assessment.worst);
    judged.worst = {a, b};
  }
  return judged;
}

std::optional<double> larger(const std::optional<double>& a, const std::optional<double>& b) {
  return a && b ? std::max(*a, *b) : a ? a : b;
}

std::optional<double> smaller(const std::optional<double>& a, const std::optional<double>& b) {
  return a && b ? std::min(*a, *b) : a ? a : b;
}

/// Makes ready for robots that have the modules which stay where they are.
void StageJudge::take_core(const RobotState& before, const Transition& transition) {
  std::vector<std::int32_t> staying;
  for (std::size_t i = 0; i < before.modules().size(); ++i) {
    const ModuleState& module = before.modules()[i];
    if (module.is_there &&
        std::ranges::find(transition.left, module.cell) == transition.left.end()) {
      staying.push_back(static_cast<std::int32_t>(i));
    }
  }
  is_core_in_use_ = staying.size() <= kCoreCountMax;
  model::RobotSpec spec = before.spec(staying);
  if (!is_core_in_use_ || is_same(spec, core_spec_)) {
    return;
  }
  auto robot = model::Robot::create(spec, options_.thread_count);
  // What bending does takes a solution of each robot by itself.
  const bool is_taken = robot && !needs_own_solution(robot.value());
  core_ = is_taken ? CoreResponse::make(std::move(robot).value(), options_) : nullptr;
  core_spec_ = std::move(spec);
}

std::optional<verdict::Assessment> StageJudge::assess_by_core(const model::Robot& robot) {
  if (!is_core_in_use_ || !core_) {
    return std::nullopt;
  }
  return plan::assess_by_core(*core_, robot, options_.thread_count);
}

base::Result<StageJudgement> StageJudge::judge_piece(const model::RobotSpec& spec) {
  const auto robot = model::Robot::create(spec, options_.thread_count);
  if (!robot) {
    return robot.error();
  }
  if (const auto assessment = assess_by_core(robot.value())) {
    return stage_judgement_of(robot.value(), *assessment);
  }
  return stage_judgement_of(robot.value(),
                            assess(robot.value(), as_checked(robot.value(), options_)));
}

base::Result<StageJudgement> StageJudge::judge_scene(const Scene& scene) {
  std::optional<StageJudgement> judged;
  for (const model::RobotSpec& spec : scene.pieces) {
    auto piece = judge_piece(spec);
    if (!piece) {
      return piece.error();
    }
    if (judged) {
      add(*judged, std::move(piece).value());
    } else {
      judged = std::move(piece).value();
    }
  }
  for (const Hanging& hanging : scene.hangings) {
    add_hanging(hanging, *judged);
  }
  if (scene.pieces.size() > 1) {
    judged->reasons.push_back({.reason = {.code = verdict::ReasonCode::kInPieces,
                                          .numbers = {static_cast<double>(scene.pieces.size())}},
                               .cells = {}});
  }
  judged->piece_count = scene.pieces.size();
  judged->waypoint = scene.waypoint;
  return *std::move(judged);
}

base::Result<StageJudgement> StageJudge::judge_stage(const RobotState& before,
                                                     const model::Step& step,
                                                     const Transition& transition, Stage stage) {
  const auto scenes = find_scenes(before, step, transition, stage);
  if (!scenes) {
    return scenes.error();
  }
  std::optional<StageJudgement> judged;
  for (const Scene& scene : scenes.value()) {
    auto next = judge_scene(scene);
    if (!next) {
      return base::Error{.code = next.error().code,
                         .message = std::string(name(stage)) + ": " + next.error().message,
                         .where = {}};
    }
    if (judged) {
      add(*judged, std::move(next).value());
    } else {
      judged = std::move(next).value();
    }
  }
  judged->waypoint_count = stage == Stage::kShift ? transition.waypoint_count() : 0;
  return *std::move(judged);
}

base::Result<StepJudgement> StageJudge::judge(const RobotState& before, const model::Step& step,
                                              const Transition& transition,
                                              const StageJudgement* known, bool shares_core) {
  is_core_in_use_ = false;
  if (shares_core) {
    take_core(before, transition);
  }
  StepJudgement judged;
  for (int i = 0; i < kStageCount; ++i) {
    StageJudgement& here = judged.stages[static_cast<std::size_t>(i)];
    const auto stage = static_cast<Stage>(i);
    if (known != nullptr && is_unchanged(before, step, transition, stage)) {
      here = *known;
      known = &here;
      continue;
    }
    auto found = judge_stage(before, step, transition, stage);
    if (!found) {
      return found.error();
    }
    here = std::move(found).value();
    known = &here;
  }
  const bool has_parts = step.is_any_order && step.attach.size() + step.detach.size() > 1;
  const auto error = has_parts ? add_parts(before, step, judged) : std::nullopt;
  return error ? base::Result<StepJudgement>(*error) : judged;
}

std::optional<base::Error> StageJudge::add_parts(const RobotState& before, const model::Step& step,
                                                 StepJudgement& judged) {
  const Stage stage = stage_of_parts(step);
  const auto parts = judge_parts(
      before, step, options_, [&](const model::Step& part) -> base::Result<StageJudgement> {
        const auto transition = find_transition(before, part);
        return transition ? judge_stage(before, part, transition.value(), stage)
                          : transition.error();
      });
  if (!parts) {
    return parts.error();
  }
  StageJudgement& all = judged.stages[static_cast<std::size_t>(stage)];
  if (!parts.value().is_bound) {
    add(all, parts.value());
    return std::nullopt;
  }
  all.is_bound = all.is_safe();  // What breaks does so by load ratios that are known.
  if (all.is_bound) {
    all.load_ratio_max = larger(all.load_ratio_max, parts.value().load_ratio_max);
    all.load_ratio_high = all.load_ratio_max;
    all.worst.reset();
  }
  all.margin_mm = smaller(all.margin_mm, parts.value().margin_mm);
  return std::nullopt;
}

}  // namespace holdfast::plan
