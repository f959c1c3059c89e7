// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <unordered_set>

#include "holdfast/plan/move_plan.hpp"
#include "judges/stage_judge.hpp"
#include "moves/shape.hpp"
#include "patience.hpp"

namespace holdfast::plan {

/// Says which moves are safe, and keeps count of them and of time.
class MoveJudge {
 public:
  /// Keeps references.
  MoveJudge(const MoveTask& task, const MoveOptions& options);

  /// Whether a move from a robot of one shape to another shape is safe at every stage.
  bool is_safe(const RobotState& before, const model::Move& move, const Shape& after);

  /// The judgement of a move if it is safe at every stage. `known`: that of the move before, by
  /// which the same module came. Moves of one module after another share the solution of the rest.
  std::optional<StepJudgement> judge_move(const RobotState& before, const model::Move& move,
                                          const StepJudgement* known);

  bool ignores_mechanics() const { return task_.ignores_mechanics; }

  /// Counts moves that were examined elsewhere.
  void count_unjudged(std::size_t count) { count_ += count; }

  /// Whether time, states or patience have run out.
  bool is_over() const;

  std::size_t count() const { return count_; }

  /// How many moves were not safe because a stage was undecided: they may be safe in truth, so
  /// that nothing is proved by their being barred.
  std::size_t undecided_count() const { return undecided_count_; }

  /// Reports how far the nearest shape is to MoveOptions::progress.
  void report(int distance) const;

 private:
  /// A stage that cannot be is unstable.
  verdict::Verdict judge(const RobotState& before, const model::Step& step,
                         const Transition& transition, Stage stage) const;

  const MoveTask& task_;
  const MoveOptions& options_;
  Patience patience_{options_.seconds_max, options_.is_interrupted};
  StageJudge stage_judge_;
  std::size_t count_ = 0;
  std::size_t undecided_count_ = 0;
  std::unordered_set<Shape, ShapeHash> unsafe_;  ///< Even when all is connected.
};

/// The move that takes another one back.
inline model::Move back(const model::Move& move) {
  return {.from = move.to, .to = move.from, .carrier = move.carrier};
}

/// One move as a step.
inline model::Step step_of(const model::Move& move) {
  model::Step step;
  step.moves = {move};
  return step;
}

}  // namespace holdfast::plan
