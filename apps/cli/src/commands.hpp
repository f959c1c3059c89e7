// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <functional>
#include <initializer_list>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>

#include "help.hpp"
#include "holdfast/exit_code.hpp"
#include "holdfast/file_ending.hpp"
#include "holdfast/holdfast.hpp"
#include "holdfast/trial.hpp"

/// The commands of the program. Each adds itself to the app and returns what to run if it is used;
/// that returns the exit code.
namespace holdfast::cli {

struct Command {
  CLI::App* app = nullptr;
  std::function<int()> run;
  Help help;
};

Command add_check(CLI::App& app);
Command add_conformance(CLI::App& app);
Command add_convert(CLI::App& app);
Command add_emulate(CLI::App& app);
Command add_fit(CLI::App& app);
Command add_generate(CLI::App& app);
Command add_listen(CLI::App& app);
Command add_move(CLI::App& app);
Command add_next(CLI::App& app);
Command add_order(CLI::App& app);
Command add_robots(CLI::App& app);
Command add_serve(CLI::App& app);
Command add_simulate(CLI::App& app);
Command add_steps(CLI::App& app);
Command add_tell(CLI::App& app);
Command add_twin(CLI::App& app);
Command add_view(CLI::App& app);

/// The verdict in capitals, coloured on a terminal, padded to the longest.
std::string banner(verdict::Verdict verdict);

/// The exit code of a program that was asked where the next module may go.
int exit_code_of(const NextResult& result);

/// A file, or files, that must be given. The help shows no type beside the name.
template <class Value>
void add_required(CLI::App& command, const std::string& name, Value& value,
                  const std::string& help) {
  command.add_option(name, value, help)->type_name("")->required();
}

/// Checks a number as CLI::Range does, which lets pass what is not a number.
inline CLI::Validator number_between(double low, double high) {
  CLI::Validator check = CLI::Range(low, high);
  check.operation([within = check](std::string& text) {
    double number = 0;
    const bool is_nan = CLI::detail::lexical_cast(text, number) && std::isnan(number);
    return is_nan ? text + " is not a number" : within(text);
  });
  return check;
}

/// The group of options that only say where outputs go; a report does not repeat them.
inline constexpr const char* kOutputs = "Outputs";

/// An option that names a file to be written.
inline CLI::Option& add_output(CLI::App& command, const std::string& name, std::string& path,
                               const std::string& help, const std::string& type = "FILE") {
  return *command.add_option(name, path, help)->type_name(type)->group(kOutputs);
}

/// The option for motions as data, of find_motions().
inline CLI::Option& add_motions(CLI::App& command, std::string& motions, const std::string& help) {
  return *command.add_option("--motions", motions, help)->type_name("NAME|FILE");
}

/// The options --continue and --at; returns the first one.
inline CLI::Option& add_continuation(CLI::App& command, std::string& plan,
                                     std::optional<std::size_t>& done_count,
                                     const std::string& plan_help, const std::string& count_help) {
  CLI::Option* option = command.add_option("--continue", plan, plan_help)->type_name("PLAN");
  command.add_option("--at", done_count, count_help)
      ->type_name("K")
      ->check(CLI::Range(0, 1000000000))
      ->needs(option);
  return *option;
}

/// The option --threads.
inline void add_threads(CLI::App& command, int& thread_count) {
  command
      .add_option("--threads", thread_count,
                  "Threads; 0: as many as the machine has cores. The answer does not depend on it")
      ->type_name("N")
      ->check(CLI::Range(0, 64));
}

/// The flag -q, --quiet.
inline void add_quiet(CLI::App& command, bool& is_quiet) {
  command.add_flag("-q,--quiet", is_quiet, "Print errors only; the exit code is the answer")
      ->group(kOutputs);
}

/// The help of an argument that any command reads.
inline constexpr const char* kStructureHelp =
    "Structure in any format that holdfast convert lists; - is standard input";

/// The option --seed. CLI11 by itself takes what is too large for the largest seed.
inline CLI::Option& add_seed(CLI::App& command, std::uint64_t& seed, const std::string& help) {
  return *command.add_option("--seed", seed, help)
              ->type_name("N")
              ->check([](const std::string& text) {
                std::uint64_t number = 0;
                const char* const end = text.data() + text.size();
                const auto read = std::from_chars(text.data(), end, number);
                return read.ec == std::errc{} && read.ptr == end
                           ? std::string()
                           : fmt::format("expected a whole number from 0 to {}, found {}",
                                         UINT64_MAX, io::one_line(text));
              });
}

/// Prints a reader's notes to standard error, whatever is asked for: a silent note is a lost one.
inline void print_notes(std::span<const std::string> notes, const std::string& file) {
  for (const std::string& note : notes) {
    fmt::print(stderr, "holdfast: {}: note: {}\n", io::one_line(file), note);
  }
}

/// The one form of an error on the terminal.
inline void print_error(const base::Error& error, const std::string& file) {
  print_notes(error.notes, file);
  fmt::print(stderr, "holdfast: {}\n", describe(error, file));
}

/// Prints the error and returns the exit code.
inline int fail(const base::Error& error, const std::string& file) {
  print_error(error, file);
  return kExitBadInput;
}

/// Notes are on standard error already: a text report for the same place does without them.
TextOptions text_options();

/// What is wrong with a command line that the parser has taken. The program prints it as it does
/// the parser's own errors, and exits with kExitUsage.
struct UsageError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// An output that was asked for and that there is nothing for: a file that is there stays as it
/// was.
inline void print_not_written(const std::string& file, const char* reason) {
  if (!file.empty()) {
    fmt::print(stderr, "holdfast: {}: note: not written, as {}\n", io::one_line(file), reason);
  }
}

/// Says what is wrong with the name of a robot of the catalogue; empty if nothing is.
inline std::string robot_name_fault(const std::string& name) {
  if (model::find_robot(name) != nullptr) {
    return "";
  }
  std::vector<std::string_view> names;
  for (const model::CatalogueRobot& robot : model::robot_catalogue()) {
    names.push_back(robot.name);
  }
  const auto near = io::near_miss(name, names);
  return fmt::format("unknown robot '{}'; {}", io::one_line(name),
                     near ? fmt::format("did you mean '{}'?", *near)
                          : fmt::format("expected {}", fmt::join(names, ", ")));
}

/// A document with a name: that of its file where it has none.
inline io::Document named(io::Document document, const std::string& file) {
  if (document.name.empty() && file != "-") {
    document.name = std::filesystem::path(file).stem().string();
  }
  return document;
}

/// The option --connections of commands that write a JSON report.
inline void add_connections(CLI::App& command, std::string& choice) {
  command
      .add_option("--connections", choice,
                  "Which connections a report lists: all, broken, or the N with the largest load "
                  "ratios, these first")
      ->type_name("all|broken|N")
      ->check([](const std::string& text) {
        return io::find_connection_choice(text) ? "" : "expected all, broken or a count";
      })
      ->capture_default_str();
}

/// Says that --connections has no effect where no report that lists connections is written.
inline void note_idle_connections(const std::string& choice,
                                  std::initializer_list<std::string> reports) {
  if (choice != "all" && std::ranges::all_of(reports, &std::string::empty)) {
    fmt::print(stderr,
               "holdfast: note: --connections has no effect on the text; it chooses what the "
               "files of connections list, such as that of --json\n");
  }
}

/// The option with which steps go to standard output, a line of JSON each.
inline CLI::Option* add_stream(CLI::App& command, bool& is_streamed) {
  return command.add_flag("--stream", is_streamed,
                          "Write every step as a line of JSON to standard output as soon as it is "
                          "certified and will not be taken back, then a line with the result");
}

/// Bytes as what write_or_complain() takes.
inline std::string_view as_text(std::span<const std::uint8_t> bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

/// Prints a line that somebody waits for.
inline void print_at_once(const std::string& line) {
  fmt::print("{}\n", line);
  std::fflush(stdout);
}

/// A structure with steps as the ending of its file asks: VisibleSim XML or holdfast JSON.
inline std::string plan_text(const io::Document& document, const std::string& path) {
  return has_ending(path, ".xml") ? io::write_visiblesim(io::with_targets(document))
                                  : io::write_json(document);
}

/// Writes a text, or what a function writes into a stream, to a file; "-" is standard output.
/// Returns false, and prints the error, if the file cannot be written.
template <class Content>
bool write_or_complain(const std::string& path, const Content& content) {
  const auto error = write_file(path, content);
  if (error) {
    print_error(*error, path);
  }
  return !error;
}

}  // namespace holdfast::cli
