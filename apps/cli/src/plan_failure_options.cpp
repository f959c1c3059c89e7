// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "plan_failure_options.hpp"

namespace holdfast::cli {

void add_plan_failure_options(CLI::App& command, PlanFailureOptions& options) {
  add_scatter_options(command, options.scatter);
  add_lose_one_options(command, options.lose_one);
}

PlanFailuresWish plan_failures_wish(const PlanFailureOptions& options, const CheckOptions& check,
                                    Progress& progress, const char* what) {
  return {.is_scatter_wanted = options.scatter.is_wanted(),
          .scatter = read_scatter(options.scatter),
          .probability = options.scatter.probability,
          .is_lose_one_wanted = options.lose_one.is_wanted,
          .lose_one = lose_one_options(options.lose_one, check),
          .progress = [&progress, what](std::size_t count) {
            progress.show([&] { return fmt::format("{} looked at", host::counted(count, what)); });
          }};
}

base::Result<PlanFailureAnswer> find_plan_failures(const io::Document& document,
                                                   const PlanFailureOptions& options,
                                                   int thread_count, Progress& progress) {
  auto report = report_plan_failures(
      document, plan_failures_wish(options, {.thread_count = thread_count}, progress, "step"));
  if (!report) {
    return report.error();
  }
  PlanFailureAnswer answer{std::move(report).value()};
  const PlanFailures& found = answer.found;
  answer.exit_code = found.fails()          ? kExitUnsafe
                     : found.is_uncertain() ? kExitUndecided
                                            : kExitSafe;
  if (options.scatter.probability <= 0 && !found.first_fatal && !found.first_undecided) {
    answer.exit_code = kExitSafe;
  }
  return answer;
}

int worse(int plan_code, const PlanFailureAnswer& answer) {
  return plan_code == kExitSafe ? answer.exit_code : plan_code;
}

void add_safety_factor(CLI::App& command, io::ReadOptions& reading) {
  command
      .add_option("--safety-factor,--margin", reading.safety_factor,
                  "Divide all strengths by this: safe is what would be safe under all loads times "
                  "it; without it by what the file states")
      ->type_name("FACTOR")
      ->check(number_between(1.0, io::kSafetyFactorMax));
}

}  // namespace holdfast::cli
