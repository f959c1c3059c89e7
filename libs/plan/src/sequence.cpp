// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "holdfast/plan/sequence.hpp"

#include <algorithm>
#include <atomic>
#include <limits>
#include <mutex>
#include <string>
#include <thread>
#include <utility>

#include "holdfast/host/team.hpp"

namespace holdfast::plan {
namespace {

using verdict::Verdict;

/// States are kept so many times along a sequence, for threads to begin with.
constexpr std::size_t kKeptStateMax = 64;

/// What is worse, the larger.
int severity(Verdict verdict) {
  switch (verdict) {
    case Verdict::kSafe:
      return 0;
    case Verdict::kUndecided:
      return 1;
    case Verdict::kOverload:
      return 2;
    case Verdict::kUnstable:
      break;
  }
  return 3;
}

bool is_unsafe(Verdict verdict) { return severity(verdict) >= severity(Verdict::kOverload); }

std::optional<double> larger(const std::optional<double>& a, const std::optional<double>& b) {
  return a && b ? std::max(*a, *b) : a ? a : b;
}

std::optional<double> smaller(const std::optional<double>& a, const std::optional<double>& b) {
  return a && b ? std::min(*a, *b) : a ? a : b;
}

/// Whether `b` is worse than `a`: by verdict, then by margin if they topple, else by load.
bool is_worse(const Judgement& a, const Judgement& b) {
  constexpr double kNone = std::numeric_limits<double>::infinity();
  if (a.verdict != b.verdict) {
    return severity(b.verdict) > severity(a.verdict);
  }
  return a.verdict == Verdict::kUnstable
             ? b.margin_mm.value_or(kNone) < a.margin_mm.value_or(kNone)
             : b.load_ratio_max.value_or(-kNone) > a.load_ratio_max.value_or(-kNone);
}

/// Takes over what is worse in `next`, and the extremes of both.
void add(StageJudgement& stage, StageJudgement next) {
  const auto ratio = larger(stage.load_ratio_max, next.load_ratio_max);
  const auto margin = smaller(stage.margin_mm, next.margin_mm);
  const bool is_worst_connection = next.worst && (!stage.worst || ratio != stage.load_ratio_max);
  const auto worst = is_worst_connection ? next.worst : stage.worst;
  if (is_worse(stage, next)) {
    stage = std::move(next);
  }
  stage.load_ratio_max = ratio;
  stage.margin_mm = margin;
  stage.worst = worst;
}

StageJudgement judgement_of(const model::Robot& robot, const verdict::Assessment& assessment) {
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

base::Result<StageJudgement> judge_piece(const model::RobotSpec& spec,
                                         const solver::EquilibriumOptions& options) {
  const auto robot = model::Robot::create(spec, options.thread_count);
  if (!robot) {
    return robot.error();
  }
  return judgement_of(robot.value(), assess(robot.value(), options));
}

/// The connection between a group and its carrier, which no equilibrium knows.
void add_hanging(const Hanging& hanging, StageJudgement& judged) {
  const bool breaks = verdict::breaks(hanging.load_ratio);
  const bool is_worst = hanging.load_ratio > judged.load_ratio_max.value_or(0);
  const StageReason reason = {.reason = {.code = breaks ? verdict::ReasonCode::kCarrierBreaks
                                                        : verdict::ReasonCode::kCarrierHolds,
                                         .numbers = {hanging.load_ratio}},
                              .cells = {hanging.carrier, hanging.module}};
  if (breaks && severity(judged.verdict) < severity(Verdict::kOverload)) {
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

base::Result<StageJudgement> judge_scene(const Scene& scene,
                                         const solver::EquilibriumOptions& options) {
  std::optional<StageJudgement> judged;
  for (const model::RobotSpec& spec : scene.pieces) {
    auto piece = judge_piece(spec, options);
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

base::Result<StageJudgement> judge_stage(const RobotState& before, const model::Step& step,
                                         const Transition& transition, Stage stage,
                                         const solver::EquilibriumOptions& options) {
  const auto scenes = find_scenes(before, step, transition, stage);
  if (!scenes) {
    return scenes.error();
  }
  std::optional<StageJudgement> judged;
  for (const Scene& scene : scenes.value()) {
    auto next = judge_scene(scene, options);
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

/// Whether nothing lets go in the first stage: it is then the last stage of the step before.
bool is_unchanged(const RobotState& before, const model::Step& step, const Transition& transition) {
  return step.release.empty() && std::ranges::all_of(transition.groups, [&](const Group& group) {
           return let_go(before, group).empty();
         });
}

/// A step with what its first stage is known to be, if it is.
base::Result<StepJudgement> judge(const RobotState& before, const model::Step& step,
                                  const Transition& transition, const StageJudgement* known,
                                  const solver::EquilibriumOptions& options) {
  StepJudgement judged;
  for (int i = 0; i < kStageCount; ++i) {
    StageJudgement& here = judged.stages[static_cast<std::size_t>(i)];
    const auto stage = static_cast<Stage>(i);
    if (stage == Stage::kRelease && known != nullptr && is_unchanged(before, step, transition)) {
      here = *known;
      continue;
    }
    auto found = judge_stage(before, step, transition, stage, options);
    if (!found) {
      return found.error();
    }
    here = std::move(found).value();
  }
  return judged;
}

bool is_unsafe(const StepJudgement& step) {
  return std::ranges::any_of(step.stages,
                             [](const StageJudgement& stage) { return is_unsafe(stage.verdict); });
}

base::Error in_step(const base::Error& error, std::size_t step) {
  return {.code = error.code,
          .message = "step " + std::to_string(step) + ", " + error.message,
          .where = std::to_string(step)};
}

/// Goes through a sequence, in chunks that threads share.
class Run {
 public:
  Run(std::span<const model::Step> steps, const SequenceOptions& options)
      : steps_(steps), options_(options), judged_(steps.size()) {}

  /// Does all steps without judging them. Keeps some states. Returns what is wrong with the first
  /// that cannot be done.
  std::optional<base::Error> rehearse(const RobotState& start) {
    const std::size_t chunk_count = (steps_.size() + kChunk - 1) / kChunk;
    stride_ = kChunk * std::max<std::size_t>(1, (chunk_count + kKeptStateMax - 1) / kKeptStateMax);
    RobotState robot = start;
    for (std::size_t i = 0; i < steps_.size(); ++i) {
      if (i % stride_ == 0) {
        kept_.push_back(robot);
      }
      const auto transition = find_transition(robot, steps_[i]);
      if (!transition) {
        return in_step(transition.error(), i);
      }
      apply(steps_[i], transition.value(), robot);
    }
    return std::nullopt;
  }

  base::Result<SequenceJudgement> judge_all() {
    const bool is_shared = steps_.size() > kChunk * host::Team::kSharedChunkMin;
    solver_ = options_.solver;
    solver_.thread_count = is_shared ? 1 : options_.solver.thread_count;
    host::Team team(is_shared ? options_.solver.thread_count : 1);
    caller_ = std::this_thread::get_id();
    team.share(0, steps_.size(),
               [&](std::size_t begin, std::size_t end) { judge_range(begin, end); });
    if (error_ && !(options_.ends_when_unsafe && unsafe_ < error_step_)) {
      return *error_;
    }
    return sum_up();
  }

 private:
  static constexpr std::size_t kChunk = host::Team::kChunk;

  void judge_range(std::size_t begin, std::size_t end) {
    RobotState robot = kept_[begin / stride_];
    for (std::size_t i = begin / stride_ * stride_; i < begin; ++i) {
      apply(steps_[i], find_transition(robot, steps_[i]).value(), robot);
    }
    for (std::size_t i = begin; i < end; ++i) {
      const Transition transition = find_transition(robot, steps_[i]).value();
      if (!is_over(i)) {
        // Chunks begin afresh, so that nothing depends on who does which.
        const bool is_first = (i - begin) % kChunk == 0;
        judge_one(i, robot, transition,
                  is_first ? nullptr : &judged_[i - 1].stages[kStageCount - 1]);
      }
      apply(steps_[i], transition, robot);
    }
  }

  void judge_one(std::size_t i, const RobotState& robot, const Transition& transition,
                 const StageJudgement* known) {
    auto judged = judge(robot, steps_[i], transition, known, solver_);
    if (!judged) {
      const std::lock_guard lock(mutex_);
      if (i < error_step_) {
        error_step_ = i;
        error_ = in_step(judged.error(), i);
      }
      return;
    }
    judged_[i] = std::move(judged).value();
    if (is_unsafe(judged_[i])) {
      const std::lock_guard lock(mutex_);
      unsafe_ = std::min(unsafe_.load(), i);
    }
    ++count_;
    if (options_.progress && std::this_thread::get_id() == caller_) {
      options_.progress(count_);
    }
  }

  /// Whether a step behind `i` has decided already.
  bool is_over(std::size_t i) const {
    return error_step_ < i || (options_.ends_when_unsafe && unsafe_ < i);
  }

  SequenceJudgement sum_up() {
    SequenceJudgement all;
    all.steps = std::move(judged_);
    if (options_.ends_when_unsafe && unsafe_ < all.steps.size()) {
      all.steps.resize(unsafe_ + 1);
    }
    for (std::size_t i = 0; i < all.steps.size(); ++i) {
      for (int k = 0; k < kStageCount; ++k) {
        const StageJudgement& stage = all.steps[i].stages[static_cast<std::size_t>(k)];
        const StageId id = {.step = i, .stage = static_cast<Stage>(k)};
        if (!all.first_unsafe && is_unsafe(stage.verdict)) {
          all.first_unsafe = id;
        }
        if (!all.first_undecided && !all.first_unsafe && stage.verdict == Verdict::kUndecided) {
          all.first_undecided = id;
        }
        all.load_ratio_max = larger(all.load_ratio_max, stage.load_ratio_max);
        all.margin_min_mm = smaller(all.margin_min_mm, stage.margin_mm);
      }
    }
    return all;
  }

  std::span<const model::Step> steps_;
  const SequenceOptions& options_;
  solver::EquilibriumOptions solver_;
  std::size_t stride_ = 1;  ///< Steps between states that are kept.
  std::vector<RobotState> kept_;
  std::vector<StepJudgement> judged_;
  std::thread::id caller_;
  std::atomic<std::size_t> count_ = 0;
  std::atomic<std::size_t> unsafe_ = std::numeric_limits<std::size_t>::max();
  std::atomic<std::size_t> error_step_ = std::numeric_limits<std::size_t>::max();
  std::optional<base::Error> error_;
  std::mutex mutex_;
};

}  // namespace

Verdict SequenceJudgement::verdict() const {
  if (first_unsafe) {
    const StepJudgement& step = steps[first_unsafe->step];
    return step.stages[static_cast<std::size_t>(first_unsafe->stage)].verdict;
  }
  return first_undecided ? Verdict::kUndecided : Verdict::kSafe;
}

base::Result<StepJudgement> judge_step(const RobotState& before, const model::Step& step,
                                       const solver::EquilibriumOptions& options) {
  const auto transition = find_transition(before, step);
  if (!transition) {
    return transition.error();
  }
  return judge(before, step, transition.value(), nullptr, options);
}

base::Result<SequenceJudgement> judge_sequence(const model::RobotSpec& start,
                                               std::span<const model::Step> steps,
                                               const SequenceOptions& options) {
  const auto robot = model::Robot::create(start, options.solver.thread_count);
  if (!robot) {
    return robot.error();
  }
  Run run(steps, options);
  if (auto error = run.rehearse(RobotState(start))) {
    return *std::move(error);
  }
  return run.judge_all();
}

}  // namespace holdfast::plan
