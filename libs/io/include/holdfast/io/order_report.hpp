// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "holdfast/io/document.hpp"
#include "holdfast/io/report_head.hpp"
#include "holdfast/plan/order.hpp"
#include "holdfast/plan/order_help.hpp"

/// Reports the result of a search for an order, for programs and for people.
namespace holdfast::io {

struct OrderReport {
  ReportOrigin origin = {};
  Document target;
  plan::OrderTask task;
  plan::RobotOrder result = {};
  std::optional<plan::Help> help = {};
  bool is_help_sought = false;
  bool is_reversed = false;  ///< Taken apart instead of built.
  double seconds = 0;
  bool is_interrupted = false;  ///< The search was ended from outside.
  /// Where a plan is gone on with: how many of its steps are the last ones of the order.
  std::optional<std::size_t> kept_count = {};
};

/// The report in JSON; see docs/formats.md. `more` are further members, "key": value.
std::string order_json(const OrderReport& report, const std::vector<std::string>& more = {});

std::string order_text(const OrderReport& report);

/// A table as CSV of the modules in the order in which they are attached, or detached, with the
/// state after each one's step.
std::string order_csv(const OrderReport& report);

/// The text that follows order_text() if the order is written to no file: where it begins, and its
/// first steps.
std::string order_way_text(const OrderReport& report);

/// A line of JSON for one step of an order, as plan::RobotOrderOptions::certified tells them: the
/// modules that are there before any step for number 0, then those of steps from 1 on.
std::string order_step_line(const OrderReport& report, std::size_t number, const plan::Batch& step,
                            const plan::Judgement& judged);

/// The last line of JSON behind those of the steps: what the search has found, and why no more.
std::string order_last_line(const OrderReport& report);

/// Returns "found", "none" or "not-found".
const char* name(plan::OrderOutcome outcome);

}  // namespace holdfast::io
