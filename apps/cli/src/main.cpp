// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <exception>
#include <memory>
#include <new>
#include <stdexcept>
#include <string>
#include <system_error>

#include "commands.hpp"
#include "help.hpp"
#include "holdfast/holdfast.hpp"

namespace {

namespace cli = holdfast::cli;

/// Whether the program knows a command of this name.
bool is_command(const CLI::App& app, const std::string& name) {
  const auto commands = app.get_subcommands({});
  return std::ranges::any_of(commands,
                             [&](const CLI::App* command) { return command->check_name(name); });
}

/// holdfast help [COMMAND].
int show_help(const CLI::App& app, int argc, char** argv) {
  const std::string name = argc > 2 && std::string(argv[2]) != "help" ? argv[2] : "";
  if (!name.empty() && !is_command(app, name)) {
    std::fputs(cli::unknown_command(app, name).c_str(), stderr);
    return holdfast::kExitUsage;
  }
  if (argc > 3) {
    fmt::print(stderr, "holdfast help: the argument '{}' is one too many, expected COMMAND\n",
               holdfast::io::one_line(argv[3]));
    return holdfast::kExitUsage;
  }
  const CLI::App& command = name.empty() ? app : *app.get_subcommand(name);
  std::fputs(command.help().c_str(), stdout);
  return 0;
}

/// An empty value, such as that of a shell's variable that is not set, names no file and nothing
/// else; nor does the next option.
void refuse_missing_values(CLI::App& app) {
  for (CLI::App* command : app.get_subcommands({})) {
    for (CLI::Option* option : command->get_options()) {
      if (option->get_items_expected_max() > 0) {
        option->check([command, is_named = !option->get_positional()](const std::string& value) {
          const bool is_option = is_named && value.size() > 1 && value.starts_with('-') &&
                                 command->get_option_no_throw(value) != nullptr;
          return value.empty() ? std::string("the value is empty")
                 : is_option   ? "expected a value, found the option " + value
                               : std::string();
        });
      }
    }
  }
}

int run(int argc, char** argv) {
  CLI::App app(
      "Will it hold? Predicts whether a modular robot breaks or topples when modules are attached",
      "holdfast");
  const auto formatter = std::make_shared<cli::HelpFormatter>();
  formatter->label("SUBCOMMAND", "COMMAND");
  app.formatter(formatter);
  app.set_version_flag("-V,--version", "holdfast " + std::string(holdfast::version()),
                       "Print the version and exit");
  app.require_subcommand(1);
  const cli::Command commands[] = {
      cli::add_check(app),    cli::add_steps(app),    cli::add_next(app),    cli::add_order(app),
      cli::add_move(app),     cli::add_simulate(app), cli::add_emulate(app), cli::add_listen(app),
      cli::add_tell(app),     cli::add_twin(app),     cli::add_convert(app), cli::add_fit(app),
      cli::add_generate(app), cli::add_robots(app),   cli::add_view(app)};
  for (const cli::Command& command : commands) {
    formatter->set(command.app, command.help);
  }
  formatter->set(&app,
                 {.examples = {{"check arm.json", "will it hold?"},
                               {"view arm.json", "look at it and change it"},
                               {"help check", "all that check can do"}},
                  .notes = "holdfast help COMMAND, or holdfast COMMAND --help, says more about a "
                           "command.",
                  .exits = {}});
  refuse_missing_values(app);
  const std::string first = argc > 1 ? argv[1] : "";
  if (first == "help") {
    return show_help(app, argc, argv);
  }
  if (first.empty()) {
    std::fputs(app.help().c_str(), stderr);
    return holdfast::kExitUsage;
  }
  if (!first.starts_with('-') && !is_command(app, first)) {
    std::fputs(cli::unknown_command(app, first).c_str(), stderr);
    return holdfast::kExitUsage;
  }
  app.failure_message([](const CLI::App* asked, const CLI::Error& error) {
    return cli::usage_error(*asked, error);
  });
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : holdfast::kExitUsage;
  }
  for (const cli::Command& command : commands) {
    if (command.app->parsed()) {
      return command.run();
    }
  }
  return holdfast::kExitUsage;
}

/// Descriptors 0 to 2 are never those of a file: one that is closed is opened so that it cannot be
/// used, and whoever tries gets an error.
void occupy_standard_descriptors() {
  while (true) {
    const int descriptor = ::open("/dev/null", O_RDONLY);
    if (descriptor < 0 || descriptor > STDERR_FILENO) {
      ::close(descriptor);
      return;
    }
    if (descriptor == STDIN_FILENO) {
      ::close(descriptor);
      ::open("/dev/null", O_WRONLY);
    }
  }
}

/// Reports that memory has run out, without allocating any.
int fail_out_of_memory() {
  std::fputs(
      "holdfast: out of memory: the structure is too large for this machine, or for the limit "
      "that is set here\n",
      stderr);
  return holdfast::kExitFailure;
}

int fail_output(int error) {
  std::fputs("holdfast: standard output cannot be written: ", stderr);
  std::fputs(std::strerror(error), stderr);
  std::fputs("\n", stderr);
  return holdfast::kExitBadInput;
}

/// The exit code for what a command threw.
int fail_exception() {
  try {
    throw;
  } catch (const std::bad_alloc&) {
    return fail_out_of_memory();
  } catch (const std::length_error&) {
    return fail_out_of_memory();
  } catch (const std::system_error& error) {
    // Printing throws this one.
    return fail_output(error.code().value());
  } catch (const std::exception& error) {
    std::fputs("holdfast: ", stderr);
    std::fputs(error.what(), stderr);
    std::fputs("\n", stderr);
  }
  return holdfast::kExitFailure;
}

/// Ends the program as main does after an exception that nobody is left to catch.
[[noreturn]] void terminate_by_exit() {
  if (std::current_exception()) {
    ::_exit(fail_exception());
  }
  std::abort();
}

}  // namespace

int main(int argc, char** argv) {
  occupy_standard_descriptors();
  std::set_terminate(terminate_by_exit);
  holdfast::host::OutputFile::remove_unfinished_on_signals();
  holdfast::host::use_large_pages();
  int code = 0;
  try {
    code = run(argc, argv);
  } catch (...) {
    code = fail_exception();
  }
  // Small texts are written only now.
  errno = 0;
  if (std::fflush(stdout) != 0 || std::ferror(stdout) != 0) {
    return code >= holdfast::kExitUsage ? code : fail_output(errno != 0 ? errno : EIO);
  }
  return code;
}
