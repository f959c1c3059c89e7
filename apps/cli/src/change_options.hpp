// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "commands.hpp"
#include "holdfast/distributed.hpp"

/// Reads the options --plan, --withdraw and --attach, which `simulate` and `emulate` share.
namespace holdfast::cli {

struct ChangeOptions {
  std::vector<std::string> plans;
  std::vector<std::string> withdrawals;
  std::vector<std::string> attachments;

  bool is_empty() const { return plans.empty() && withdrawals.empty() && attachments.empty(); }
};

/// Adds the options; `time` says what times are given in.
void add_change_options(CLI::App& command, ChangeOptions& options, const std::string& time);

/// Reads the changes. Throws a UsageError if a text is no place and time. `ticks` converts times as
/// given into the robot's.
std::vector<Change> read_changes(const ChangeOptions& options,
                                 const std::function<sim::Time(double time)>& ticks);

}  // namespace holdfast::cli
