// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "commands.hpp"
#include "holdfast/steps.hpp"

/// Reads what commands are given, and notes for their reports what that was.
namespace holdfast::cli {

/// What a file leaves open, and the command that asks.
struct Reading : io::ReadOptions {
  const CLI::App* command = nullptr;

  /// The origin that the report of a file has, with the options that are given.
  io::ReportOrigin origin(const std::string& file) const;
};

/// Adds the options of commands that read structures.
void add_reading(CLI::App& command, Reading& reading);

/// The options of a command that were given and are not at their defaults; without those that only
/// say where its outputs go.
std::vector<io::GivenOption> given_options(const CLI::App& command);

/// Reads a document and prints its notes.
base::Result<io::ReadDocument> read_with_notes(const std::string& file, const Reading& reading);

/// Reads a structure and prints its notes. 0 threads: as many as the machine has cores.
base::Result<Structure> load_with_notes(const std::string& file, const Reading& reading,
                                        int thread_count = 0);

/// Reads a structure with steps and prints its notes.
base::Result<StepsFile> load_steps_with_notes(const std::string& file, const Reading& reading);

}  // namespace holdfast::cli
