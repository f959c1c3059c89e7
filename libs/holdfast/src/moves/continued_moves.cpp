// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
//
// A plan of moves is a chain of shapes. The last of its steps are kept, and moves to the shape
// before them are sought anew.
#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <utility>

#include "holdfast/plan/sequence.hpp"
#include "moves/move_task.hpp"
#include "plan_tail.hpp"

namespace holdfast {
namespace {

using base::Cell;

/// What leads to a tail of the plan is sought by so many moves.
constexpr std::size_t kTriedMovesMax = 2000;

/// What is left to do of a plan of moves.
struct MoveRest {
  io::Document now;                ///< The robot as it is.
  io::Document start;              ///< And as it was before the plan,
  std::vector<model::Step> steps;  ///< all steps of which lead
  io::Document target;             ///< here.
  std::size_t begin = 0;           ///< Steps before this one are not looked at.
};

base::Result<std::vector<model::Step>> steps_of(const io::Document& plan) {
  auto sequence = io::make_sequence(plan);
  if (!sequence) {
    return error_of_plan(sequence.error().message);
  }
  std::vector<model::Step> steps = std::move(sequence).value().steps;
  if (steps.empty()) {
    return error_of_plan("it has no steps; expected a plan that holdfast move -o has written");
  }
  for (std::size_t i = 0; i < steps.size(); ++i) {
    const model::Step& step = steps[i];
    if (step.moves.size() != 1 || !step.attach.empty() || !step.detach.empty() ||
        !step.release.empty() || !step.connect.empty()) {
      return error_of_plan(
          fmt::format("step {} does something else than to move one module; expected a plan that "
                      "holdfast move -o has written",
                      i));
    }
  }
  return steps;
}

/// The step before which, as the plan has it, the fewest modules are elsewhere; the last such step.
std::size_t nearest_step(const MoveRest& rest) {
  std::set<Cell> now;
  std::set<Cell> planned;
  for (const io::ModuleEntry& module : rest.now.modules) {
    now.insert(module.cell);
  }
  for (const io::ModuleEntry& module : rest.start.modules) {
    planned.insert(module.cell);
  }
  const auto is_there = [&](const Cell& cell) { return planned.contains(cell); };
  auto common = static_cast<std::size_t>(std::ranges::count_if(now, is_there));
  std::size_t best = 0;
  std::size_t most = common;
  for (std::size_t i = 1; i <= rest.steps.size(); ++i) {
    const model::Move& move = rest.steps[i - 1].moves.front();
    common = common + (now.contains(move.to) ? 1 : 0) - (now.contains(move.from) ? 1 : 0);
    if (common >= most) {
      most = common;
      best = i;
    }
  }
  return best;
}

base::Result<MoveRest> read_rest(const io::Document& file, const io::Document& plan,
                                 std::optional<std::size_t> done_count) {
  auto steps = steps_of(plan);
  if (!steps) {
    return steps.error();
  }
  MoveRest rest{.now = file, .start = plan, .steps = std::move(steps).value(), .target = {}};
  rest.start.extension.plan.clear();
  const auto robot = io::standing_spec(file, "the robot");
  if (!robot) {
    return robot.error();
  }
  const auto planned = io::make_spec(rest.start);
  if (!planned) {
    return error_of_plan(planned.error().message);
  }
  const auto names = done_count ? plan::differences_of_targets(robot.value(), planned.value())
                                : plan::differences_of_surroundings(robot.value(), planned.value());
  if (!names.empty()) {
    return error_of_plan(
        fmt::format("it is a plan of another robot: they differ in {}", fmt::join(names, ", ")));
  }
  auto target = io::after_moves(rest.start, rest.steps);
  if (!target) {
    return error_of_plan(target.error().message);
  }
  rest.target = std::move(target).value();
  if (!done_count) {
    rest.begin = nearest_step(rest);
    return rest;
  }
  if (*done_count > rest.steps.size()) {
    return error_of_done_steps(rest.steps.size(), *done_count);
  }
  rest.begin = *done_count;
  rest.now = io::after_moves(file, std::span(rest.steps).first(*done_count)).value();
  return rest;
}

/// One search for one continuation.
class Moving final : public PlanTail {
 public:
  Moving(MoveRest rest, plan::MoveTask task, const MoveRequest& request)
      : rest_(std::move(rest)),
        task_(std::move(task)),
        request_(request),
        time_(request.seconds_max, request.is_interrupted) {
    allowed_ = plan::allowed_steps(task_, io::make_spec(rest_.start).value(), rest_.steps);
  }

  base::Result<io::MoveReport> run() {
    plan::MoveOptions options = move_options(request_);
    options.state_count_max = 0;
    auto bounds = plan::find_moves(task_, options);
    if (!bounds) {
      return io::with_other_lattice(bounds.error(), rest_.now);
    }
    bounds_ = std::move(bounds).value();
    if (bounds_.outcome != plan::MoveOutcome::kNotFound) {
      return report(std::move(bounds_), 0);
    }
    const auto kept = judge_tail(
        *this, rest_.begin,
        {.solver = options.solver, .is_interrupted = [this] { return time_.is_over(); }});
    if (!kept) {
      return kept.error();
    }
    std::optional<io::MoveReport> found;
    lead_to_tail(
        kept.value().first, step_count(), [this] { return time_.is_over(); },
        [&](std::size_t first) {
          found = lead_to(first);
          return found.has_value();
        });
    return found ? *std::move(found) : anew();
  }

  std::size_t step_count() const override { return rest_.steps.size(); }

  base::Result<io::Sequence> steps_from(std::size_t first) const override {
    const std::span<const model::Step> steps(rest_.steps);
    const auto start = io::make_spec(before(first));
    if (!start) {
      return start.error();
    }
    return io::Sequence{.start = start.value(),
                        .steps = {steps.begin() + static_cast<std::ptrdiff_t>(first), steps.end()}};
  }

  bool is_allowed(std::size_t step) const override { return allowed_[step]; }

 private:
  /// The robot of the plan before a step.
  io::Document before(std::size_t step) const {
    return io::after_moves(rest_.start, std::span(rest_.steps).first(step)).value();
  }

  /// Moves to the tail that begins with a step, and the tail; none if none are found.
  std::optional<io::MoveReport> lead_to(std::size_t first) const {
    plan::MoveTask task = task_;
    const auto target = io::make_spec(before(first));
    if (!target) {
      return std::nullopt;
    }
    task.target = target.value();
    plan::MoveOptions options = move_options(request_);
    options.seconds_max = time_.seconds_left() / 2;
    options.state_count_max = kTriedMovesMax;
    auto found = plan::find_moves(task, options);
    if (!found || found.value().outcome != plan::MoveOutcome::kFound) {
      return std::nullopt;
    }
    plan::MovePlan whole = std::move(found).value();
    whole.steps.insert(whole.steps.end(), rest_.steps.begin() + static_cast<std::ptrdiff_t>(first),
                       rest_.steps.end());
    auto judged = plan::judge_sequence(task_.start, whole.steps, {.solver = options.solver});
    if (!judged || judged.value().verdict() != verdict::Verdict::kSafe) {
      return std::nullopt;
    }
    const auto length = static_cast<int>(whole.steps.size());
    whole.judgement = std::move(judged).value();
    whole.assignment_bound = bounds_.assignment_bound;
    whole.length_min = std::min(length, bounds_.length_min);
    whole.is_shortest = whole.length_min == length;
    return report(std::move(whole), step_count() - first);
  }

  /// Moves to the target, whatever the plan says.
  base::Result<io::MoveReport> anew() const {
    plan::MoveOptions options = move_options(request_);
    options.seconds_max = time_.seconds_left();
    auto found = plan::find_moves(task_, options);
    if (!found) {
      return found.error();
    }
    return report(std::move(found).value(), 0);
  }

  io::MoveReport report(plan::MovePlan plan, std::size_t kept_count) const {
    return {.start = rest_.now,
            .task = task_,
            .plan = std::move(plan),
            .seconds = time_.seconds_passed(),
            .is_interrupted = time_.is_interrupted(),
            .kept_count = kept_count};
  }

  MoveRest rest_;
  plan::MoveTask task_;  ///< From the robot as it is to the plan's end.
  MoveRequest request_;
  PlanTime time_;
  std::vector<bool> allowed_;  ///< By step of the plan.
  plan::MovePlan bounds_;      ///< Of any plan for the task.
};

}  // namespace

base::Result<io::MoveReport> continue_moves(const io::Document& file, const io::Document& plan,
                                            std::optional<std::size_t> done_count,
                                            const MoveRequest& request) {
  if (request.ignores_mechanics) {
    return base::bad_input("a plan that is gone on with is safe: expected one by mechanics");
  }
  auto ends = with_one_factor(file, plan);
  if (!ends) {
    return ends.error();
  }
  auto rest = read_rest(ends.value().first, ends.value().second, done_count);
  if (!rest) {
    return rest.error();
  }
  auto task = task_of(rest.value().now, rest.value().target, request);
  if (!task) {
    return task.error();
  }
  return Moving(std::move(rest).value(), std::move(task).value(), request).run();
}

}  // namespace holdfast
