// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "holdfast/move.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <utility>

#include "moves/move_task.hpp"
#include "plan_page.hpp"

namespace holdfast {

base::Result<std::pair<io::Document, io::Document>> with_one_factor(io::Document start,
                                                                    io::Document target) {
  double& from = start.extension.safety_factor;
  double& to = target.extension.safety_factor;
  if (from != to && from != 1 && to != 1) {
    return base::bad_input(
        fmt::format("the safety factor of the robot is {} and that of the target {}, expected one "
                    "for both",
                    from, to));
  }
  from = to = std::max(from, to);
  return std::pair(std::move(start), std::move(target));
}

base::Result<plan::MoveTask> task_of(const io::Document& start, const io::Document& target,
                                     const MoveRequest& request) {
  auto task = io::move_task(start, target);
  if (!task) {
    return task.error();
  }
  plan::MoveTask made = std::move(task).value();
  auto kept = plan::kept_modules(request.keep, made.start.existing);
  if (!kept) {
    return kept.error();
  }
  made.keep = std::move(kept).value();
  made.motions = request.motions;
  made.within = request.within;
  made.avoid = request.avoid;
  made.ignores_mechanics = request.ignores_mechanics;
  return made;
}

plan::MoveOptions move_options(const MoveRequest& request) {
  plan::MoveOptions options;
  options.seed = request.seed;
  options.seconds_max = request.seconds_max;
  options.is_interrupted = request.is_interrupted;
  options.progress = request.progress;
  options.solver.thread_count = request.thread_count;
  return options;
}

base::Result<std::shared_ptr<const plan::Motions>> find_motions(const std::string& name_or_file) {
  if (name_or_file == "pivoting") {
    return plan::pivoting_cubes();
  }
  plan::Motions motions{.name = name_or_file, .lattice = base::kFaceCentred, .goes_between = false};
  if (name_or_file != "catoms3D") {
    const auto text = read_file(name_or_file);
    if (!text) {
      return text.error();
    }
    auto read = io::read_motions(text.value());
    if (!read) {
      return read.error();
    }
    motions = std::move(read).value();
    motions.name = motions.name.empty() ? name_or_file : motions.name;
  }
  return std::make_shared<const plan::Motions>(std::move(motions));
}

namespace {

/// Both ends as they are meant, and what is asked of them.
struct Asked {
  io::Document start;
  io::Document target;
  plan::MoveTask task;
};

base::Result<Asked> asked_of(const io::Document& start, const io::Document& target,
                             const MoveRequest& request) {
  auto ends = with_one_factor(start, target);
  if (!ends) {
    return ends.error();
  }
  auto& [from, to] = ends.value();
  auto task = task_of(from, to, request);
  if (!task) {
    return task.error();
  }
  return Asked{.start = std::move(from), .target = std::move(to), .task = std::move(task).value()};
}

}  // namespace

base::Result<io::MoveReport> seek_moves(const io::Document& start_stated,
                                        const io::Document& target_stated,
                                        const MoveRequest& request) {
  auto asked = asked_of(start_stated, target_stated, request);
  if (!asked) {
    return asked.error();
  }
  auto& [start, target, task] = asked.value();
  const auto begin = std::chrono::steady_clock::now();
  auto plan = plan::find_moves(task, move_options(request));
  if (!plan) {
    base::Error error = io::with_other_lattice(plan.error(), start);
    return error.message == plan.error().message ? io::with_other_lattice(error, target) : error;
  }
  io::MoveReport report{
      .start = std::move(start), .task = std::move(task), .plan = std::move(plan).value()};
  report.is_interrupted = request.is_interrupted && request.is_interrupted();
  report.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  return report;
}

base::Result<ProvedMoves> verify_moves(const io::Document& start_stated,
                                       const io::Document& target_stated,
                                       const MoveRequest& request, std::string_view report) {
  auto asked = asked_of(start_stated, target_stated, request);
  if (!asked) {
    return asked.error();
  }
  auto& [start, target, task] = asked.value();
  const auto certificate = io::read_move_certificate(report, task);
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
                     .task = std::move(task),
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
