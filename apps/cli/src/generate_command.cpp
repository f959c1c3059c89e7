// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <memory>

#include "commands.hpp"
#include "file_clash.hpp"

namespace holdfast::cli {
namespace {

struct GenerateArguments {
  std::string family;
  std::int64_t size = 0;
  std::string to = "-";
};

int run(const GenerateArguments& options) {
  if (options.size < 0) {
    throw UsageError(fmt::format("expected a size of 1 or more, found {}", options.size));
  }
  refuse_clashes({}, {{{"--output", options.to, FileFormat::kStructure}}});
  const auto document = generate(options.family, static_cast<std::size_t>(options.size));
  if (!document) {
    throw UsageError(document.error().message);
  }
  if (has_ending(options.to, ".holdfast")) {
    const auto structure = io::make_binary(document.value());
    const auto write = [&](std::ostream& out) { io::write_binary(out, structure.value()); };
    return write_or_complain(options.to, write) ? kExitSafe : kExitBadInput;
  }
  const std::string text = has_ending(options.to, ".xml") ? io::write_visiblesim(document.value())
                                                          : io::write_json(document.value());
  return write_or_complain(options.to, text) ? kExitSafe : kExitBadInput;
}

}  // namespace

Command add_generate(CLI::App& app) {
  auto options = std::make_shared<GenerateArguments>();
  CLI::App* command = app.add_subcommand(
      "generate",
      "Write a structure to begin with, of any size: an arch, a crane, a tower or another");
  add_required(*command, "FAMILY", options->family, "One of the families below");
  add_required(*command, "SIZE", options->size, "How large; see the families below");
  add_output(*command, "-o,--output", options->to,
             "File to write, .json, .xml or .holdfast; - is standard output");
  std::string notes = "Families:\n";
  for (const auto& [name, help] : family_list()) {
    notes += fmt::format("  {:<12}{}\n", name, help);
  }
  return {command,
          [options] { return run(*options); },
          {.examples = {{"generate crane 12 -o crane.json", "a crane 12 modules high"},
                        {"generate ball 9 | holdfast check -", "judge one at once"}},
           .notes = notes + "\nAll stand on z = 0.",
           .exits = {{0, "the structure is written"},
                     {kExitBadInput, "the output cannot be written"}}}};
}

}  // namespace holdfast::cli
