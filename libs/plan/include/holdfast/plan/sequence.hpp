// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "holdfast/plan/judgement.hpp"
#include "holdfast/plan/stages.hpp"

/// Is a sequence of steps safe at every stage?
namespace holdfast::plan {

/// A reason of a stage's verdict, with the cells that its indices mean, as they are in the stage:
/// the two ends of a connection, a module, or none.
struct StageReason {
  verdict::Reason reason;
  std::vector<base::Cell> cells;

  friend bool operator==(const StageReason&, const StageReason&) = default;
};

/// A stage of a step: the worst of its scenes and pieces. `load_ratio_max` is the largest and
/// `margin_mm` the smallest of all.
struct StageJudgement : Judgement {
  std::vector<StageReason> reasons;  ///< Of the scene and piece that the verdict is of.
  std::size_t waypoint = 0;          ///< Of the same; void in other stages than the shift.
  std::size_t waypoint_count = 0;    ///< 0 in other stages, and where nothing moves.
  std::size_t piece_count = 1;
  /// The connection with the largest load ratio; none if none is known to be pulled apart.
  std::optional<model::CellPair> worst;

  friend bool operator==(const StageJudgement&, const StageJudgement&) = default;
};

struct StepJudgement {
  std::array<StageJudgement, kStageCount> stages;  ///< By Stage.

  friend bool operator==(const StepJudgement&, const StepJudgement&) = default;
};

struct StageId {
  std::size_t step = 0;  ///< From 0.
  Stage stage = Stage::kRelease;

  friend bool operator==(const StageId&, const StageId&) = default;
};

struct SequenceOptions {
  solver::EquilibriumOptions solver =
      {};                         ///< Of each check; its threads are those of the sequence.
  bool ends_when_unsafe = false;  ///< Steps behind the first unsafe one are left out.
  /// Robots that come to have more modules than this may be certified by a bound in runs of steps
  /// that only attach, or only detach, instead of being solved (Judgement::is_bound).
  std::size_t solved_count_max = std::numeric_limits<std::size_t>::max();
  /// Called between steps, with how many are judged; from the thread that called.
  std::function<void(std::size_t judged_count)> progress = {};
  /// Asked before each step, by any thread; true leaves out that step and those behind it.
  std::function<bool()> is_interrupted = {};
};

struct SequenceJudgement {
  std::vector<StepJudgement> steps;  ///< In their order; fewer than given if it was to end early.
  std::optional<StageId> first_unsafe;     ///< The first that is overloaded or unstable.
  std::optional<StageId> first_undecided;  ///< Of those before it, or of all.
  std::optional<double> load_ratio_max;    ///< Over all stages that were solved.
  /// What no stage exceeds, errors of certified states included; none if all were solved.
  std::optional<double> load_ratio_bound = {};
  std::optional<double> margin_min_mm;

  /// kSafe, kUndecided, or that of the first unsafe stage.
  verdict::Verdict verdict() const;
};

/// Judges one stage of a step on a robot, and of its transition. Errors: as of find_scenes(), or of
/// model::Robot::create(), each beginning with the stage.
base::Result<StageJudgement> judge_stage(const RobotState& before, const model::Step& step,
                                         const Transition& transition, Stage stage,
                                         const solver::EquilibriumOptions& options = {});

/// Judges one step, see Stage. Errors: as of find_transition() and find_scenes(), or of
/// model::Robot::create(), each beginning with its stage.
base::Result<StepJudgement> judge_step(const RobotState& before, const model::Step& step,
                                       const solver::EquilibriumOptions& options = {});

/// Judges steps one after another. Errors: as of judge_step(), and which step it is: Error::where
/// is its number. The result does not depend on the number of threads.
base::Result<SequenceJudgement> judge_sequence(const model::RobotSpec& start,
                                               std::span<const model::Step> steps,
                                               const SequenceOptions& options = {});

}  // namespace holdfast::plan
