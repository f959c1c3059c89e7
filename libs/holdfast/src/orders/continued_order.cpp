// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
//
// An order is a chain of growing sets, from what is there at first to the whole; who takes a robot
// apart goes along it backwards. The steps that are done last are kept, the upper part of the chain
// or, where the robot is taken apart, the lower one, and the rest is an order of its own.
#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "holdfast/model/cell_index.hpp"
#include "holdfast/plan/part_of.hpp"
#include "holdfast/plan/sequence.hpp"
#include "orders/order_options.hpp"
#include "orders/order_rest.hpp"
#include "plan_tail.hpp"

namespace holdfast {
namespace {

using base::Cell;

/// What leads to a tail of the plan is sought by so many states.
constexpr std::size_t kTriedStatesMax = 2000;

/// The state behind a step; of modules in any order, the worst of all parts.
plan::Judgement judged_of(const plan::StepJudgement& step, bool has_parts) {
  plan::Judgement worst = step.stages.back();
  for (const plan::StageJudgement& stage : step.stages) {
    worst = has_parts ? plan::both_of(worst, stage) : worst;
  }
  if (!worst.load_ratio_high) {
    worst.load_ratio_high = worst.load_ratio_max;  // It was solved.
  }
  return worst;
}

/// One search for one continuation.
class Continuation final : public PlanTail {
 public:
  Continuation(OrderRest rest, const OrderRequest& request)
      : rest_(std::move(rest)),
        request_(request),
        time_(request.seconds_max, request.is_interrupted) {
    request_.is_reversed = rest_.is_reversed;
    request_.stream = {};
  }

  base::Result<io::OrderReport> run();

  std::size_t step_count() const override { return steps_.size(); }

  base::Result<io::Sequence> steps_from(std::size_t first) const override;
  bool is_allowed(std::size_t step) const override;

 private:
  std::optional<base::Error> find_fault() const;
  std::optional<plan::Element> element_in(const Cell& cell) const;
  std::vector<Cell> cells_of(const std::vector<plan::Element>& elements) const;
  plan::ElementSet least_of_chain() const;
  void make_chain();
  base::Result<io::Document> tail_document(std::size_t first) const;
  std::optional<base::Error> judge_steps();
  std::optional<base::Result<io::OrderReport>> lead_to(std::size_t first) const;
  base::Result<io::OrderReport> search();
  base::Result<io::OrderReport> anew();
  base::Result<plan::RobotOrder> seek(std::size_t first) const;
  plan::RobotOrder joined(plan::RobotOrder found, std::size_t first) const;

  OrderRest rest_;
  OrderRequest request_;
  PlanTime time_;
  plan::OrderTask task_;
  model::CellIndex index_{0};  ///< Of the target's modules.
  std::optional<plan::ReachFinder> finder_;
  std::vector<plan::Batch> steps_;           ///< Of the plan, as far as they are left to do.
  bool is_any_order_ = false;                ///< Whether their modules come so.
  std::vector<plan::ElementSet> states_;     ///< Before each of them, and behind the last.
  std::vector<plan::Judgement> judgements_;  ///< Of the states behind each.
  std::size_t first_safe_ = 0;               ///< From this step on all are safe and have a way.
};

std::optional<plan::Element> Continuation::element_in(const Cell& cell) const {
  const std::int32_t found = index_.find(cell);
  return found == model::CellIndex::kNone ? std::optional<plan::Element>() : found;
}

std::vector<Cell> Continuation::cells_of(const std::vector<plan::Element>& elements) const {
  std::vector<Cell> cells;
  for (const plan::Element element : elements) {
    cells.push_back(task_.target.existing[static_cast<std::size_t>(element)]);
  }
  return cells;
}

std::optional<base::Error> Continuation::find_fault() const {
  for (const PlannedBatch& step : rest_.steps) {
    if (step.is_any_order && request_.group_size > 1) {
      return error_of_plan("its steps come in any order, which --group cannot go on with");
    }
    if (!step.is_any_order && step.cells.size() > 1 && request_.parallel_max > 1) {
      return error_of_plan(
          "modules of its steps arrive at the same instant, which --parallel cannot go on with");
    }
    if (step.cells.size() > 1 && is_any_order_ != step.is_any_order) {
      return error_of_plan(
          "modules of some steps come in any order, and of others at the same instant; expected a "
          "plan that holdfast order -o has written");
    }
  }
  for (const Cell& cell : rest_.start) {
    if (rest_.is_reversed && !element_in(cell)) {
      return error_of_plan(
          fmt::format("it leaves the module {}, which is not there", model::text(cell)));
    }
  }
  return std::nullopt;
}

/// What is there, and what the plan's steps build on; or what they leave.
plan::ElementSet Continuation::least_of_chain() const {
  std::set<Cell> coming;
  for (const PlannedBatch& step : rest_.steps) {
    coming.insert(step.cells.begin(), step.cells.end());
  }
  plan::ElementSet least(task_.target.existing.size());
  for (std::size_t i = 0; i < task_.target.existing.size(); ++i) {
    const Cell& cell = task_.target.existing[i];
    if (rest_.start.contains(cell) || (!rest_.is_reversed && !coming.contains(cell))) {
      least.insert(static_cast<plan::Element>(i));
    }
  }
  return least;
}

/// The states that the plan's steps lead through: modules that have come already do not come again,
/// and those that are gone do not go.
void Continuation::make_chain() {
  plan::ElementSet state = least_of_chain();
  states_ = {state};
  std::vector<PlannedBatch> growing = rest_.steps;
  if (rest_.is_reversed) {
    std::ranges::reverse(growing);
  }
  for (const PlannedBatch& step : growing) {
    plan::Batch batch;
    for (const Cell& cell : step.cells) {
      const auto element = element_in(cell);
      if (element && !state.contains(*element)) {
        state.insert(*element);
        batch.push_back(*element);
      }
    }
    if (!batch.empty()) {
      steps_.push_back(std::move(batch));
      states_.push_back(state);
    }
  }
  if (rest_.is_reversed) {
    std::ranges::reverse(steps_);
    std::ranges::reverse(states_);
  }
}

/// Whether the modules of a step get to their cells, or leave them.
bool Continuation::is_allowed(std::size_t step) const {
  plan::ElementSet state = states_[rest_.is_reversed ? step + 1 : step];
  const std::vector<Cell> cells = cells_of(steps_[step]);
  if (is_any_order_) {
    return finder_->can_reach_in_any_order(state, cells);
  }
  for (std::size_t i = 0; i < cells.size(); ++i) {
    if (!finder_->can_reach(state, cells[i])) {
      return false;
    }
    state.insert(steps_[step][i]);
  }
  return true;
}

/// The steps from one on, as a structure that holdfast steps judges.
base::Result<io::Document> Continuation::tail_document(std::size_t first) const {
  const plan::Order rest{
      .start = states_[first],
      .steps = {steps_.begin() + static_cast<std::ptrdiff_t>(first), steps_.end()},
      .is_any_order = is_any_order_};
  if (!rest_.is_reversed) {
    return io::order_steps(rest_.target, rest, false);
  }
  std::vector<Cell> gone;
  for (std::size_t i = 0; i < task_.target.existing.size(); ++i) {
    if (!states_[first].contains(static_cast<plan::Element>(i))) {
      gone.push_back(task_.target.existing[i]);
    }
  }
  io::Document document = io::without_modules(rest_.target, std::move(gone));
  for (const plan::Batch& batch : rest.steps) {
    model::Step& step = document.extension.plan.emplace_back();
    step.detach = cells_of(batch);
    step.is_any_order = is_any_order_ && batch.size() > 1;
  }
  return document;
}

base::Result<io::Sequence> Continuation::steps_from(std::size_t first) const {
  const auto document = tail_document(first);
  return document ? io::make_sequence(document.value())
                  : base::Result<io::Sequence>(document.error());
}

std::optional<base::Error> Continuation::judge_steps() {
  plan::SequenceOptions options;
  options.solver.thread_count = request_.thread_count;
  if (!request_.is_exact) {
    options.solved_count_max = plan::kExactModuleCount;
  }
  options.is_interrupted = [&] { return time_.is_over(); };
  const auto kept = judge_tail(*this, 0, options);
  if (!kept) {
    return kept.error();
  }
  first_safe_ = kept.value().first;
  judgements_.assign(first_safe_, {});
  for (const plan::StepJudgement& step : kept.value().judged) {
    const bool has_parts = is_any_order_ && steps_[judgements_.size()].size() > 1;
    judgements_.push_back(judged_of(step, has_parts));
  }
  return std::nullopt;
}

/// Seeks what leads from what is there to the steps from one on.
base::Result<plan::RobotOrder> Continuation::seek(std::size_t first) const {
  plan::OrderTask task = task_;
  if (rest_.is_reversed) {
    task.start = cells_of(states_[first].elements());
  } else {
    task.target = plan::part_of(task_.target, states_[first]);
  }
  OrderRequest request = request_;
  request.seconds_max = time_.seconds_left() / 2;
  plan::RobotOrderOptions options = order_options(request, task_.target.existing.size());
  options.state_count_max = kTriedStatesMax;
  return plan::find_robot_order(task, options);
}

/// The steps that were found and those that are kept, as one order.
plan::RobotOrder Continuation::joined(plan::RobotOrder found, std::size_t first) const {
  plan::Order& order = found.order;
  if (rest_.is_reversed) {
    order.start = states_.back();
  } else {
    const std::vector<plan::Element> elements = states_[first].elements();
    const auto of_whole = [&](plan::Element element) {
      return elements[static_cast<std::size_t>(element)];
    };
    for (plan::Batch& batch : order.steps) {
      std::ranges::transform(batch, batch.begin(), of_whole);
    }
    plan::ElementSet start(task_.target.existing.size());
    for (const plan::Element element : order.start.elements()) {
      start.insert(of_whole(element));
    }
    order.start = std::move(start);
  }
  for (std::size_t i = first; i < steps_.size(); ++i) {
    const bool is_front = rest_.is_reversed;
    order.steps.insert(is_front ? order.steps.begin() : order.steps.end(), steps_[i]);
    order.judgements.insert(is_front ? order.judgements.begin() : order.judgements.end(),
                            judgements_[i]);
  }
  order.is_any_order = order.is_any_order || is_any_order_;
  plan::take_extremes(found);
  const std::size_t count = task_.target.existing.size() - order.start.size();
  found.step_count_least = (count + task_.parallel_max - 1) / task_.parallel_max;
  return found;
}

base::Result<io::OrderReport> Continuation::run() {
  auto target = io::order_target(rest_.target);
  if (!target) {
    return target.error();
  }
  if (request_.in_pieces) {
    return base::bad_input("a plan that goes on keeps the robot in one piece");
  }
  for (const PlannedBatch& step : rest_.steps) {
    is_any_order_ = is_any_order_ || (step.is_any_order && step.cells.size() > 1);
    request_.parallel_max =
        std::max(request_.parallel_max, step.is_any_order ? step.cells.size() : 1);
  }
  if (rest_.is_reversed) {
    const auto kept = plan::kept_modules(request_.keep, target.value().existing);
    if (!kept) {
      return kept.error();
    }
    rest_.start.insert(kept.value().begin(), kept.value().end());
  }
  request_.start = {rest_.start.begin(), rest_.start.end()};
  auto task = order_task(std::move(target).value(), request_);
  if (!task) {
    return task.error();
  }
  task_ = std::move(task).value();
  task_.parallel_max = std::min(task_.parallel_max, task_.target.existing.size());
  index_ = model::CellIndex(task_.target.existing.size());
  for (std::size_t i = 0; i < task_.target.existing.size(); ++i) {
    index_.insert(task_.target.existing[i], static_cast<std::int32_t>(i));
  }
  if (auto fault = find_fault()) {
    return *std::move(fault);
  }
  make_chain();
  finder_.emplace(task_.target, task_.rule);
  if (auto fault = judge_steps()) {
    return *std::move(fault);
  }
  return search();
}

/// What leads to a tail, and the tail; an error of the start, which no other tail is without; or
/// nothing.
std::optional<base::Result<io::OrderReport>> Continuation::lead_to(std::size_t first) const {
  auto found = seek(first);
  if (!found && !rest_.is_reversed && found.error().where == plan::kAtStart) {
    return found.error();
  }
  if (!found || found.value().order.outcome != plan::OrderOutcome::kFound) {
    return std::nullopt;
  }
  io::OrderReport report{.target = rest_.target, .task = task_};
  report.result = joined(std::move(found).value(), first);
  report.is_reversed = rest_.is_reversed;
  report.seconds = time_.seconds_passed();
  report.kept_count = steps_.size() - first;
  return report;
}

base::Result<io::OrderReport> Continuation::search() {
  std::optional<base::Result<io::OrderReport>> found;
  lead_to_tail(
      first_safe_, steps_.size(), [this] { return time_.is_over(); },
      [&](std::size_t first) {
        found = lead_to(first);
        return found.has_value();
      });
  return found ? *std::move(found) : anew();
}

/// An order for all that is left, whatever the plan says.
base::Result<io::OrderReport> Continuation::anew() {
  request_.seconds_max = time_.seconds_left();
  auto sought = seek_order(rest_.target, request_);
  if (!sought) {
    return sought.error();
  }
  io::OrderReport report = std::move(sought).value();
  report.kept_count = 0;
  report.seconds = time_.seconds_passed();
  return report;
}

}  // namespace

base::Result<io::OrderReport> continue_order(const io::Document& file, const io::Document& plan,
                                             std::optional<std::size_t> done_count,
                                             const OrderRequest& request) {
  auto rest = read_order_rest(file, plan, done_count);
  if (!rest) {
    return rest.error();
  }
  if (request.is_reversed && !rest.value().is_reversed) {
    return error_of_plan("it attaches modules, which --reverse cannot go on with");
  }
  const bool is_reversed = rest.value().is_reversed;
  auto report = Continuation(std::move(rest).value(), request).run();
  if (report && request.stream &&
      report.value().result.order.outcome == plan::OrderOutcome::kFound) {
    std::size_t number = 0;
    plan::tell_steps(report.value().result.order,
                     is_reversed ? plan::Sense::kShrinking : plan::Sense::kGrowing,
                     [&](const plan::Batch& step, const plan::Judgement& judged) {
                       request.stream(io::order_step_line(report.value(), number++, step, judged));
                     });
  }
  return report;
}

}  // namespace holdfast
