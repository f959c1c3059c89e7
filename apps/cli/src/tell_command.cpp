// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <memory>
#include <optional>

#include "cell_text.hpp"
#include "commands.hpp"
#include "instrument_options.hpp"
#include "reading.hpp"

namespace holdfast::cli {
namespace {

struct TellArguments {
  Reading reading;
  std::string device;
  std::string what;
  std::string value;
  InstrumentOptions options;
};

UsageError tell_usage(const TellArguments& arguments, const char* expected) {
  return UsageError(
      fmt::format("{}: expected {}, found {}", arguments.what, expected,
                  arguments.value.empty() ? "nothing" : "'" + io::one_line(arguments.value) + "'"));
}

/// The words plan, withdraw, anchor, fixed and free; none, if the value does not fit.
std::optional<Telling> telling_of(const TellArguments& arguments, const char*& expected) {
  using Kind = Telling::Kind;
  const std::string& what = arguments.what;
  if (what == "fixed" || what == "free") {
    expected = "nothing behind it";
    return arguments.value.empty()
               ? std::optional(Telling{.kind = what == "fixed" ? Kind::kFixed : Kind::kFree,
                                       .cell = {},
                                       .structure = nullptr})
               : std::nullopt;
  }
  if (what == "withdraw" && arguments.value == "all") {
    return Telling{.kind = Kind::kWithdraw, .cell = agent::kEveryCell, .structure = nullptr};
  }
  if (what == "anchor" && arguments.value == "none") {
    return Telling{.kind = Kind::kNoAnchor, .cell = {}, .structure = nullptr};
  }
  expected = what == "withdraw" ? "X,Y,Z or all" : what == "anchor" ? "X,Y,Z or none" : "X,Y,Z";
  const auto cell = read_cell(arguments.value);
  if (!cell) {
    return std::nullopt;
  }
  return Telling{.kind = what == "plan"       ? Kind::kPlan
                         : what == "withdraw" ? Kind::kWithdraw
                                              : Kind::kAnchor,
                 .cell = *cell,
                 .structure = nullptr};
}

int say(const TellArguments& arguments, const Telling& telling) {
  const auto said = tell(arguments.device, telling, arguments.options);
  if (!said) {
    return fail(said.error(), arguments.device);
  }
  fmt::print("{}\n", said.value());
  return kExitSafe;
}

int run_tell(const TellArguments& arguments) {
  if (arguments.what != "configure") {
    const char* expected = "";
    const auto telling = telling_of(arguments, expected);
    if (!telling) {
      throw tell_usage(arguments, expected);
    }
    return say(arguments, *telling);
  }
  if (arguments.value.empty()) {
    throw tell_usage(arguments, "FILE");
  }
  const auto structure = load_with_notes(arguments.value, arguments.reading);
  if (!structure) {
    return fail(structure.error(), arguments.value);
  }
  return say(arguments,
             {.kind = Telling::Kind::kConfigure, .cell = {}, .structure = &structure.value()});
}

}  // namespace

Command add_tell(CLI::App& app) {
  auto arguments = std::make_shared<TellArguments>();
  CLI::App* command = app.add_subcommand(
      "tell", "Tell a module on the table, over a serial line to a free face, and see it done");
  add_required(*command, "DEVICE", arguments->device,
               "A serial adapter at a free face of a module");
  add_required(*command, "WHAT", arguments->what,
               "plan X,Y,Z; withdraw X,Y,Z or all; anchor X,Y,Z or none; fixed; free; configure "
               "FILE");
  command->get_option("WHAT")->check(
      CLI::IsMember({"plan", "withdraw", "anchor", "fixed", "free", "configure"}).description(""));
  command->add_option("VALUE", arguments->value, "A cell, a file or a word, as WHAT says")
      ->type_name("");
  add_reading(*command, arguments->reading);
  add_baud(*command, arguments->options);
  return {command,
          [arguments] { return run_tell(*arguments); },
          {.examples = {{"tell /dev/ttyUSB0 plan 6,1,2", "a module is planned there"},
                        {"tell /dev/ttyUSB0 withdraw all", "nothing is planned any more"},
                        {"tell /dev/ttyUSB0 configure arm.json", "the robot's numbers, for all"},
                        {"tell /dev/ttyUSB0 anchor 0,0,0", "this module sits there"},
                        {"tell /dev/ttyUSB0 fixed", "and is held from outside"}},
           .notes = "Plans and the robot's numbers (material, strengths, masses) may be told to "
                    "any module, which passes them on; anchor, fixed and free are about the "
                    "module at the device. Each is repeated until the module says that it is "
                    "done, for 10 s. A module keeps what it was told over a loss of power if its "
                    "board can, but for plans.",
           .exits = {{kExitSafe, "the module has done it"},
                     {kExitBadInput,
                      "the device cannot be opened, nobody answers, the module has not done it, "
                      "or FILE cannot be read"}}}};
}

}  // namespace holdfast::cli
