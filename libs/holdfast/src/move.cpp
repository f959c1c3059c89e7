// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "holdfast/move.hpp"

#include <chrono>
#include <utility>

#include "plan_page.hpp"

namespace holdfast {
namespace {

base::Result<plan::MoveTask> task_of(const io::Document& start, const io::Document& target,
                                     const MoveRequest& request) {
  auto task = io::move_task(start, target);
  if (!task) {
    return task.error();
  }
  plan::MoveTask made = std::move(task).value();
  made.pivots = request.pivots;
  made.within = request.within;
  made.ignores_mechanics = request.ignores_mechanics;
  return made;
}

}  // namespace

base::Result<io::MoveReport> seek_moves(const io::Document& start, const io::Document& target,
                                        const MoveRequest& request) {
  auto task = task_of(start, target, request);
  if (!task) {
    return task.error();
  }
  const auto begin = std::chrono::steady_clock::now();
  plan::MoveOptions options;
  options.seed = request.seed;
  options.seconds_max = request.seconds_max;
  options.is_interrupted = request.is_interrupted;
  options.progress = request.progress;
  options.solver.thread_count = request.thread_count;
  auto plan = plan::find_moves(task.value(), options);
  if (!plan) {
    base::Error error = io::with_other_lattice(plan.error(), start);
    return error.message == plan.error().message ? io::with_other_lattice(error, target) : error;
  }
  io::MoveReport report{
      .start = start, .task = std::move(task).value(), .plan = std::move(plan).value()};
  report.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  return report;
}

base::Result<ProvedMoves> verify_moves(const io::Document& start, const io::Document& target,
                                       const MoveRequest& request, std::string_view report) {
  auto task = task_of(start, target, request);
  if (!task) {
    return task.error();
  }
  const auto certificate = io::read_move_certificate(report, task.value());
  if (!certificate) {
    return certificate.error();
  }
  solver::EquilibriumOptions options;
  options.thread_count = request.thread_count;
  const auto check = plan::verify(certificate.value(), options);
  if (!check) {
    return check.error();
  }
  return ProvedMoves{.start_name = start.name,
                     .target_name = target.name,
                     .task = std::move(task).value(),
                     .is_backward = certificate.value().is_backward,
                     .check = check.value()};
}

std::string move_html(const io::MoveReport& report, std::string_view more, int thread_count) {
  const std::string text = io::move_text(report) + std::string(more);
  const std::string name = name_of(report.start, report.origin);
  return plan_html({.command = "move",
                    .name = name,
                    .answer = plan::name(report.plan.outcome),
                    .pictures = {},
                    .text = text},
                   report.plan.steps.empty() ? io::Document() : io::move_steps(report),
                   thread_count);
}

}  // namespace holdfast
