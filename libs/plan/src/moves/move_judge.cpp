// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "moves/move_judge.hpp"

namespace holdfast::plan {

MoveJudge::MoveJudge(const MoveTask& task, const MoveOptions& options)
    : task_(task), options_(options), stage_judge_(options.solver) {}

bool MoveJudge::is_safe(const RobotState& before, const model::Move& move, const Shape& after) {
  if (unsafe_.contains(after)) {
    return false;
  }
  ++count_;
  const model::Step step = step_of(move);
  const auto transition = find_transition(before, step);
  if (!transition) {
    return false;
  }
  for (const Stage stage : {Stage::kConnect, Stage::kRelease, Stage::kShift}) {
    const verdict::Verdict verdict = judge(before, step, transition.value(), stage);
    if (verdict != verdict::Verdict::kSafe) {
      undecided_count_ += verdict == verdict::Verdict::kUndecided ? 1 : 0;
      if (stage == Stage::kConnect) {
        unsafe_.insert(after);
      }
      return false;
    }
  }
  return true;
}

verdict::Verdict MoveJudge::judge(const RobotState& before, const model::Step& step,
                                  const Transition& transition, Stage stage) const {
  if (task_.ignores_mechanics) {
    return find_scenes(before, step, transition, stage) ? verdict::Verdict::kSafe
                                                        : verdict::Verdict::kUnstable;
  }
  const auto judged = judge_stage(before, step, transition, stage, options_.solver);
  return judged ? judged.value().verdict : verdict::Verdict::kUnstable;
}

std::optional<StepJudgement> MoveJudge::judge_move(const RobotState& before,
                                                   const model::Move& move,
                                                   const StepJudgement* known) {
  ++count_;
  const model::Step step = step_of(move);
  const auto transition = find_transition(before, step);
  if (!transition) {
    return std::nullopt;
  }
  auto judged = stage_judge_.judge(before, step, transition.value(),
                                   known != nullptr ? &known->stages.back() : nullptr, true);
  if (!judged) {
    return std::nullopt;
  }
  for (const StageJudgement& stage : judged.value().stages) {
    if (!stage.is_safe()) {
      undecided_count_ += stage.verdict == verdict::Verdict::kUndecided ? 1 : 0;
      return std::nullopt;
    }
  }
  return std::move(judged).value();
}

bool MoveJudge::is_over() const {
  return count_ >= options_.state_count_max || patience_.is_over();
}

void MoveJudge::report(int distance) const {
  if (options_.progress) {
    options_.progress(count_, distance);
  }
}

}  // namespace holdfast::plan
