// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "change_options.hpp"

#include "faults.hpp"

namespace holdfast::cli {

void add_change_options(CLI::App& command, ChangeOptions& options, const std::string& time) {
  const auto add = [&](const char* name, std::vector<std::string>& values,
                       const std::string& help) {
    command.add_option(name, values, help)->type_name("X,Y,Z@T")->allow_extra_args(false);
  };
  add("--plan", options.plans,
      "A module is planned at time T (" + time + "); the first module is told");
  add("--withdraw", options.withdrawals, "A plan is withdrawn at time T; all@T: all plans");
  add("--attach", options.attachments, "A module comes to the cell; its plan is fulfilled");
}

std::vector<Change> read_changes(const ChangeOptions& options,
                                 const std::function<sim::Time(double time)>& ticks) {
  std::vector<Change> changes;
  const auto read = [&](const char* name, const std::vector<std::string>& texts,
                        Change::Kind kind) {
    const bool allows_all = kind == Change::Kind::kWithdraw;
    for (const std::string& text : texts) {
      const auto place = read_change_place(text, allows_all);
      if (!place) {
        throw UsageError(change_usage(name, text, allows_all));
      }
      changes.push_back({.kind = kind, .at = ticks(place->time), .cell = place->cell});
    }
  };
  read("attach", options.attachments, Change::Kind::kAttach);
  read("plan", options.plans, Change::Kind::kPlan);
  read("withdraw", options.withdrawals, Change::Kind::kWithdraw);
  return changes;
}

}  // namespace holdfast::cli
