// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "holdfast/plan_failures.hpp"
#include "lose_one_options.hpp"
#include "progress.hpp"
#include "scatter_options.hpp"

/// The options of commands that find or judge plans: how sure is each stage, and does it hold
/// whatever is lost?
namespace holdfast::cli {

struct PlanFailureOptions {
  ScatterOptions scatter;
  LoseOneArguments lose_one;

  bool is_wanted() const { return scatter.is_wanted() || lose_one.is_wanted; }
};

void add_plan_failure_options(CLI::App& command, PlanFailureOptions& options);

/// What they ask for; `what` is counted, such as "step".
PlanFailuresWish plan_failures_wish(const PlanFailureOptions& options, const CheckOptions& check,
                                    Progress& progress, const char* what);

/// The answer to them, for reports.
struct PlanFailureAnswer : PlanFailuresReport {
  int exit_code = kExitSafe;
};

/// Looks at all stages of a document with steps, if anything is asked for.
base::Result<PlanFailureAnswer> find_plan_failures(const io::Document& document,
                                                   const PlanFailureOptions& options,
                                                   int thread_count, Progress& progress);

/// The exit code of a plan that is safe by itself, or not.
int worse(int plan_code, const PlanFailureAnswer& answer);

/// Adds --safety-factor, which all commands that judge structures have.
void add_safety_factor(CLI::App& command, io::ReadOptions& reading);

}  // namespace holdfast::cli
