// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <memory>

#include "commands.hpp"
#include "instrument_options.hpp"
#include "reading.hpp"

namespace holdfast::cli {
namespace {

struct TwinArguments {
  Reading reading;
  std::string device;
  std::vector<std::string> others;
  std::string file;
  InstrumentOptions options;
  bool is_quiet = false;
};

int run_twin(const TwinArguments& arguments) {
  const auto structure = load_with_notes(arguments.file, arguments.reading);
  if (!structure) {
    return fail(structure.error(), arguments.file);
  }
  std::vector<std::string> devices = {arguments.device};
  devices.insert(devices.end(), arguments.others.begin(), arguments.others.end());
  const auto report = compare_with_twin(devices, structure.value(), arguments.options);
  if (!report) {
    return fail(report.error(), arguments.file);
  }
  const auto& [lines, differences] = report.value();
  if (!arguments.is_quiet) {
    for (const std::string& line : lines) {
      fmt::print("{}\n", line);
    }
    for (const std::string& difference : differences) {
      fmt::print("differs: {}\n", difference);
    }
    if (differences.empty()) {
      fmt::print("no difference\n");
    }
  }
  return differences.empty() ? kExitSafe : kExitUnsafe;
}

}  // namespace

Command add_twin(CLI::App& app) {
  auto arguments = std::make_shared<TwinArguments>();
  CLI::App* command = app.add_subcommand(
      "twin", "Compare modules on the table with the same robot in simulation, face by face");
  add_required(*command, "DEVICE", arguments->device,
               "A serial adapter at a free face of a module");
  add_required(*command, "FILE", arguments->file, kStructureHelp);
  command->add_option("--also", arguments->others, "Another one, at another module")
      ->type_name("DEVICE")
      ->allow_extra_args(false);
  add_reading(*command, arguments->reading);
  add_baud(*command, arguments->options);
  command
      ->add_option("--time", arguments->options.time_max_s,
                   "Wait for each module's verdict for this time (s); 15 without this option")
      ->type_name("T")
      ->check(number_between(0.001, 1e6).description(""));
  add_quiet(*command, arguments->is_quiet);
  return {command,
          [arguments] { return run_twin(*arguments); },
          {.examples = {{"twin /dev/ttyUSB0 arm.json", "is this robot that file?"},
                        {"twin /dev/ttyUSB0 arm.json --also /dev/ttyUSB1", "at two modules"}},
           .notes = "Compared are the module's neighbours at every face, whether it is held, the "
                    "robot's numbers, the verdict with its reason, and load ratios within 0.01 + "
                    "1 %. What FILE plans must have been told to the robot.",
           .exits = {{kExitSafe, "no difference"},
                     {kExitUnsafe, "there are differences, each in a line"},
                     {kExitBadInput,
                      "the device cannot be opened, nobody answers, or FILE cannot be read"}}}};
}

}  // namespace holdfast::cli
