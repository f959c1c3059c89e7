// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "program.hpp"

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <exception>
#include <new>
#include <stdexcept>
#include <string>
#include <system_error>

#include "help.hpp"

namespace holdfast::cli {
namespace {

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

/// Reports that memory has run out, without allocating any.
int fail_out_of_memory() {
  std::fputs(
      "holdfast: out of memory: the structure is too large for this machine, or for the limit "
      "that is set here\n",
      stderr);
  return kExitFailure;
}

int fail_output(int error) {
  std::fputs("holdfast: standard output cannot be written: ", stderr);
  std::fputs(std::strerror(error), stderr);
  std::fputs("\n", stderr);
  return kExitBadInput;
}

int finish_output(int code) {
  // Small texts are written only now.
  errno = 0;
  if (std::fflush(stdout) != 0 || std::ferror(stdout) != 0) {
    return code >= kExitUsage ? code : fail_output(errno != 0 ? errno : EIO);
  }
  return code;
}

}  // namespace

Program::Program()
    : app_(std::make_unique<CLI::App>("Will it hold? Predicts whether a modular robot breaks or "
                                      "topples when modules are attached",
                                      "holdfast")) {
  CLI::App& app = *app_;
  const auto formatter = std::make_shared<HelpFormatter>();
  formatter->label("SUBCOMMAND", "COMMAND");
  app.formatter(formatter);
  app.set_version_flag("-V,--version", "holdfast " + std::string(version()),
                       "Print the version and exit");
  app.require_subcommand(1);
  commands_ = {add_check(app),   add_steps(app),    add_next(app),        add_order(app),
               add_move(app),    add_simulate(app), add_emulate(app),     add_listen(app),
               add_tell(app),    add_twin(app),     add_conformance(app), add_serve(app),
               add_convert(app), add_fit(app),      add_generate(app),    add_robots(app),
               add_view(app)};
  for (const Command& command : commands_) {
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
  app.failure_message(
      [](const CLI::App* asked, const CLI::Error& error) { return usage_error(*asked, error); });
}

const CLI::App* Program::find(const std::string& name) const {
  const auto found = std::ranges::find_if(
      commands_, [&](const Command& command) { return command.app->check_name(name); });
  return found == commands_.end() ? nullptr : found->app;
}

int Program::show_help(int argc, char** argv) const {
  const std::string name = argc > 2 && std::string(argv[2]) != "help" ? argv[2] : "";
  if (!name.empty() && find(name) == nullptr) {
    std::fputs(unknown_command(*app_, name).c_str(), stderr);
    return kExitUsage;
  }
  if (argc > 3) {
    fmt::print(stderr, "holdfast help: the argument '{}' is one too many, expected COMMAND\n",
               io::one_line(argv[3]));
    return kExitUsage;
  }
  const CLI::App& command = name.empty() ? *app_ : *find(name);
  std::fputs(command.help().c_str(), stdout);
  return 0;
}

int Program::run(int argc, char** argv) {
  const std::string first = argc > 1 ? argv[1] : "";
  if (first == "help") {
    return show_help(argc, argv);
  }
  if (first.empty()) {
    std::fputs(app_->help().c_str(), stderr);
    return kExitUsage;
  }
  if (!first.starts_with('-') && find(first) == nullptr) {
    std::fputs(unknown_command(*app_, first).c_str(), stderr);
    return kExitUsage;
  }
  try {
    app_->parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app_->exit(error) == 0 ? 0 : kExitUsage;
  }
  const auto asked =
      std::ranges::find_if(commands_, [](const Command& command) { return command.app->parsed(); });
  if (asked == commands_.end()) {
    return kExitUsage;
  }
  try {
    return asked->run();
  } catch (const UsageError& error) {
    std::fputs(usage_error(*asked->app, error.what()).c_str(), stderr);
    return kExitUsage;
  }
}

int report_exception() {
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
  return kExitFailure;
}

int run_guarded(Program& program, int argc, char** argv) {
  try {
    return finish_output(program.run(argc, argv));
  } catch (...) {
    return finish_output(report_exception());
  }
}

}  // namespace holdfast::cli
