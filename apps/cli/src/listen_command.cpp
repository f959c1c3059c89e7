// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <cstdio>
#include <memory>

#include "commands.hpp"
#include "holdfast/instrument.hpp"
#include "instrument_options.hpp"
#include "interruption.hpp"

namespace holdfast::cli {
namespace {

struct ListenArguments {
  std::vector<std::string> devices;
  InstrumentOptions options;
  bool is_json = false;
};

int run_listen(const ListenArguments& arguments) {
  const Interruption interruption;
  const auto heard = listen(
      arguments.devices, arguments.options,
      [&](const HeardLine& line) { print_at_once(arguments.is_json ? line.json : line.text); },
      [] { return !Interruption::is_here(); });
  if (!heard) {
    const std::string& device = heard.error().where;
    return fail(heard.error(), device.empty() ? arguments.devices.front() : device);
  }
  const bool is_silent = heard.value().silent_count == static_cast<int>(arguments.devices.size());
  if (is_silent) {
    fmt::print(stderr,
               "holdfast: no answer; is a free face of a module there, at this rate, and does its "
               "program answer instruments (the 60 KB image does not)?\n");
  }
  return is_silent ? kExitBadInput : exit_code(to_verdict(heard.value().verdict));
}

}  // namespace

Command add_listen(CLI::App& app) {
  auto arguments = std::make_shared<ListenArguments>();
  CLI::App* command = app.add_subcommand(
      "listen", "Tell what happens at modules on the table, over serial lines to free faces");
  add_required(*command, "DEVICE", arguments->devices,
               "A serial adapter at a free face of a module, or several at several modules");
  add_baud(*command, arguments->options);
  command->add_flag("--once", arguments->options.is_once,
                    "Only say what every module has come to, in detail");
  command->add_flag("--json", arguments->is_json, "Print JSON instead, one object in each line");
  command->add_option("--time", arguments->options.time_max_s, "End after this time (s)")
      ->type_name("T")
      ->check(number_between(0.001, 1e6).description(""));
  return {command,
          [arguments] { return run_listen(*arguments); },
          {.examples = {{"listen /dev/ttyUSB0", "tell what happens, until Ctrl-C"},
                        {"listen /dev/ttyUSB0 --once", "what has this module come to?"},
                        {"listen /dev/ttyUSB0 /dev/ttyUSB1 --time 20", "two modules, 20 s"},
                        {"listen /dev/ttyUSB0 --json", "lines for another program"}},
           .notes = "Lines are those of simulate --story: the seconds of the module's own clock, "
                    "its cell, what has happened. A module says nothing by itself; it is asked "
                    "20 times a second, and remembers the last 16 things between.",
           .exits = {{kExitSafe, "every module that answers says safe"},
                     {kExitUnsafe, "every one says overload or unstable"},
                     {kExitUndecided, "undecided, no verdict yet, or they do not agree"},
                     {kExitBadInput, "a device cannot be opened, or nobody answers"}}}};
}

}  // namespace holdfast::cli
