// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <exception>
#include <new>
#include <stdexcept>
#include <string>
#include <system_error>

#include "commands.hpp"
#include "holdfast/holdfast.hpp"

namespace {

namespace cli = holdfast::cli;

/// Says that the first argument is neither an option nor a command; else empty.
std::string unknown_command(const CLI::App& app, int argc, char** argv) {
  const std::string argument = argc > 1 ? argv[1] : "";
  if (argument.empty() || argument.starts_with('-')) {
    return {};
  }
  std::string text = "holdfast: there is no command '" + argument + "', but";
  for (const CLI::App* command : app.get_subcommands({})) {
    if (command->check_name(argument)) {
      return {};
    }
    text += " " + command->get_name();
  }
  return text + "\n";
}

/// An empty value, such as that of a shell's variable that is not set, names no file and nothing
/// else.
void refuse_empty_values(CLI::App& app) {
  for (CLI::App* command : app.get_subcommands({})) {
    for (CLI::Option* option : command->get_options()) {
      if (option->get_items_expected_max() > 0) {
        option->check([](const std::string& value) {
          return std::string(value.empty() ? "the value is empty" : "");
        });
      }
    }
  }
}

int run(int argc, char** argv) {
  CLI::App app(
      "Will it hold? Predicts whether a modular robot breaks or topples when modules are attached.",
      "holdfast");
  app.set_version_flag("--version", "holdfast " + std::string(holdfast::version()));
  app.require_subcommand(1);
  app.footer("holdfast COMMAND --help says more about a command.");
  const cli::Command commands[] = {
      cli::add_check(app),    cli::add_steps(app),    cli::add_next(app),    cli::add_order(app),
      cli::add_move(app),     cli::add_simulate(app), cli::add_emulate(app), cli::add_convert(app),
      cli::add_generate(app), cli::add_robots(app),   cli::add_view(app)};
  refuse_empty_values(app);
  if (const std::string fault = unknown_command(app, argc, argv); !fault.empty()) {
    std::fputs(fault.c_str(), stderr);
    return holdfast::kExitUsage;
  }
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
