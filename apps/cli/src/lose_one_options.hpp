// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "commands.hpp"
#include "holdfast/losses.hpp"

/// The options of `check` that ask what follows if a single part is lost.
namespace holdfast::cli {

struct LoseOneArguments {
  bool is_wanted = false;
  std::vector<std::string> parts;  ///< Empty: all.
  double seconds_max = 600;
};

void add_lose_one_options(CLI::App& command, LoseOneArguments& arguments);

/// What is asked for; `check` is how the robot is checked.
LoseOneOptions lose_one_options(const LoseOneArguments& arguments, const CheckOptions& check);

/// The exit code that the answer asks for, whatever the verdict.
int exit_code_of(const plan::LossReport& report);

}  // namespace holdfast::cli
