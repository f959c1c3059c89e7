// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include <cstdio>
#include <exception>
#include <string>

#include "commands.hpp"
#include "holdfast/holdfast.hpp"

namespace {

int run(int argc, char** argv) {
  namespace cli = holdfast::cli;
  CLI::App app(
      "Will it hold? Predicts whether a modular robot breaks or topples when modules are attached.",
      "holdfast");
  app.set_version_flag("--version", "holdfast " + std::string(holdfast::version()));
  app.require_subcommand(1);
  app.footer("holdfast COMMAND --help says more about a command.");
  const cli::Command commands[] = {cli::add_check(app),    cli::add_simulate(app),
                                   cli::add_emulate(app),  cli::add_convert(app),
                                   cli::add_generate(app), cli::add_view(app)};
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : cli::kExitUsage;
  }
  for (const cli::Command& command : commands) {
    if (command.app->parsed()) {
      return command.run();
    }
  }
  return cli::kExitUsage;
}

}  // namespace

int main(int argc, char** argv) {
  holdfast::host::use_large_pages();
  try {
    return run(argc, argv);
  } catch (const std::exception& error) {
    // What can still happen is that memory runs out for a huge input.
    std::fputs("holdfast: ", stderr);
    std::fputs(error.what(), stderr);
    std::fputs("\n", stderr);
    return holdfast::cli::kExitBadInput;
  }
}
