// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <memory>

#include "commands.hpp"
#include "file_clash.hpp"
#include "instrument_options.hpp"
#include "reading.hpp"

namespace holdfast::cli {
namespace {

struct TwinArguments {
  const CLI::App* command = nullptr;
  std::string json;
  Reading reading;
  std::string device;
  std::vector<std::string> others;
  std::string file;
  InstrumentOptions options;
  bool is_quiet = false;
};

void print_report(const TwinReport& report) {
  for (const TwinModule& module : report.modules) {
    fmt::print("{}: module {} at {}\n", module.device, module.id,
               module.cell ? model::text(*module.cell) : "(?)");
    if (!module.rows.empty()) {
      fmt::print("  {:<12} {:<26} {}\n", "", "table", "twin");
    }
    for (const TwinModule::Row& row : module.rows) {
      fmt::print("  {:<12} {:<26} {}\n", row.what, row.table, row.twin);
    }
  }
  for (const std::string& difference : report.differences) {
    fmt::print("differs: {}\n", difference);
  }
  if (report.differences.empty()) {
    fmt::print("no difference\n");
  }
}

std::string json_of(const TwinArguments& arguments, const TwinReport& report) {
  std::string text;
  io::JsonStream json(text);
  json.begin_object();
  io::write_report_head(
      json, {.command = "twin",
             .origin = {.file = arguments.file, .options = given_options(*arguments.command)}});
  json.key("modules");
  json.begin_array();
  for (const TwinModule& module : report.modules) {
    json.begin_object();
    json.member("device", module.device);
    json.member("id", module.id);
    json.member("cell", module.cell);
    json.key("compared");
    json.begin_array();
    for (const TwinModule::Row& row : module.rows) {
      json.begin_object();
      json.member("what", row.what);
      json.member("table", row.table);
      json.member("twin", row.twin);
      json.end_object();
    }
    json.end_array();
    json.end_object();
  }
  json.end_array();
  json.key("differences");
  json.begin_array();
  for (const std::string& difference : report.differences) {
    json.value(difference);
  }
  json.end_array();
  json.end_object();
  return text + "\n";
}

int run_twin(const TwinArguments& arguments) {
  const Outputs outputs = {{"--json", arguments.json, FileFormat::kJson}};
  refuse_clashes({&arguments.file, 1}, outputs);
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
  const auto& differences = report.value().differences;
  if (!arguments.is_quiet && leaves_standard_output(outputs)) {
    print_report(report.value());
  }
  if (!arguments.json.empty() &&
      !write_or_complain(arguments.json, json_of(arguments, report.value()))) {
    return kExitBadInput;
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
  arguments->command = command;
  add_output(*command, "--json", arguments->json, "Write the report; - is standard output");
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
