// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "orders/order_rest.hpp"

#include <fmt/format.h>

#include <utility>

#include "holdfast/io/move_report.hpp"
#include "plan_tail.hpp"

namespace holdfast {
namespace {

using base::Cell;
using Cells = std::set<Cell>;

/// A plan as an order writes it.
struct ReadPlan {
  model::RobotSpec start;
  std::vector<PlannedBatch> steps;
  bool is_reversed = false;
};

base::Result<ReadPlan> read_plan(const io::Document& document) {
  const auto sequence = io::make_sequence(document);
  if (!sequence) {
    return error_of_plan(sequence.error().message);
  }
  const std::vector<model::Step>& steps = sequence.value().steps;
  ReadPlan plan;
  plan.start = sequence.value().start;
  if (steps.empty()) {
    return error_of_plan("it has no steps; expected a plan that holdfast order -o has written");
  }
  plan.is_reversed = !steps.front().detach.empty();
  for (std::size_t i = 0; i < steps.size(); ++i) {
    const model::Step& step = steps[i];
    const bool is_other = plan.is_reversed ? !step.attach.empty() : !step.detach.empty();
    if (is_other || !step.moves.empty() || !step.release.empty() || !step.connect.empty()) {
      return error_of_plan(fmt::format(
          "step {} does something else than to {} modules; expected a plan that holdfast order -o "
          "has written",
          i, plan.is_reversed ? "detach" : "attach"));
    }
    plan.steps.push_back(
        {.cells = plan.is_reversed ? step.detach : step.attach, .is_any_order = step.is_any_order});
  }
  return plan;
}

Cells all_cells(const model::RobotSpec& spec) {
  return {spec.existing.begin(), spec.existing.end()};
}

/// The first `count` steps of a plan done to some cells.
void do_steps(const ReadPlan& plan, std::size_t count, Cells& cells) {
  for (std::size_t i = 0; i < count; ++i) {
    for (const Cell& cell : plan.steps[i].cells) {
      plan.is_reversed ? static_cast<void>(cells.erase(cell))
                       : static_cast<void>(cells.insert(cell));
    }
  }
}

std::optional<base::Error> find_difference(const io::Document& a, const io::Document& b,
                                           bool has_same_cells) {
  const auto first = io::order_target(a);
  if (!first) {
    return first.error();
  }
  const auto second = io::order_target(b);
  if (!second) {
    return error_of_plan(second.error().message);
  }
  const auto names = has_same_cells ? plan::differences_of_targets(first.value(), second.value())
                                    : plan::differences(first.value(), second.value());
  return names.empty()
             ? std::optional<base::Error>()
             : error_of_plan(fmt::format("it is a plan of another robot: they differ in {}",
                                         fmt::join(names, ", ")));
}

/// Steps are done: the file is the robot that the plan was made for.
base::Result<OrderRest> rest_behind(const io::Document& file, const io::Document& document,
                                    const ReadPlan& plan, std::size_t done_count) {
  if (done_count > plan.steps.size()) {
    return error_of_done_steps(plan.steps.size(), done_count);
  }
  const io::Document whole = io::with_all_modules(document);
  if (const auto fault = find_difference(file, whole, true)) {
    return *fault;
  }
  OrderRest rest{.target = file, .start = all_cells(plan.start), .is_reversed = plan.is_reversed};
  rest.steps.assign(plan.steps.begin() + static_cast<std::ptrdiff_t>(done_count), plan.steps.end());
  if (!plan.is_reversed) {
    do_steps(plan, done_count, rest.start);
    return rest;
  }
  std::vector<Cell> gone;
  for (std::size_t i = 0; i < done_count; ++i) {
    gone.insert(gone.end(), plan.steps[i].cells.begin(), plan.steps[i].cells.end());
  }
  rest.target = io::without_modules(io::with_all_modules(file), std::move(gone));
  do_steps(plan, plan.steps.size(), rest.start);
  return rest;
}

/// The file is the robot as it is.
base::Result<OrderRest> rest_of_state(const io::Document& file, const io::Document& document,
                                      const ReadPlan& plan) {
  const auto state = io::standing_spec(file, "the robot");
  if (!state) {
    return state.error();
  }
  const io::Document whole = io::with_all_modules(document);
  if (const auto fault = find_difference(file, whole, false)) {
    return *fault;
  }
  OrderRest rest{.target = plan.is_reversed ? file : whole,
                 .start = plan.is_reversed ? all_cells(plan.start) : all_cells(state.value()),
                 .steps = plan.steps,
                 .is_reversed = plan.is_reversed};
  if (plan.is_reversed) {
    do_steps(plan, plan.steps.size(), rest.start);
  }
  return rest;
}

}  // namespace

base::Result<OrderRest> read_order_rest(const io::Document& file, const io::Document& plan,
                                        std::optional<std::size_t> done_count) {
  const auto read = read_plan(plan);
  if (!read) {
    return read.error();
  }
  return done_count ? rest_behind(file, plan, read.value(), *done_count)
                    : rest_of_state(file, plan, read.value());
}

}  // namespace holdfast
