// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>
#include <functional>

/// The commands of the program. Each adds itself to the app and returns what to run if it is used;
/// that returns the exit code.
namespace holdfast::cli {

// Exit codes; 64 and 65 are those of sysexits.h.
inline constexpr int kExitSafe = 0;
inline constexpr int kExitUnsafe = 1;
inline constexpr int kExitUndecided = 2;
inline constexpr int kExitUsage = 64;
inline constexpr int kExitBadInput = 65;

struct Command {
  CLI::App* app = nullptr;
  std::function<int()> run;
};

Command add_check(CLI::App& app);
Command add_convert(CLI::App& app);

}  // namespace holdfast::cli
