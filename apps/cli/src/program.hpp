// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>
#include <memory>
#include <vector>

#include "commands.hpp"

namespace holdfast::cli {

/// The program with its commands, ready to read arguments once.
class Program {
 public:
  Program();
  Program(const Program&) = delete;
  Program& operator=(const Program&) = delete;

  /// Does what the arguments ask, the first of which is the program's name, and returns the exit
  /// code. What is wrong with them goes to standard error. Throws std::bad_alloc, and
  /// std::system_error where standard output cannot be written.
  int run(int argc, char** argv);

  /// The command of a name; null if there is none.
  const CLI::App* find(const std::string& name) const;

 private:
  int show_help(int argc, char** argv) const;

  std::unique_ptr<CLI::App> app_;
  std::vector<Command> commands_;
};

/// Runs a program, ends what it printed, and returns the exit code. Throws nothing: memory that
/// runs out and output that cannot be written are exit codes as well.
int run_guarded(Program& program, int argc, char** argv);

/// The exit code for the exception that is being handled, which it reports on standard error
/// without allocating memory.
int report_exception();

}  // namespace holdfast::cli
