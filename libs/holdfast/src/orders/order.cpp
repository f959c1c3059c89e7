// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "holdfast/order.hpp"

#include <fmt/format.h>

#include <chrono>
#include <utility>

#include "holdfast/plan/robot_state.hpp"
#include "orders/order_options.hpp"
#include "plan_page.hpp"

namespace holdfast {

base::Result<io::OrderReport> seek_order(const io::Document& target, const OrderRequest& request) {
  auto spec = io::order_target(target);
  if (!spec) {
    return spec.error();
  }
  auto task = order_task(std::move(spec).value(), request);
  if (!task) {
    return task.error();
  }
  io::OrderReport report{
      .target = target, .task = std::move(task).value(), .is_reversed = request.is_reversed};
  plan::StepListener certified;
  if (request.stream) {
    certified = [&, number = std::size_t{0}](const plan::Batch& step,
                                             const plan::Judgement& judged) mutable {
      request.stream(io::order_step_line(report, number++, step, judged));
    };
  }
  const auto begin = std::chrono::steady_clock::now();
  plan::RobotOrderOptions options = order_options(request, report.task.target.existing.size());
  options.certified = certified;
  auto result = plan::find_robot_order(report.task, options);
  if (!result) {
    base::Error error = result.error();
    if (error.where == plan::kAtStart && request.start.empty() && !request.keep.empty()) {
      error.message +=
          "; the start is what is fixed and what is to be kept: give one that holds it";
    }
    return io::with_other_lattice(error, target);
  }
  const std::chrono::duration<double> passed = std::chrono::steady_clock::now() - begin;
  report.result = std::move(result).value();
  report.is_interrupted = request.is_interrupted && request.is_interrupted();
  report.seconds = passed.count();
  report.is_help_sought = request.help_seconds_max > 0 && report.result.certificate.has_value();
  if (report.is_help_sought) {
    report.help = plan::find_help(report.task, {.seconds_max = request.help_seconds_max,
                                                .thread_count = request.thread_count,
                                                .is_interrupted = request.is_interrupted});
  }
  return report;
}

std::string order_html(const io::OrderReport& report, std::string_view more, int thread_count) {
  const plan::Order& order = report.result.order;
  const std::string text = io::order_text(report) + std::string(more) +
                           (order.steps.empty() ? "" : io::order_way_text(report));
  auto steps = order.steps.empty() ? base::Result<io::Document>(io::Document())
                                   : io::order_steps(report.target, order, report.is_reversed);
  const std::string name = name_of(report.target, report.origin);
  return plan_html({.command = "order",
                    .name = name,
                    .answer = io::name(order.outcome),
                    .pictures = {},
                    .text = text},
                   steps ? std::move(steps).value() : io::Document(), thread_count);
}

base::Result<ProvedOrder> verify_order_certificate(std::string_view text,
                                                   const std::optional<model::RobotSpec>& target,
                                                   int thread_count) {
  auto read = io::read_order_certificate(text);
  if (!read) {
    return read.error();
  }
  auto [name, certificate] = std::move(read).value();
  if (target) {
    const auto names = plan::differences_of_targets(certificate.task.target, *target);
    if (!names.empty()) {
      return base::bad_input(fmt::format("the certificate is of another robot{}: they differ in {}",
                                         name.empty() ? "" : " (" + io::one_line(name) + ")",
                                         fmt::join(names, ", ")));
    }
  }
  const auto check = plan::verify(certificate, thread_count);
  if (!check) {
    return check.error();
  }
  return ProvedOrder{
      .name = std::move(name), .task = std::move(certificate.task), .check = check.value()};
}

}  // namespace holdfast
