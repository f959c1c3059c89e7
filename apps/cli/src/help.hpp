// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "holdfast/exit_code.hpp"

/// What --help and wrong usage say, for all commands alike: examples first, text wrapped at the
/// terminal's width, one notation of defaults, exit codes as a list; and "did you mean".
namespace holdfast::cli {

struct Example {
  std::string_view command;  ///< Without "holdfast ".
  std::string_view what;     ///< What it does or answers, in a few words.
};

struct ExitCode {
  int code = 0;
  std::string_view meaning;
};

/// The meaning of 65 for commands that read structures and write nothing but what options name.
inline constexpr ExitCode kUnreadable = {kExitBadInput,
                                         "an input cannot be read, or an output not written"};

/// What the help of a command says beside its arguments and options.
struct Help {
  std::vector<Example> examples;
  std::string notes;            ///< Paragraphs, separated by an empty line; wrapped.
  std::vector<ExitCode> exits;  ///< Those of its own; 64 and 70, which all have, follow.
};

/// Formats the help of the program and of its commands.
class HelpFormatter : public CLI::Formatter {
 public:
  void set(const CLI::App* command, Help help) { helps_[command] = std::move(help); }

  std::string make_help(const CLI::App* app, std::string name,
                        CLI::AppFormatMode mode) const override;
  std::string make_option(const CLI::Option* option, bool is_positional) const override;
  std::string make_subcommand(const CLI::App* command) const override;

 private:
  std::map<const CLI::App*, Help> helps_;
};

/// One line that says what is wrong with the arguments, after the name of the command that was
/// asked, and one that says where help is.
std::string usage_error(const CLI::App& app, const CLI::Error& error);

/// Says so where a command itself finds what is wrong.
std::string usage_error(const CLI::App& command, std::string_view what);

/// What to say where the first argument is neither an option nor a command.
std::string unknown_command(const CLI::App& app, std::string_view argument);

}  // namespace holdfast::cli
