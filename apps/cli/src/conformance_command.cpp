// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <memory>

#include "commands.hpp"
#include "file_clash.hpp"
#include "holdfast/instrument.hpp"
#include "instrument_options.hpp"
#include "interruption.hpp"
#include "reading.hpp"

namespace holdfast::cli {
namespace {

using Outcome = ConformanceCase::Outcome;

struct ConformanceArguments {
  const CLI::App* command = nullptr;
  std::string device;
  std::string page;
  std::string section;
  std::string json;
  InstrumentOptions options;
  bool is_quiet = false;
};

const char* name_of(Outcome outcome) {
  return outcome == Outcome::kPassed ? "passed" : outcome == Outcome::kFailed ? "failed" : "absent";
}

auto count_of(const std::vector<ConformanceCase>& cases, Outcome outcome) {
  return std::ranges::count(cases, outcome, &ConformanceCase::outcome);
}

void print_case(const ConformanceCase& one) {
  fmt::print("{:<7} {:<8} {}{}\n", name_of(one.outcome), one.section, one.name,
             one.attempts > 1 ? fmt::format(" (attempt {})", one.attempts) : std::string());
  if (one.outcome == Outcome::kFailed) {
    fmt::print("  sent      {}\n  expected  {}\n  found     {}\n",
               one.sent.empty() ? "nothing" : one.sent, one.expected, one.found);
  } else if (one.outcome == Outcome::kAbsent) {
    fmt::print("  {}\n", one.found);
  }
  std::fflush(stdout);
}

std::string report(const ConformanceArguments& arguments,
                   const std::vector<ConformanceCase>& cases) {
  std::string text;
  io::JsonStream json(text);
  json.begin_object();
  io::write_report_head(json,
                        {.command = "conformance",
                         .origin = {.file = {}, .options = given_options(*arguments.command)}});
  for (const Outcome outcome : {Outcome::kPassed, Outcome::kFailed, Outcome::kAbsent}) {
    json.member(name_of(outcome), count_of(cases, outcome));
  }
  json.key("cases");
  json.begin_array();
  for (const ConformanceCase& one : cases) {
    json.begin_object();
    json.member("section", one.section);
    json.member("name", one.name);
    json.member("outcome", name_of(one.outcome));
    json.member("attempts", one.attempts);
    if (one.outcome == Outcome::kFailed) {
      json.member("sent", one.sent);
      json.member("expected", one.expected);
    }
    if (one.outcome != Outcome::kPassed) {
      json.member("found", one.found);
    }
    json.end_object();
  }
  json.end_array();
  json.end_object();
  return text + "\n";
}

int write_page(const std::string& path) {
  return write_or_complain(path, as_text(conformance_page())) ? kExitSafe : kExitBadInput;
}

int run_conformance(const ConformanceArguments& arguments) {
  if (arguments.device.empty() == arguments.page.empty()) {
    throw UsageError("conformance: expected either DEVICE or --page FILE");
  }
  if (!arguments.page.empty()) {
    return write_page(arguments.page);
  }
  const Interruption interruption;
  const bool is_silent = arguments.is_quiet ||
                         !leaves_standard_output({{"--json", arguments.json, FileFormat::kJson}});
  const auto cases = check_conformance(arguments.device, arguments.section, arguments.options,
                                       [&](const ConformanceCase& one) {
                                         if (!is_silent) {
                                           print_case(one);
                                         }
                                         return !Interruption::is_here();
                                       });
  if (!cases) {
    return fail(cases.error(), arguments.device);
  }
  const auto failed = count_of(cases.value(), Outcome::kFailed);
  if (!is_silent) {
    fmt::print("{} passed, {} failed, {} absent\n", count_of(cases.value(), Outcome::kPassed),
               failed, count_of(cases.value(), Outcome::kAbsent));
  }
  if (!arguments.json.empty() &&
      !write_or_complain(arguments.json, report(arguments, cases.value()))) {
    return kExitBadInput;
  }
  return failed == 0 && !Interruption::is_here() ? kExitSafe : kExitUnsafe;
}

}  // namespace

Command add_conformance(CLI::App& app) {
  auto arguments = std::make_shared<ConformanceArguments>();
  CLI::App* command = app.add_subcommand(
      "conformance", "Try whether a module keeps to the wire format, as its neighbour at face +x");
  arguments->command = command;
  command->add_option("DEVICE", arguments->device, "A serial adapter at face +x of the module")
      ->type_name("");
  command
      ->add_option("--page", arguments->page,
                   "Only write the page of configuration that the module has to have")
      ->type_name("FILE");
  command
      ->add_option(
          "--section", arguments->section,
          fmt::format("Only try the cases about this: {}", fmt::join(conformance_sections(), ", ")))
      ->type_name("NAME")
      ->check(CLI::IsMember(conformance_sections()).description(""));
  add_baud(*command, arguments->options);
  add_output(*command, "--json", arguments->json, "Write the report; - is standard output");
  add_quiet(*command, arguments->is_quiet);
  return {command,
          [arguments] { return run_conformance(*arguments); },
          {.examples = {{"conformance --page page.bin", "flash this page first"},
                        {"conformance /dev/ttyUSB0", "then try all cases, some 70 s"},
                        {"conformance /dev/ttyUSB0 --section line", "frames alone"}},
           .notes = "A failed case shows the bytes that were sent last, those that were expected, "
                    "and those that came. Expected bytes are worked out apart from the module's "
                    "code, or are those of docs/evidence/wire.md. A case is absent if the module "
                    "lacks what it is about: answers to instruments.",
           .exits = {{kExitSafe, "every case has passed or is absent"},
                     {kExitUnsafe, "a case has failed"},
                     {kExitBadInput, "the device cannot be opened, or nobody greets there"}}}};
}

}  // namespace holdfast::cli
