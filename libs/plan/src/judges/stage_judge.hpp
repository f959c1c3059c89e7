// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>

#include "equilibria/core_response.hpp"
#include "holdfast/plan/sequence.hpp"

namespace holdfast::plan {

/// Whether a verdict is overload or unstable.
bool is_unsafe(verdict::Verdict verdict);

/// Whether `b` is worse than `a`: by verdict, then by margin if they topple, else by load.
bool is_worse(const Judgement& a, const Judgement& b);

/// What a stage is if it is this robot alone.
StageJudgement stage_judgement_of(const model::Robot& robot, const verdict::Assessment& assessment);

std::optional<double> larger(const std::optional<double>& a, const std::optional<double>& b);
std::optional<double> smaller(const std::optional<double>& a, const std::optional<double>& b);

/// What the judgements of all steps come to.
SequenceJudgement sum_up(std::vector<StepJudgement> steps);

/// Judges the stages of one step after another. What steps have in common, the modules that stay
/// where they are, is kept from one to the next; no answer depends on it.
class StageJudge {
 public:
  explicit StageJudge(solver::EquilibriumOptions options) : options_(std::move(options)) {
    options_.has_rigid_figures = false;
  }

  /// `known`: the last stage of the step before, if it was judged; the first stage is the same
  /// where nothing lets go. `shares_core`: other steps nearby leave the same modules where they
  /// are.
  base::Result<StepJudgement> judge(const RobotState& before, const model::Step& step,
                                    const Transition& transition, const StageJudgement* known,
                                    bool shares_core);

  base::Result<StageJudgement> judge_stage(const RobotState& before, const model::Step& step,
                                           const Transition& transition, Stage stage);

 private:
  /// Adds what the parts of a step in any order come to.
  std::optional<base::Error> add_parts(const RobotState& before, const model::Step& step,
                                       StepJudgement& judged);
  base::Result<StageJudgement> judge_scene(const Scene& scene);
  base::Result<StageJudgement> judge_piece(const model::RobotSpec& spec);
  std::optional<verdict::Assessment> assess_by_core(const model::Robot& robot);
  void take_core(const RobotState& before, const Transition& transition);

  solver::EquilibriumOptions options_;
  model::RobotSpec core_spec_;
  std::unique_ptr<CoreResponse> core_;  ///< Of core_spec_; none if it has none.
  bool is_core_in_use_ = false;
};

}  // namespace holdfast::plan
