// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "holdfast/plan/sequence.hpp"

#include <algorithm>
#include <atomic>
#include <limits>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <utility>

#include "holdfast/host/team.hpp"
#include "judges/certified_run.hpp"
#include "judges/stage_judge.hpp"

namespace holdfast::plan {
namespace {

using verdict::Verdict;

/// States are kept so many times along a sequence, for threads to begin with.
constexpr std::size_t kKeptStateMax = 64;

bool is_unsafe(const StepJudgement& step) {
  return std::ranges::any_of(
      step.stages, [](const StageJudgement& stage) { return plan::is_unsafe(stage.verdict); });
}

base::Error in_step(const base::Error& error, std::size_t step) {
  return {.code = error.code,
          .message = "step " + std::to_string(step) + ", " + error.message,
          .where = std::to_string(step)};
}

/// A core that fewer steps have in common does not pay.
constexpr std::size_t kSharingMin = 3;

/// Whether the second step moves what the first one has moved, and nothing else.
bool goes_on(const model::Step& first, const model::Step& second) {
  const auto is_move_alone = [](const model::Step& step) {
    return step.attach.empty() && step.detach.empty() && step.release.empty() &&
           step.connect.empty();
  };
  return is_move_alone(first) && is_move_alone(second) &&
         std::ranges::equal(first.moves, second.moves, {}, &model::Move::to, &model::Move::from);
}

/// Whether each step leaves the same modules where they are as others beside it.
std::vector<bool> sharing_steps(std::span<const model::Step> steps) {
  std::vector<bool> is_sharing(steps.size());
  for (std::size_t begin = 0; begin < steps.size();) {
    std::size_t end = begin + 1;
    while (end < steps.size() && goes_on(steps[end - 1], steps[end])) {
      ++end;
    }
    for (std::size_t i = begin; i < end; ++i) {
      is_sharing[i] = end - begin >= kSharingMin;
    }
    begin = end;
  }
  return is_sharing;
}

/// Goes through a sequence, in chunks that threads share.
class Run {
 public:
  Run(std::span<const model::Step> steps, const SequenceOptions& options)
      : steps_(steps),
        options_(options),
        is_sharing_(sharing_steps(steps)),
        judged_(steps.size()) {}

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
    const auto judge_all_of = [&](std::size_t first, std::size_t last) {
      team.share(first, last, [&](std::size_t begin, std::size_t end) { judge_range(begin, end); });
    };
    std::size_t begin = 0;
    for (const GrowthRun& run : growth_runs()) {
      const std::size_t judged_end = begin;
      if (!is_over(run.begin) && judge_growth(run, [&] { judge_all_of(judged_end, run.begin); })) {
        begin = run.end;
      }
    }
    judge_all_of(begin, steps_.size());
    if (error_ && !(options_.ends_when_unsafe && unsafe_ < error_step_)) {
      return *error_;
    }
    return sum_up();
  }

 private:
  static constexpr std::size_t kChunk = host::Team::kChunk;

  /// Takes a judge that is not in use; what it has kept of other steps serves again.
  std::unique_ptr<StageJudge> take_judge() {
    const std::lock_guard lock(mutex_);
    if (judges_.empty()) {
      return std::make_unique<StageJudge>(solver_);
    }
    auto judge = std::move(judges_.back());
    judges_.pop_back();
    return judge;
  }

  /// The robot before a step.
  RobotState robot_before(std::size_t step) const {
    RobotState robot = kept_[step / stride_];
    for (std::size_t i = step / stride_ * stride_; i < step; ++i) {
      apply(steps_[i], find_transition(robot, steps_[i]).value(), robot);
    }
    return robot;
  }

  std::vector<GrowthRun> growth_runs() const {
    return options_.solved_count_max == std::numeric_limits<std::size_t>::max() ||
                   options_.solver.is_bonded
               ? std::vector<GrowthRun>{}
               : find_growth_runs(steps_);
  }

  /// Judges a run by bounds, after what is before it. False if that cannot be; nothing is done
  /// then.
  bool judge_growth(const GrowthRun& run, const std::function<void()>& judge_before) {
    const auto steps = steps_.subspan(run.begin, run.end - run.begin);
    const auto certified = CertifiedRun::make(robot_before(run.begin), steps, run.sense,
                                              options_.solved_count_max, options_.solver);
    if (!certified) {
      return false;
    }
    judge_before();
    const bool is_growing = run.sense == Sense::kGrowing;
    auto judged = certified->judge([&](std::span<const StageJudgement> known) {
      if (options_.progress) {
        options_.progress(count_ + known.size() - 1);
      }
      return !is_growing || !options_.ends_when_unsafe ||
             std::ranges::none_of(known, plan::is_unsafe, &StageJudgement::verdict);
    });
    if (run.begin > 0) {
      judged.front() = judged_[run.begin - 1].stages[kStageCount - 1];
    }
    for (std::size_t i = 0; i + 1 < judged.size(); ++i) {
      const StageJudgement& after = judged[i + 1];
      const StageJudgement& shifted = is_growing ? judged[i] : after;
      judged_[run.begin + i] = {.stages = {judged[i], shifted, after}};
      if (is_unsafe(judged_[run.begin + i])) {
        unsafe_ = std::min(unsafe_.load(), run.begin + i);
      }
      ++count_;
    }
    return true;
  }

  void judge_range(std::size_t begin, std::size_t end) {
    std::unique_ptr<StageJudge> judge = take_judge();
    RobotState robot = robot_before(begin);
    for (std::size_t i = begin; i < end; ++i) {
      const Transition transition = find_transition(robot, steps_[i]).value();
      give_up_at(i);
      if (!is_over(i)) {
        // Chunks begin afresh, so that nothing depends on who does which.
        const bool is_first = (i - begin) % kChunk == 0;
        judge_one(*judge, i, robot, transition,
                  // Behind a step in any order it is that of all parts of it.
                  is_first || steps_[i - 1].is_any_order ? nullptr
                                                         : &judged_[i - 1].stages[kStageCount - 1]);
      }
      apply(steps_[i], transition, robot);
    }
    const std::lock_guard lock(mutex_);
    judges_.push_back(std::move(judge));
  }

  void judge_one(StageJudge& judge, std::size_t i, const RobotState& robot,
                 const Transition& transition, const StageJudgement* known) {
    auto judged = judge.judge(robot, steps_[i], transition, known, is_sharing_[i]);
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

  /// Leaves out step i and those behind it if the caller wants no more.
  void give_up_at(std::size_t i) {
    if (options_.is_interrupted && i < given_up_ && options_.is_interrupted()) {
      const std::lock_guard lock(mutex_);
      given_up_ = std::min(given_up_.load(), i);
    }
  }

  /// Whether a step behind `i` has decided already, or it is left out.
  bool is_over(std::size_t i) const {
    return error_step_ < i || given_up_ <= i || (options_.ends_when_unsafe && unsafe_ < i);
  }

  SequenceJudgement sum_up() {
    if (options_.ends_when_unsafe && unsafe_ < judged_.size()) {
      judged_.resize(unsafe_ + 1);
    }
    judged_.resize(std::min<std::size_t>(judged_.size(), given_up_));
    return plan::sum_up(std::move(judged_));
  }

  std::span<const model::Step> steps_;
  const SequenceOptions& options_;
  solver::EquilibriumOptions solver_;
  std::size_t stride_ = 1;  ///< Steps between states that are kept.
  std::vector<RobotState> kept_;
  std::vector<bool> is_sharing_;  ///< By step, see sharing_steps().
  std::vector<StepJudgement> judged_;
  std::vector<std::unique_ptr<StageJudge>> judges_;  ///< Those that are not in use.
  std::thread::id caller_;
  std::atomic<std::size_t> count_ = 0;
  std::atomic<std::size_t> given_up_ = std::numeric_limits<std::size_t>::max();
  std::atomic<std::size_t> unsafe_ = std::numeric_limits<std::size_t>::max();
  std::atomic<std::size_t> error_step_ = std::numeric_limits<std::size_t>::max();
  std::optional<base::Error> error_;
  std::mutex mutex_;
};

}  // namespace

SequenceJudgement sum_up(std::vector<StepJudgement> steps) {
  SequenceJudgement all;
  std::optional<double> bound;
  bool is_any_bound = false;
  all.steps = std::move(steps);
  for (std::size_t i = 0; i < all.steps.size(); ++i) {
    for (int k = 0; k < kStageCount; ++k) {
      const StageJudgement& stage = all.steps[i].stages[static_cast<std::size_t>(k)];
      const StageId id = {.step = i, .stage = static_cast<Stage>(k)};
      if (!all.first_unsafe && plan::is_unsafe(stage.verdict)) {
        all.first_unsafe = id;
      }
      if (!all.first_undecided && !all.first_unsafe && stage.verdict == Verdict::kUndecided) {
        all.first_undecided = id;
      }
      if (!stage.is_bound) {
        all.load_ratio_max = larger(all.load_ratio_max, stage.load_ratio_max);
      }
      is_any_bound = is_any_bound || stage.is_bound;
      bound = larger(bound, larger(stage.load_ratio_max, stage.load_ratio_high));
      all.margin_min_mm = smaller(all.margin_min_mm, stage.margin_mm);
    }
  }
  all.load_ratio_bound = is_any_bound ? bound : std::nullopt;
  return all;
}

Verdict SequenceJudgement::verdict() const {
  if (first_unsafe) {
    const StepJudgement& step = steps[first_unsafe->step];
    return step.stages[static_cast<std::size_t>(first_unsafe->stage)].verdict;
  }
  return first_undecided ? Verdict::kUndecided : Verdict::kSafe;
}

base::Result<StageJudgement> judge_stage(const RobotState& before, const model::Step& step,
                                         const Transition& transition, Stage stage,
                                         const solver::EquilibriumOptions& options) {
  return StageJudge(options).judge_stage(before, step, transition, stage);
}

base::Result<StepJudgement> judge_step(const RobotState& before, const model::Step& step,
                                       const solver::EquilibriumOptions& options) {
  const auto transition = find_transition(before, step);
  if (!transition) {
    return transition.error();
  }
  return StageJudge(options).judge(before, step, transition.value(), nullptr, false);
}

base::Result<SequenceJudgement> judge_sequence(const model::RobotSpec& start,
                                               std::span<const model::Step> steps,
                                               const SequenceOptions& options) {
  model::RobotSpec before = start;
  model::forget_absent_pairs(before);  // Of modules that come later.
  const auto robot = model::Robot::create(before, options.solver.thread_count);
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
